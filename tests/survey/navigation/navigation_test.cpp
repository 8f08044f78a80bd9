// SPDX-License-Identifier: BSD-3-Clause
//
// Navigation made of poses, by a program that read no file of ours.
#include "survey/navigation/navigation.h"

#include "base/error.h"
#include "support/refusal.h"

#include <gtest/gtest.h>

#include <limits>

namespace aphotic::navigation_test {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

std::string fault_of(const Navigation& navigation, const std::string& image) {
    return refusal_of([&] { return navigation.pose_of(image); });
}

TEST(Navigation, IsMadeOfPoses) {
    const Navigation track("track",
                           {{.image = "a.tif", .sled = {2.0, 0.1, -0.2}},
                            {.image = "dive/b.dng", .sled = {3.0, 0.0, 0.0}}});
    EXPECT_EQ(track.size(), 2U);
    EXPECT_EQ(track.pose_of("raw/a.png").sled.roll_rad, -0.2);
    EXPECT_EQ(track.pose_of("b.dng").sled.altitude_m, 3.0);
    EXPECT_TRUE(track.given().pitch && track.given().roll);
}

// Of no line: there is none.
TEST(Navigation, FaultsOfPosesNameTheirSource) {
    const Navigation track("track",
                           {{.image = "a.tif", .sled = {kUnknown, 0.0, 0.0}},
                            {.image = "b.tif", .sled = {2.0, 0.0, 0.0}},
                            {.image = "b.png", .sled = {2.5, 0.0, 0.0}},
                            {.image = "c.tif", .sled = {}, .fault = "a gap of 30 s"}});
    EXPECT_EQ(fault_of(track, "a.tif"),
              "track: altitude_m: found no number; allowed: 0.001 to 10000");
    EXPECT_EQ(fault_of(track, "b.tif"), "track: duplicate image 'b'");
    EXPECT_EQ(fault_of(track, "c.tif"), "track: a gap of 30 s");
    EXPECT_EQ(fault_of(track, "d.tif"), "track has no line for it");
}

TEST(Navigation, BeyondItsLimitsAnImageHasNoPose) {
    Navigation track("track",
                     {{.image = "a", .sled = {1.0, 0.0, 0.0}},
                      {.image = "b", .sled = {2.0, 0.0, 0.0}},
                      {.image = "c", .sled = {4.5, 0.0, 0.0}}});
    track.limit_altitude(1.0, 4.0);
    EXPECT_EQ(track.pose_of("a").sled.altitude_m, 1.0);
    EXPECT_EQ(track.pose_of("b").sled.altitude_m, 2.0);
    EXPECT_EQ(fault_of(track, "c"), "altitude_m: found 4.5; allowed by --altitude: 1 to 4");
}

}  // namespace
}  // namespace aphotic::navigation_test
