// SPDX-License-Identifier: BSD-3-Clause
#include "survey/navigation/navigation_ifdo.h"

#include "base/error.h"
#include "support/refusal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace aphotic::navigation_ifdo_test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kDouble = 1e-12;
const Sled kRigSled{.altitude_m = 7.0, .pitch_rad = 0.1, .roll_rad = -0.2};

Navigation of(const std::string& header, const std::string& items) {
    return parse_navigation_ifdo(
        "set.yaml",
        "image-set-header: {" + header + "}\nimage-set-items: {" + items + "}\n",
        kRigSled);
}

std::string fault_of(const Navigation& navigation, const char* image) {
    return refusal_of([&] { return navigation.pose_of(image); });
}

// A camera 2 m over the ground that is turned by p about its beam and then r about its length sees
// the ground 2 m / (cos p cos r) along its axis: the third row of Ry(p) Rx(r).
TEST(NavigationIfdo, HeightsArePlumb) {
    const Navigation navigation =
        of("image-altitude-meters: -4000, image-camera-roll-degrees: 20",
           "raw/a.tif: {image-meters-above-ground: 2.0, "
           "image-camera-pitch-degrees: 30, image-altitude-meters: -3998}");
    const Sled& sled = navigation.pose_of("elsewhere/a.exr").sled;
    EXPECT_NEAR(sled.pitch_rad, 30.0 * kDegree, kDouble);
    EXPECT_NEAR(sled.roll_rad, 20.0 * kDegree, kDouble);
    const double down = std::cos(30.0 * kDegree) * std::cos(20.0 * kDegree);
    EXPECT_NEAR(sled.altitude_m * down, 2.0, kDouble);
    EXPECT_TRUE(navigation.given().pitch);
}

TEST(NavigationIfdo, AnglesThatNoImageHasAreTheRigs) {
    const Navigation navigation = of("image-meters-above-ground: 2", "a.tif: {}, b.tif: [{}]");
    EXPECT_EQ(navigation.size(), 2U);
    EXPECT_FALSE(navigation.given().pitch);
    EXPECT_FALSE(navigation.given().roll);
    for (const char* image : {"a.tif", "b.tif"}) {
        const Sled& sled = navigation.pose_of(image).sled;
        EXPECT_EQ(sled.pitch_rad, kRigSled.pitch_rad);
        EXPECT_EQ(sled.roll_rad, kRigSled.roll_rad);
        EXPECT_NEAR(sled.altitude_m * std::cos(0.1) * std::cos(0.2), 2.0, kDouble);
    }
}

TEST(NavigationIfdo, SkipsImagesAndSaysWhy) {
    const Navigation navigation =
        of("image-altitude-meters: -4000",
           "good.tif: {image-meters-above-ground: 2, image-camera-pitch-degrees: 1},"
           "sea.tif: {image-camera-pitch-degrees: 1},"
           "word.tif: {image-meters-above-ground: high, image-camera-pitch-degrees: 1},"
           "flat.tif: {image-meters-above-ground: 2},"
           "film.tif: [{image-meters-above-ground: 2}, {image-meters-above-ground: 3}],"
           "steep.tif: {image-meters-above-ground: 2, image-camera-pitch-degrees: 95},"
           "under.tif: {image-meters-above-ground: -1, image-camera-pitch-degrees: 60},"
           "text.tif: nothing");
    EXPECT_EQ(fault_of(navigation, "good.tif"), kAccepted);
    EXPECT_EQ(fault_of(navigation, "sea.tif"),
              "set.yaml: found no image-meters-above-ground; image-altitude-meters is above sea "
              "level, not above the floor");
    EXPECT_EQ(fault_of(navigation, "word.tif"),
              "set.yaml: image-meters-above-ground: found a string; allowed: a number");
    EXPECT_EQ(fault_of(navigation, "flat.tif"), "set.yaml: found no image-camera-pitch-degrees");
    EXPECT_EQ(fault_of(navigation, "film.tif"),
              "set.yaml: found 2 objects, as of a video; allowed: 1");
    // In the file's own numbers, not in what follows from them.
    EXPECT_EQ(fault_of(navigation, "steep.tif"),
              "set.yaml: pitch_deg: found 95; allowed: -89.9 to 89.9");
    EXPECT_EQ(fault_of(navigation, "under.tif"),
              "set.yaml: altitude_m: found -1; allowed: 0.001 to 10000");
    EXPECT_EQ(fault_of(navigation, "text.tif"), "set.yaml: found a string; allowed: an object");
}

TEST(NavigationIfdo, HeightsOverSeaLevelAreRefused) {
    const std::string said =
        refusal_of([&] { return of("image-altitude-meters: -4000", "a.tif: {}"); });
    EXPECT_EQ(said,
              "set.yaml: found no image-meters-above-ground; image-altitude-meters is above sea "
              "level, not above the floor, in the header or of any image; allowed: the camera's "
              "height above the sea floor in metres");
    EXPECT_THROW((void)of("", ""), InputError);
}

}  // namespace
}  // namespace aphotic::navigation_ifdo_test
