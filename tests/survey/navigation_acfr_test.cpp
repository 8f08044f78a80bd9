// SPDX-License-Identifier: BSD-3-Clause
//
// ACFR's poses. The stereo frame sees the way down as cos theta cos phi along its axis,
// cos theta sin phi to the image's bottom and -sin theta to its right; the angles follow by hand.
#include "survey/navigation_acfr.h"

#include "base/error.h"
#include "rig/rig_reader.h"
#include "survey/navigation_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

namespace aphotic::navigation_acfr_test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kWritten_deg = 5e-5;  // half the last digit of the angles below

constexpr std::string_view kPoses =
    "% STEREO_POSE_FILE VERSION 3\n"
    "%\n"
    "ORIGIN_LATITUDE    -33.5000000000000000\n"
    "ORIGIN_LONGITUDE   151.5000000000000000\n"
    "\n"
    "101\t1270000000.25\t-33.5\t151.5\t-90.1\t-788.1\t69.2\t0.01\t0.02\t1.5\tPR_1_LC16.png\t"
    "PR_1_RM16.png\t2.25\t0.95\t0\n"
    "102\t1270000002.25\t-33.5\t151.5\t-90.1\t-788.1\t69.2\t0\t0\t0\tPR_2_LC16.png\t"
    "PR_2_RM16.png\t0.0\t0.95\t0\n"
    "103\t1270000003.25\t-33.5\t151.5\t-90.1\t-788.1\t69.2\t0.0873\t0\t0.7\tPR_3_LC16.png\t"
    "PR_3_RM16.png\t1.9\t0.95\t0\n";

Rig rig() {
    return read_rig(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam.toml");
}

Navigation parsed(std::string_view text, const Rig& of) {
    return parse_navigation(text, {.source = "stereo_pose_est.data"}, {}, &of);
}

std::string fault_of(const Navigation& navigation, const std::string& image) {
    try {
        static_cast<void>(navigation.pose_of(image));
    } catch (const InputError& error) {
        return error.what();
    }
    return "nothing was said";
}

void expect_pose(const Navigation& nav,
                 const std::string& image,
                 double altitude_m,
                 double pitch_deg,
                 double roll_deg) {
    const Sled& sled = nav.pose_of(image).sled;
    EXPECT_EQ(sled.altitude_m, altitude_m) << image;
    EXPECT_NEAR(sled.pitch_rad / kDegree, pitch_deg, kWritten_deg) << image;
    EXPECT_NEAR(sled.roll_rad / kDegree, roll_deg, kWritten_deg) << image;
}

TEST(NavigationAcfr, BothImagesOfALineHaveTheCamerasPose) {
    const Navigation nav = parsed(kPoses, rig());
    for (const std::string camera : {"_LC16", "_RM16"}) {
        expect_pose(nav, "PR_1" + camera + ".png", 2.25, 0.5728, -1.1460);
        expect_pose(nav, "PR_3" + camera + ".tif", 1.9, 5.0019, 0.0);
        EXPECT_EQ(fault_of(nav, "PR_2" + camera + ".png"),
                  "stereo_pose_est.data:7: altitude_m: found 0; allowed: 0.001 to 10000");
    }
    EXPECT_EQ(words_of(*nav.notes()),
              "ACFR's stereo_pose_est.data: image 'left, right', altitude_m 'altitude', pitch_deg "
              "'X angle', roll_deg 'Y angle'; metres, radians; altitude: along the axis");
}

TEST(NavigationAcfr, ALineThatIsCutCostsItsOwnImagesAlone) {
    const Navigation nav =
        parsed(std::string(kPoses) +
                   "104\t1270000004.25\t-33.5\t151.5\t-90.1\t-788.1\t69.2\t0\t0\t0\t"
                   "PR_4_LC16.png\tPR_4_RM1",
               rig());
    EXPECT_EQ(fault_of(nav, "PR_4_LC16.png"),
              "stereo_pose_est.data:9: found 12 fields; allowed: 15");
    EXPECT_EQ(nav.pose_of("PR_3_LC16.png").sled.altitude_m, 1.9);
    EXPECT_TRUE(nav.warnings().empty());
}

// The angles are the camera's already: its place on the vehicle would turn them twice.
TEST(NavigationAcfr, ARigThatPlacesItsCameraOnAVehicleIsRefused) {
    Rig placed = rig();
    placed.mounting.position_m = {0.4, 0.0, 0.1};
    EXPECT_THROW(static_cast<void>(parsed(kPoses, placed)), InputError);
    Rig plumb = rig();
    plumb.mounting.altitude_is = AltitudeIs::Plumb;
    EXPECT_NEAR(
        parsed(kPoses, plumb).pose_of("PR_3_LC16").sled.altitude_m, 1.9 / std::cos(0.0873), 1e-12);
}

TEST(NavigationAcfr, ColumnsHaveNoNamesToBeGiven) {
    const Rig of = rig();
    try {
        static_cast<void>(parse_navigation(
            kPoses, {.source = "nav", .columns = {{"altitude_m", "altitude"}}}, {}, &of));
        FAIL() << "nothing was said";
    } catch (const InputError& error) {
        EXPECT_STREQ(error.what(), "nav:6: found no header row; needed by --columns");
    }
}

}  // namespace
}  // namespace aphotic::navigation_acfr_test
