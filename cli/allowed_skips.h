// SPDX-License-Identifier: BSD-3-Clause
//
// How many images a survey's command may skip and still end with 0: a number of them, or a share of
// all that it was given. A script that works on ten thousand images need not stop for three.
//
//   3        three images
//   0.01     a hundredth of them, rounded down; so does 1%
#pragma once

#include "cli/command.h"

#include <CLI/CLI.hpp>

#include <cstddef>
#include <optional>
#include <string_view>

namespace aphotic::cli {

struct AllowedSkips {
    double number = 0.0;
    bool is_share = false;

    [[nodiscard]] std::size_t of(std::size_t images) const;
};

[[nodiscard]] std::optional<AllowedSkips> allowed_skips_in(std::string_view text);

void add_allow_skipped(CLI::App& app, AllowedSkips& allowed);

// kDone when no more were skipped than is allowed. Skips are said, with both numbers.
[[nodiscard]] ExitStatus status_of_skips(std::size_t skipped,
                                         std::size_t images,
                                         const AllowedSkips& allowed);

}  // namespace aphotic::cli
