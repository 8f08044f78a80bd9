// SPDX-License-Identifier: BSD-3-Clause
//
// Where the sled of a simulated survey is at each image.
//
// Image i depends on the seed and on i alone, so a short survey is the beginning of a long one.
// Altitudes go round the golden section, which fills the range evenly however many images there
// are; pitch and roll are uniform. All three are rounded as the navigation file writes them: what
// it says is what was flown.
#pragma once

#include "rig/rig.h"

#include <cstdint>
#include <string>
#include <vector>

namespace aphotic::survey {

inline constexpr double kLowest_m = 1.3;
inline constexpr double kHighest_m = 3.2;
inline constexpr double kLeastPitch_deg = -3.0;  // HabCam's tow holds its bow up by some 2 degrees
inline constexpr double kMostPitch_deg = 7.0;
inline constexpr double kMostRoll_deg = 3.0;

struct Leg {
    int image = 0;                 // from 1 on
    std::string name;              // of its files, without their suffix
    std::uint32_t floor_seed = 0;  // of what lies on the floor; POV-Ray takes 31 bits
    double altitude_m = 0.0;
    double pitch_deg = 0.0;
    double roll_deg = 0.0;
    bool has_chart = false;  // the first five do, and then every tenth
};

[[nodiscard]] Leg leg(std::uint64_t seed, int image);
[[nodiscard]] std::vector<Leg> flight(std::uint64_t seed, int images);

// The same flight as instruments of its kind tell it: each number off by an error of its own,
// normal with these standard deviations.
inline constexpr double kAltimeterError_m = 0.02;
inline constexpr double kAttitudeError_deg = 0.5;
[[nodiscard]] std::vector<Leg> as_measured(const std::vector<Leg>& legs, std::uint64_t seed);

// A line for each image, as HabCam's metadata has it: imagename alt pitch roll.
[[nodiscard]] std::string navigation(const std::vector<Leg>& legs, const std::string& suffix);

}  // namespace aphotic::survey
