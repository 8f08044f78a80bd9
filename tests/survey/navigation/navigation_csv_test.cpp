// SPDX-License-Identifier: BSD-3-Clause
//
// Navigation files as loggers write them, and what is said of those that are wrong.
#include "survey/navigation/navigation_csv.h"

#include "base/error.h"
#include "rig/file/rig_reader.h"
#include "support/refusal.h"
#include "support/temp_folder.h"
#include "survey/navigation/navigation_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace aphotic::navigation_csv_test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
const Sled kRigSled{.altitude_m = 2.0, .pitch_rad = 5.0 * kDegree, .roll_rad = 1.0 * kDegree};

const Rig& rig() {
    static const Rig kRig = [] {
        Rig rig = read_rig(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam.toml");
        rig.sled = kRigSled;
        return rig;
    }();
    return kRig;
}

Navigation parsed(std::string_view text) {
    return parse_navigation(text, {.source = "nav.csv"}, {}, &rig());
}

std::string fault_in(std::string_view text) {
    return refusal_of([&] { return parsed(text); });
}

TEST(NavigationCsv, ColumnsStandInAnyOrderAmongOthers) {
    const Navigation nav = parsed(
        "# a survey\n"
        "roll_deg, latitude, image, pitch_deg, altitude_m\n"
        "-3, 41.5, a.tif, 4, 1.5\n"
        "\n"
        "0.5, 41.6, b.tif, -2.5, +2.25\n");
    EXPECT_EQ(nav.size(), 2U);
    const ImagePose& b = nav.pose_of("b.tif");
    EXPECT_EQ(b.line, 5U);
    EXPECT_DOUBLE_EQ(b.sled.altitude_m, 2.25);
    EXPECT_DOUBLE_EQ(b.sled.pitch_rad, -2.5 * kDegree);
    EXPECT_DOUBLE_EQ(b.sled.roll_rad, 0.5 * kDegree);
}

// Of a misspelt column the rig's own attitude would be taken, and nobody be told.
TEST(NavigationCsv, AnAttitudeUnderAnotherNameIsRefused) {
    EXPECT_EQ(fault_in("image,altitude_m,pitch,roll_deg\na.tif,2,1,0\n"),
              "nav.csv:1: found the column 'pitch'; allowed: 'pitch_deg', or --columns "
              "pitch_deg='pitch'");
    EXPECT_EQ(fault_in("image,altitude_m,roll_rad\na.tif,2,1\n"),
              "nav.csv:1: found the column 'roll_rad'; allowed: 'roll_deg', or --columns "
              "roll_deg='roll_rad'");
}

TEST(NavigationCsv, HabCamLinesHaveNoHeader) {
    const Navigation nav = parsed("# eic\na.tif 1.5 4 -3\n  b.tif\t2.25   -2.5 0.5\r\n");
    EXPECT_EQ(nav.size(), 2U);
    EXPECT_DOUBLE_EQ(nav.pose_of("a.tif").sled.roll_rad, -3.0 * kDegree);
    EXPECT_DOUBLE_EQ(nav.pose_of("b.tif").sled.pitch_rad, -2.5 * kDegree);
}

TEST(NavigationCsv, WhatHasNoColumnIsAsTheRigHasIt) {
    const Navigation nav = parsed("image,altitude_m\na.tif,1.5\n");
    EXPECT_DOUBLE_EQ(nav.pose_of("a.tif").sled.altitude_m, 1.5);
    EXPECT_DOUBLE_EQ(nav.pose_of("a.tif").sled.pitch_rad, kRigSled.pitch_rad);
    EXPECT_DOUBLE_EQ(nav.pose_of("a.tif").sled.roll_rad, kRigSled.roll_rad);
}

TEST(NavigationCsv, AnImageIsKnownByItsNameWithoutFolderAndExtension) {
    const Navigation nav = parsed(
        "image,altitude_m\n"
        "\"D:\\\\raw\\\\20120623.171552346.1219.TIF\",1.5\n"
        "/data/20120623.171552346.1220,2.5\n");
    EXPECT_EQ(nav.pose_of("converted/20120623.171552346.1219.png").sled.altitude_m, 1.5);
    EXPECT_EQ(nav.pose_of("20120623.171552346.1220.tif").sled.altitude_m, 2.5);
    EXPECT_EQ(refusal_of([&] { return nav.pose_of("20120623.171552346.tif"); }),
              "nav.csv has no line for it");
}

TEST(NavigationCsv, AnAltimeterThatLostTheFloorCostsItsOwnImageAlone) {
    const Navigation nav = parsed("a.tif 0 0 0\nb.tif nan 0 0\nc.tif 2 95 0\nd.tif 2 0 0\n");
    EXPECT_EQ(refusal_of([&] { return nav.pose_of("a.tif"); }),
              "nav.csv:1: altitude_m: found 0; allowed: 0.001 to 10000");
    EXPECT_EQ(refusal_of([&] { return nav.pose_of("b.tif"); }),
              "nav.csv:2: altitude_m: found no number; allowed: 0.001 to 10000");
    EXPECT_EQ(refusal_of([&] { return nav.pose_of("c.tif"); }),
              "nav.csv:3: pitch_deg: found 95; allowed: -89.9 to 89.9");
    EXPECT_EQ(nav.pose_of("d.tif").sled.altitude_m, 2.0);
}

// However a logger, a database or a spreadsheet writes that it knows no number.
TEST(NavigationCsv, ACellWithoutANumberCostsItsOwnImageAlone) {
    for (const char* none :
         {"", " ", "\"\"", "NaN", "-nan", "NA", "n/a", "#N/A", "null", "None", "-"}) {
        const std::string cell = none;
        const Navigation nav =
            parsed("image,altitude_m,pitch_deg,roll_deg,latitude\n" + std::string("a.tif,") + cell +
                   ",1,2,41\nb.tif,2," + cell + ",2,41\nc.tif,2,1," + cell + ",41\nd.tif,2,1,2," +
                   cell + "\n");
        EXPECT_EQ(refusal_of([&] { return nav.pose_of("a.tif"); }),
                  "nav.csv:2: altitude_m: found no number; allowed: 0.001 to 10000")
            << none;
        EXPECT_EQ(refusal_of([&] { return nav.pose_of("b.tif"); }),
                  "nav.csv:3: pitch_deg: found no number; allowed: -89.9 to 89.9")
            << none;
        EXPECT_EQ(refusal_of([&] { return nav.pose_of("c.tif"); }),
                  "nav.csv:4: roll_deg: found no number; allowed: -89.9 to 89.9")
            << none;
        EXPECT_EQ(nav.pose_of("d.tif").sled.altitude_m, 2.0) << none;
    }
    EXPECT_EQ(parsed("a.tif NA 1 2\nb.tif 2 1 2\n").size(), 2U);
    EXPECT_EQ(parsed("image,altitude_m\na.tif,2\n,\n,,\n").size(), 1U);
}

// Of a line that cannot be understood the other images know nothing.
TEST(NavigationCsv, ALineThatCannotBeUnderstoodCostsItsOwnImageAlone) {
    const auto fault_of_a = [](const std::string& text) {
        const Navigation nav = parsed(text);
        EXPECT_EQ(nav.pose_of("z.tif").sled.altitude_m, 2.0) << text;
        return refusal_of([&] { return nav.pose_of("a.tif"); });
    };
    const std::string header = "image,altitude_m,pitch_deg,roll_deg\nz.tif,2,0,0\n";
    for (const std::string cell : {"--", "---", "2 m", "?", "ERR", "1.5.2", "0x2", "2;0"}) {
        EXPECT_EQ(fault_of_a(header + "a.tif," + cell + ",0,0\n"),
                  "nav.csv:3: altitude_m: found '" + cell + "'; allowed: a number");
    }
    EXPECT_EQ(fault_of_a(header + "a.tif,2,--,0\n"),
              "nav.csv:3: pitch_deg: found '--'; allowed: a number");
    EXPECT_EQ(fault_of_a(header + "a.tif,2,0,--\n"),
              "nav.csv:3: roll_deg: found '--'; allowed: a number");
    EXPECT_EQ(fault_of_a(header + "a.tif,2\n"),
              "nav.csv:3: found 2 fields; allowed: 4, as in the header row");
    EXPECT_EQ(fault_of_a(header + "a.tif,2,0,0,0\n"),
              "nav.csv:3: found 5 fields; allowed: 4, as in the header row");
    EXPECT_EQ(fault_of_a("z 2 0 0\na.tif 2 0\n"),
              "nav.csv:2: found 3 fields; allowed: 4: image, altitude, pitch, roll");
    EXPECT_EQ(fault_of_a("x/a.tif 2 0 0\nz 2 0 0\ny/a.png 2 0 0\na 2 0 0\n"),
              "nav.csv:1: duplicate image 'a', also on line 4");
    EXPECT_EQ(fault_of_a(header + ",2,0,0\n"), "nav.csv has no line for it; line 3 names no image");
    EXPECT_EQ(fault_of_a("altitude_m,image\n2,z\n2\n"),
              "nav.csv has no line for it; line 3 names no image");
}

TEST(NavigationCsv, FaultsOfTheHeaderNameFileAndLine) {
    EXPECT_EQ(fault_in("image,altitude\na.tif,2\n"),
              "nav.csv:1: found the columns image,altitude; needed: 'altitude_m' (is it "
              "'altitude'?), or --columns altitude_m=NAME");
    EXPECT_EQ(fault_in("image,altitude_m,altitude_m\n"),
              "nav.csv:1: duplicate column 'altitude_m'");
    EXPECT_EQ(fault_in("image,altitude_m,Altitude_M\n"),
              "nav.csv:1: duplicate column 'altitude_m'");
    EXPECT_EQ(fault_in("photo;altitude_m\na.tif;2\n"),
              "nav.csv:1: found the columns photo,altitude_m; needed: 'image' or 'timestamp', or "
              "--columns image=NAME");
    EXPECT_EQ(fault_in(std::string_view("i\0m\0", 4)),
              "nav.csv: found zero bytes, as UTF-16 has; allowed: UTF-8");
    EXPECT_EQ(fault_in("# nothing\n"), "nav.csv:2: the file ends without a line of an image");
    EXPECT_EQ(fault_in("image,altitude_m\n,2\n"),
              "nav.csv:3: the file ends without a line of an image");
}

// What parts fields is judged where the table begins, however much stands before it.
TEST(NavigationCsv, ATableMayBeginAnywhereWithAnySeparator) {
    std::string many;
    for (int i = 0; i < 30; ++i) many += "% camera A; strobes 1, 2\t3\n";
    for (const std::string& before : {std::string(),
                                      std::string("\xEF\xBB\xBF"),
                                      std::string("# exported 2026-05-07, camera A\n"),
                                      std::string("; a;b;c\n"),
                                      std::string("// a\tb\n\n"),
                                      std::string("/* DATA: \na,b\tc; */\n"),
                                      std::string("sep=;\n"),
                                      std::string("\xEF\xBB\xBF#\r\n"),
                                      many}) {
        for (const char separator : {',', ';', '\t', ' '}) {
            std::string text =
                "image,altitude_m,pitch_deg,roll_deg\nx/a.tif,1.5,4,-3\nb.tif,2.5,1,2\n";
            std::ranges::replace(text, ',', separator);
            const Navigation nav = parsed(before + text);
            EXPECT_EQ(nav.size(), 2U);
            EXPECT_EQ(nav.pose_of("a.tif").sled.altitude_m, 1.5) << before << text;
            EXPECT_DOUBLE_EQ(nav.pose_of("b.tif").sled.roll_rad, 2.0 * kDegree) << before << text;
        }
    }
}

// As numpy.savetxt writes it. By place, the pitch would be an altitude.
TEST(NavigationCsv, AHeaderMayStandInACommentBeforeTheTable) {
    for (const char* text : {"# image pitch_deg roll_deg altitude_m\na.tif 4 -3 1.5\n",
                             "# exported\n#image,pitch_deg,roll_deg,altitude_m\na.tif,4,-3,1.5\n",
                             "% image;pitch_deg;roll_deg;altitude_m\r\na.tif;4;-3;1.5\r\n"}) {
        const Navigation nav = parsed(text);
        EXPECT_EQ(nav.size(), 1U);
        EXPECT_EQ(nav.pose_of("a.tif").sled.altitude_m, 1.5) << text;
        EXPECT_DOUBLE_EQ(nav.pose_of("a.tif").sled.pitch_rad, 4.0 * kDegree) << text;
    }
}

// A row of an unnamed first column is no comment.
TEST(NavigationCsv, ASemicolonMayBeginARow) {
    const Navigation nav = parsed(";image;altitude_m\n0;a.tif;1.5\n;b.tif;2.5\n");
    EXPECT_EQ(nav.pose_of("a.tif").sled.altitude_m, 1.5);
    EXPECT_EQ(nav.pose_of("b.tif").sled.altitude_m, 2.5);
}

// By place, its pitch would be taken for the altitude.
TEST(NavigationCsv, AHeaderOfFourWordsIsNoLineOfHabCams) {
    EXPECT_EQ(fault_in("name pitch roll altitude\na.tif 4 -3 1.5\n"),
              "nav.csv:1: found the columns name,pitch,roll,altitude; needed: 'altitude_m' (is it "
              "'altitude'?), or --columns altitude_m=NAME");
}

TEST(NavigationCsv, ALastLineWithoutAnEndIsWarnedOf) {
    const Navigation nav = parsed("image,pitch_deg,altitude_m\na,4,2.45\nb,4,2");
    EXPECT_EQ(nav.pose_of("b").sled.altitude_m, 2.0);
    ASSERT_EQ(nav.warnings().size(), 1U);
    EXPECT_EQ(nav.warnings().front(),
              "nav.csv:3: the file ends within this line, without a line break: if it was "
              "truncated, 'altitude_m' = '2' may lack digits");
    // Nothing that counts is in doubt.
    for (const char* whole : {"image,altitude_m\nb,2\n",
                              "image,altitude_m\nb,2\r\n",
                              "altitude_m,image\n2,b",
                              "image,altitude_m,place\nb,2,Geor"})
        EXPECT_TRUE(parsed(whole).warnings().empty()) << whole;
    const Navigation cut = parsed("image,altitude_m,roll_deg\na,2,0\nb,2.");
    EXPECT_EQ(refusal_of([&] { return cut.pose_of("b"); }),
              "nav.csv:3: found 2 fields; allowed: 3, as in the header row");
    EXPECT_EQ(parsed("a 2 0 0\nb 2 0 1").warnings().size(), 1U);
}

TEST(NavigationCsv, NamesMayHoldQuotesAndLineEnds) {
    const Navigation nav =
        parsed("image,\"altitude_m\"\n\"a \"\"best\"\".tif\",1.5\n\"b\nc.tif\",2.5\nd,3\n");
    EXPECT_EQ(nav.pose_of("a \"best\".tif").sled.altitude_m, 1.5);
    EXPECT_EQ(nav.pose_of("b\nc.tif").sled.altitude_m, 2.5);
    EXPECT_EQ(nav.pose_of("d").line, 5U);
}

TEST(NavigationCsv, ADecimalCommaIsNamed) {
    const Navigation nav = parsed("image;altitude_m\na;2,15\nb;2.25\n");
    EXPECT_EQ(refusal_of([&] { return nav.pose_of("a"); }),
              "nav.csv:2: altitude_m: found '2,15'; allowed: a number with a decimal point");
}

TEST(NavigationCsv, WhatIsNoTextIsSaidByName) {
    EXPECT_EQ(fault_in(std::string_view("PK\x03\x04\0\0", 6)),
              "nav.csv: found a zip archive, such as .xlsx, .ods or .npz; allowed: text in UTF-8, "
              "such as CSV");
    EXPECT_EQ(fault_in(std::string_view("\xFF\xFEi\0m\0", 6)),
              "nav.csv: found text in UTF-16; allowed: text in UTF-8, such as CSV");
}

TEST(NavigationCsv, FilesAreReadAndNamed) {
    const TempFolder folder;
    const auto file = folder.path() / "nav.csv";
    write_file(file, "image,altitude\n");
    EXPECT_TRUE(refusal_of([&] {
                    return read_navigation({.source = file.string()}, {}, &rig());
                }).starts_with(file.string() + ":1: found the columns"));
    write_file(file, "a.tif 2 0 0\n");
    EXPECT_EQ(read_navigation({.source = file.string()}, {}, &rig()).size(), 1U);
}

}  // namespace
}  // namespace aphotic::navigation_csv_test

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
    return refusal_of([&] { return navigation.pose_of(image); });
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

// The image's top is against the stereo frame's Y, by matrices; with theta 0 a quarter turn before
// psi.
TEST(NavigationAcfr, APlaceIsOfTheTop) {
    const Navigation nav = parsed(kPoses, rig());
    const Place& first = nav.pose_of("PR_1_LC16.png").place;
    EXPECT_EQ(first.north_m, -90.1);
    EXPECT_EQ(first.east_m, -788.1);
    EXPECT_EQ(first.depth_m, 69.2);
    constexpr double kOfNumbers = 1e-12;
    const Eigen::Vector3d top = -turn_by({0.01, 0.02, 1.5}).col(1);
    EXPECT_NEAR(first.heading_rad, std::atan2(top.y(), top.x()), kOfNumbers);
    EXPECT_NEAR(
        nav.pose_of("PR_3_LC16.png").place.heading_rad, 0.7 - 0.5 * std::numbers::pi, kOfNumbers);
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
    EXPECT_EQ(refusal_of([&] {
                  static_cast<void>(parse_navigation(
                      kPoses, {.source = "nav", .columns = {{"altitude_m", "altitude"}}}, {}, &of));
              }),
              "nav:6: found no header row; needed by --columns");
}

}  // namespace
}  // namespace aphotic::navigation_acfr_test
