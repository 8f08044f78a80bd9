// SPDX-License-Identifier: BSD-3-Clause
//
// Where the images of a survey were taken: options of every command that asks, and what the
// terminal is told of the answer.
#pragma once

#include "survey/navigation_file.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

namespace aphotic::cli {

// --nav and all that says how it is to be understood.
CLI::Option* add_navigation_options(CLI::App& app, NavigationOptions& options);

// rig: of commands that need no other; its name, and an empty one is none.
[[nodiscard]] Navigation read_navigation_with(const std::string& rig,
                                              NavigationOptions options,
                                              const std::vector<ImageFile>& files);

void print_navigation(const std::optional<Navigation>& navigation);

}  // namespace aphotic::cli
