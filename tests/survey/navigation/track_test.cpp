// SPDX-License-Identifier: BSD-3-Clause
#include "survey/navigation/track.h"

#include "base/error.h"
#include "support/refusal.h"

#include <gtest/gtest.h>

#include <numbers>
#include <string>

namespace aphotic::track_test {
namespace {

constexpr double kRounding = 1e-12;
constexpr double kNoon_s = 1709985600.0;  // 2024-03-09 12:00:00 UTC

// Out of order, with a gap from 12:00:02 to 12:00:06.
const Track kTrack({{.time_s = kNoon_s + 2.0, .sled = {3.0, 0.1, -0.1}, .line = 4},
                    {.time_s = kNoon_s, .sled = {2.0, -0.1, 0.3}, .line = 2},
                    {.time_s = kNoon_s + 1.0, .sled = {2.5, 0.3, 0.1}, .line = 3},
                    {.time_s = kNoon_s + 6.0, .sled = {4.0, 0.0, 0.0}, .line = 5},
                    {.time_s = kNoon_s + 1.0, .sled = {9.0, 0.0, 0.0}, .line = 6}},
                   2.0);

std::string fault_at(double time_s) {
    return refusal_of([&] { return kTrack.at(time_s); });
}

TEST(Track, IsItsPointsAndStraightBetween) {
    EXPECT_EQ(kTrack.at(kNoon_s).sled.altitude_m, 2.0);
    EXPECT_EQ(kTrack.at(kNoon_s + 6.0).sled.altitude_m, 4.0);
    EXPECT_EQ(kTrack.at(kNoon_s + 1.0).sled.altitude_m, 2.5);  // the first of two
    const Sled sled = kTrack.at(kNoon_s + 0.25).sled;
    EXPECT_NEAR(sled.altitude_m, 2.125, kRounding);
    EXPECT_NEAR(sled.pitch_rad, 0.0, kRounding);
    EXPECT_NEAR(sled.roll_rad, 0.25, kRounding);
    EXPECT_NEAR(kTrack.at(kNoon_s + 1.5).sled.roll_rad, 0.0, kRounding);
}

// From 350 to 10 degrees by way of north.
TEST(Track, PlacesAreStraightBetweenAndHeadingsTheShorterWay) {
    constexpr double kDegree = std::numbers::pi / 180.0;
    const Track track({{.time_s = 0.0,
                        .place = {.east_m = 500000.0,
                                  .north_m = 10.0,
                                  .heading_rad = 350.0 * kDegree,
                                  .depth_m = 60.0}},
                       {.time_s = 2.0,
                        .place = {.east_m = 500001.0,
                                  .north_m = 8.0,
                                  .heading_rad = 10.0 * kDegree,
                                  .depth_m = 61.0}}},
                      kLongestGap_s);
    const Place place = track.at(1.5).place;
    EXPECT_EQ(place.east_m, 500000.75);
    EXPECT_EQ(place.north_m, 8.5);
    EXPECT_EQ(place.depth_m, 60.75);
    EXPECT_NEAR(place.heading_rad, 365.0 * kDegree, kRounding);
}

TEST(Track, GapsAndEndsAreTold) {
    EXPECT_EQ(fault_at(kNoon_s - 0.5),
              "the image's time, 2024-03-09T11:59:59.500Z, is 0.5 s before the first, of line 2");
    EXPECT_EQ(fault_at(kNoon_s + 9.25),
              "the image's time, 2024-03-09T12:00:09.250Z, is 3.25 s after the last, of line 5");
    EXPECT_EQ(fault_at(kNoon_s + 3.0),
              "the image's time, 2024-03-09T12:00:03.000Z, is in a gap of 4 s, between lines 4 and "
              "5; allowed by --longest-gap-s: 2");
}

// Of altitude h = a t^2 / 2 the chord over T lies a T^2 / 8 over the arc's middle.
TEST(Track, IsOffByTheSagittaOfAnAcceleration) {
    constexpr double kAcceleration = 0.2;
    const auto altitude_m = [](double t) { return 2.0 + kAcceleration * t * t / 2.0; };
    const Track track({{.time_s = 0.0, .sled = {altitude_m(0.0), 0.0, 0.0}},
                       {.time_s = kLongestGap_s, .sled = {altitude_m(kLongestGap_s), 0.0, 0.0}}},
                      kLongestGap_s);
    EXPECT_NEAR(track.at(1.0).sled.altitude_m - altitude_m(1.0), 0.1, kRounding);
}

}  // namespace
}  // namespace aphotic::track_test
