// SPDX-License-Identifier: BSD-3-Clause
//
// Strobes moved in the text of a rig file: the numbers that say where they are are replaced, and
// all else, comments and layout included, stays as its author wrote it.
//
//   position_m = [0.5, 0.0, 0.0]   # fore      ->   position_m = [0.6123, -0.02, 0.1]   # fore
//   aim = { tilt_deg = 26.0, toward = "axis" } ->   direction = [-0.41, 0.02, 0.912]
//
// Texts must be those of rigs that were read (rig/rig_reader.h).
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

// How a rig says where a strobe points.
enum class StrobeAim {
    Direction,
    Inline,  // aim = { ... }
    Apart,   // aim.tilt_deg = ..., or a table [strobe.aim]: no direction can stand in its place
};

// By strobe.
[[nodiscard]] std::vector<StrobeAim> strobe_aims(std::string_view toml);

// What is none stays.
struct StrobeChange {
    std::optional<Eigen::Vector3d> position_m{};
    std::optional<Eigen::Vector3d> direction{};  // not where the aim stands apart
    std::optional<double> tilt_deg{};            // of an aim
    // Times the power or flux that the rig says.
    std::optional<double> power_factor{};
};

// changes: by strobe. Numbers are rounded: metres and directions to so many places, degrees and
// powers alike.
inline constexpr int kPlacesOfMetre = 4;
inline constexpr int kPlacesOfDirection = 5;
inline constexpr int kPlacesOfDegree = 2;
inline constexpr int kDigitsOfPower = 5;
[[nodiscard]] std::string with_strobes(std::string_view toml,
                                       const std::vector<StrobeChange>& changes);

}  // namespace aphotic
