// SPDX-License-Identifier: BSD-3-Clause
//
// The sled's pose at each image of a simulated survey, and its instruments' measurements of it.
//
// Image i depends only on the seed and on i, so a short survey is the beginning of a long one.
// Altitudes follow the golden section, which fills the range evenly however many images there are;
// pitch and roll are uniform. All three are rounded as in the navigation file, which thus states
// exactly what was flown.
#pragma once

#include "light/path_range.h"
#include "rig/rig.h"
#include "survey/navigation/navigation.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace aphotic {

// Least and greatest. The defaults are HabCam's, whose tow holds its bow up by about 2 degrees.
struct FlightRanges {
    std::array<double, 2> altitude_m{1.3, 3.2};
    std::array<double, 2> pitch_deg{-3.0, 7.0};
    std::array<double, 2> roll_deg{-3.0, 3.0};
};

struct Leg {
    int image = 0;       // from 1 on
    std::string name{};  // of its files, without their suffix
    Sled sled{};         // of the camera
};

[[nodiscard]] std::vector<Leg> flight(const FlightRanges& ranges, std::uint64_t seed, int images);

// Seed of the floor's contents in an image: 31 bits, POV-Ray's limit.
[[nodiscard]] std::uint32_t floor_seed(std::uint64_t seed, int image);

// The poses of a navigation, in its order. An InputError if it has none, or one that cannot be
// flown.
[[nodiscard]] std::vector<Leg> flight_of(const Navigation& navigation);

// Poses that bracket all of these (light/path_range.h).
[[nodiscard]] std::vector<Sled> corners_of(const FlightRanges& ranges);

// Each number of an image has its own error, normal with these standard deviations, plus a common
// one.
struct InstrumentErrors {
    double altitude_m = 0.02;
    double attitude_deg = 0.5;
    double altitude_bias_m = 0.0;
    double pitch_bias_deg = 0.0;
    double roll_bias_deg = 0.0;
};

// The same flight as instruments measure it, rounded to 1 mm and 0.01 degrees.
[[nodiscard]] std::vector<Leg> as_measured(std::vector<Leg> legs,
                                           const InstrumentErrors& errors,
                                           std::uint64_t seed);

// CSV as navigation_csv.h reads it. Its poses are the vehicle's: from them the camera's follow by
// the mounting (rig/vehicle_pose.h).
[[nodiscard]] std::string navigation_text(const std::vector<Leg>& legs, const std::string& suffix);

// The same without names, by the time of each image in UTC: one image per second from
// 2020-01-01 12:00:00 on.
[[nodiscard]] std::string timed_navigation_text(const std::vector<Leg>& legs);
[[nodiscard]] double time_of(const Leg& leg);

[[nodiscard]] std::vector<Leg> of_vehicle(std::vector<Leg> legs, const Mounting& mounting);

}  // namespace aphotic
