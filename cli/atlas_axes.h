// SPDX-License-Identifier: BSD-3-Clause
//
// The axes of an atlas on the command line: each a number, or FIRST:LAST:STEP with both ends. What
// is left out is the rig's own.
#pragma once

#include "lightmap/map_axes.h"

#include <CLI/CLI.hpp>

#include <cstddef>
#include <string>

namespace aphotic::cli {

// Of all axes together: HabCam's would be over a terabyte.
inline constexpr std::size_t kMostBins = 100000;

struct AxisTexts {
    std::string altitude;
    std::string pitch;
    std::string roll;
    std::string water;
};

void add_axis_options(CLI::App& app, AxisTexts& texts);

// Throws InputError, which names the option.
[[nodiscard]] MapAxes axes_of(const AxisTexts& texts, const Rig& rig);

}  // namespace aphotic::cli
