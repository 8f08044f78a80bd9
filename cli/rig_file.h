// SPDX-License-Identifier: BSD-3-Clause
//
// The rig that a command was given, with a warning of whatever is implausible about it
// (rig/plausibility.h), in the form that warnings about surveys have. With --strict that is an
// error, before anything is written.
#pragma once

#include "rig/rig.h"

#include <CLI/CLI.hpp>

#include <string>

namespace aphotic::cli {

void add_strict_option(CLI::App& app, bool& strict);

// Once what the options change of the rig is changed.
void check_plausible(const Rig& rig, const std::string& file, bool strict);

[[nodiscard]] Rig read_plausible_rig(const std::string& file, bool strict);

}  // namespace aphotic::cli
