// SPDX-License-Identifier: BSD-3-Clause
//
// Calibrations as each tool writes them. One camera is in all formats. Its pixels are OpenCV's:
//
//   import cv2, numpy as np
//   D = np.array([[0,0,1], [.3,.2,1], [-.4,.25,1], [.1,-.3,1], [-.35,-.28,1]], float)
//   K = np.array([[700,0,405.25], [0,690,290.5], [0,0,1]], float); z = np.zeros(3)
//   cv2.projectPoints(D, z, z, K, np.array([-.1,.02,.001,-.002]))
//   cv2.projectPoints(D, z, z, K, np.array([-.1,.02,.001,-.002,.003,.05,-.01,.002]))
//   cv2.fisheye.projectPoints(D.reshape(-1,1,3), z, z, K, np.array([.02,-.01,.005,-.001]))
#include "rig/camera/calibration_file.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "support/mistakes.h"
#include "support/refusal.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic::calibration_file_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kRounding_px = 1e-10;  // of images a thousand pixels wide
constexpr double kRounding = 1e-15;

const std::array<Vector3d, 5> kDirections{Vector3d(0.0, 0.0, 1.0),
                                          Vector3d(0.3, 0.2, 1.0),
                                          Vector3d(-0.4, 0.25, 1.0),
                                          Vector3d(0.1, -0.3, 1.0),
                                          Vector3d(-0.35, -0.28, 1.0)};

CameraCalibration parse(std::string_view text) {
    return parse_calibration("cam", text);
}

std::string error_of(std::string_view text) {
    return refusal_of([&] { static_cast<void>(parse(text)); });
}

void replace(std::string& text, std::string_view from, std::string_view to) {
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
}

std::string with(std::string_view text, std::string_view from, std::string_view to) {
    std::string result(text);
    replace(result, from, to);
    return result;
}

// --- One camera in all formats --------------------------------------------------------------

// As the tools write it; from the fuzzer's corpus.
std::string seed(std::string_view name) {
    return read_text_file(std::filesystem::path(APHOTIC_SOURCE_DIR) /
                          "tests/fuzz/corpus/calibration" / name);
}

const std::string kFileStorage = seed("filestorage.yaml");  // of OpenCV 4.6
const std::string kFileStorageXml = seed("filestorage.xml");
const std::string kFileStorageJson = seed("filestorage.json");
// Before version 3: other names, and nothing between the version and the keys.
const std::string kOldFileStorage = seed("filestorage_before_3.yaml");
const std::string kCameraInfo = seed("camera_info.yaml");
const std::string kCamchain = seed("camchain.yaml");
const std::string kCamerasTxt = seed("cameras.txt");
const std::string kCalibmar = seed("calibmar.yaml");
const std::string kMetashape = seed("metashape.xml");

CameraCalibration one_camera() {
    CameraCalibration camera{.width_px = 800, .height_px = 600};
    camera.lens.focal_px = {700.0, 690.0};
    camera.lens.centre_px = {405.75, 291.0};
    camera.lens.radial = {-0.1, 0.02, 0.0, 0.0};
    camera.lens.tangential = {0.001, -0.002};
    return camera;
}

TEST(CalibrationFile, OneCameraIsTheSameInAllFormats) {
    for (const std::string_view text : {kFileStorage,
                                        kFileStorageXml,
                                        kFileStorageJson,
                                        kOldFileStorage,
                                        kCameraInfo,
                                        kCamchain,
                                        kCamerasTxt,
                                        kCalibmar,
                                        kMetashape})
        EXPECT_EQ(parse(text), one_camera()) << text;
}

TEST(CalibrationFile, LineEndsAndByteOrderMarksDoNotCount) {
    for (const std::string_view text : {kFileStorage, kCamerasTxt, kMetashape}) {
        std::string other = "\xEF\xBB\xBF";
        for (const char c : text) other += c == '\n' ? std::string("\r\n") : std::string(1, c);
        EXPECT_EQ(parse(other), one_camera()) << other;
    }
}

TEST(CalibrationFile, OneFisheyeIsTheSameInAllFormats) {
    CameraCalibration fisheye = one_camera();
    fisheye.lens.is_fisheye = true;
    fisheye.lens.radial = {0.02, -0.01, 0.005, -0.001};
    fisheye.lens.tangential = {};
    std::string storage =
        with(kFileStorageJson, "-0.1, 0.02, 0.001, -0.002", "0.02, -0.01, 0.005, -0.001");
    replace(storage, "\"image_width\"", "\"fisheye_model\": 1, \"image_width\"");
    std::string info = with(kCameraInfo, "plumb_bob", "equidistant");
    replace(info, "-0.1, 0.02, 0.001, -0.002, 0", "0.02, -0.01, 0.005, -0.001");
    std::string chain = with(kCamchain, "radtan", "equidistant");
    replace(chain, "-0.1, 0.02, 0.001, -0.002", "0.02, -0.01, 0.005, -0.001");
    std::string colmap = with(kCamerasTxt, "OPENCV", "OPENCV_FISHEYE");
    replace(colmap, "-0.1 0.02 0.001 -0.002", "0.02 -0.01 0.005 -0.001");
    std::string metashape = with(kMetashape, "frame", "fisheye");
    replace(metashape, "<k1>-0.1</k1>", "<k1>0.02</k1>");
    replace(metashape, "<k2>0.02</k2>", "<k2>-0.01</k2><k3>0.005</k3><k4>-0.001</k4>");
    replace(metashape, "<p1>-0.002</p1>", "");
    replace(metashape, "<p2>0.001</p2>", "");
    for (const std::string& text : {storage, info, chain, colmap, metashape})
        EXPECT_EQ(parse(text), fisheye) << text;
}

// --- What the lenses show -------------------------------------------------------------------

// OpenCV's first pixel is (0, 0), ours (0.5, 0.5).
void expect_pixels(const LensModel& lens, const std::array<Vector2d, 5>& opencv_px) {
    for (std::size_t i = 0; i < kDirections.size(); ++i) {
        const Vector2d found = image_point(lens, kDirections.at(i)) - Vector2d(0.5, 0.5);
        EXPECT_LT((found - opencv_px.at(i)).norm(), kRounding_px)
            << found.transpose() << "; OpenCV has " << opencv_px.at(i).transpose();
    }
}

TEST(CalibrationFile, APlumbBobShowsWhatOpenCvShows) {
    expect_pixels(parse(kFileStorage).lens,
                  {Vector2d(405.25, 290.5),
                   Vector2d(612.24097999999992, 426.731944),
                   Vector2d(130.30326500000001, 459.84844656250004),
                   Vector2d(474.35399999999998, 85.804600000000022),
                   Vector2d(164.48722203099999, 101.00176683016002)});
}

TEST(CalibrationFile, ARationalLensShowsWhatOpenCvShows) {
    std::string text = with(kCameraInfo, "plumb_bob", "rational_polynomial");
    replace(text,
            "[-0.1, 0.02, 0.001, -0.002, 0]",
            "[-0.1, 0.02, 0.001, -0.002, 0.003, 0.05, -0.01, 0.002]");
    const std::array expected{Vector2d(405.25, 290.5),
                              Vector2d(610.93703829381559, 425.87506802165024),
                              Vector2d(133.1824852384209, 458.07464123704426),
                              Vector2d(474.01608921068919, 86.803850476961969),
                              Vector2d(166.77961219163137, 102.80948021397217)};
    expect_pixels(parse(text).lens, expected);
    // Thin prisms and tilts of 0 are none.
    replace(text, "0.002]", "0.002, 0, 0, 0, 0, 0, 0]");
    expect_pixels(parse(text).lens, expected);
    expect_pixels(parse("1 FULL_OPENCV 800 600 700 690 405.75 291 -0.1 0.02 0.001 -0.002 0.003 "
                        "0.05 -0.01 0.002")
                      .lens,
                  expected);
}

TEST(CalibrationFile, AFisheyeShowsWhatOpenCvShows) {
    std::string text = with(kCameraInfo, "plumb_bob", "equidistant");
    replace(text, "-0.1, 0.02, 0.001, -0.002, 0", "0.02, -0.01, 0.005, -0.001");
    expect_pixels(parse(text).lens,
                  {Vector2d(405.25, 290.5),
                   Vector2d(607.25540877553226, 423.24641148106411),
                   Vector2d(142.69338367425246, 452.25362970068375),
                   Vector2d(473.1688902732422, 89.654138763412448),
                   Vector2d(174.17332964538457, 108.27953994893178)});
}

// Of (0.3, 0.4, 1): r = 0.5, and theta = atan(0.5) of a fisheye.
TEST(CalibrationFile, ColmapsModelsHaveItsFormulas) {
    const Vector3d direction(0.3, 0.4, 1.0);
    const double theta = std::atan(0.5);
    const auto radial = [](double k1, double k2, double r) {
        return 1.0 + k1 * r * r + k2 * r * r * r * r;
    };
    const auto at = [](double f, double scale) {
        return Vector2d(f * scale * 0.3 + 401.0, f * scale * 0.4 + 302.0);
    };
    const std::map<std::string, Vector2d> cameras{
        {"SIMPLE_PINHOLE 800 600 700 401 302", at(700.0, 1.0)},
        {"PINHOLE 800 600 700 700 401 302", at(700.0, 1.0)},
        {"SIMPLE_RADIAL 800 600 700 401 302 -0.1", at(700.0, radial(-0.1, 0.0, 0.5))},
        {"RADIAL 800 600 700 401 302 -0.1 0.03", at(700.0, radial(-0.1, 0.03, 0.5))},
        {"SIMPLE_RADIAL_FISHEYE 800 600 700 401 302 -0.1",
         at(700.0, theta / 0.5 * radial(-0.1, 0.0, theta))},
        {"RADIAL_FISHEYE 800 600 700 401 302 -0.1 0.03",
         at(700.0, theta / 0.5 * radial(-0.1, 0.03, theta))}};
    for (const auto& [camera, expected] : cameras) {
        const Vector2d found = image_point(parse("7 " + camera).lens, direction);
        EXPECT_LT((found - expected).norm(), kRounding_px) << camera << ": " << found.transpose();
    }
}

// Agisoft's manual, letter by letter.
TEST(CalibrationFile, MetashapesCalibrationHasItsFormula) {
    std::string text = with(kMetashape, "<b1>10</b1>", "<b1>10</b1><b2>-3</b2>");
    replace(text, "<k2>0.02</k2>", "<k2>0.02</k2><k3>0.004</k3><k4>-0.003</k4>");
    const LensModel lens = parse(text).lens;
    const double f = 690.0, b1 = 10.0, b2 = -3.0, cx = 5.75, cy = -9.0;
    const double k1 = -0.1, k2 = 0.02, k3 = 0.004, k4 = -0.003, p1 = -0.002, p2 = 0.001;
    for (const Vector3d& direction : kDirections) {
        const double x = direction.x() / direction.z();
        const double y = direction.y() / direction.z();
        const double r2 = x * x + y * y;
        const double s = 1.0 + k1 * r2 + k2 * r2 * r2 + k3 * std::pow(r2, 3) + k4 * std::pow(r2, 4);
        const double xd = x * s + (p1 * (r2 + 2.0 * x * x) + 2.0 * p2 * x * y);
        const double yd = y * s + (p2 * (r2 + 2.0 * y * y) + 2.0 * p1 * x * y);
        const Vector2d expected(800.0 * 0.5 + cx + xd * f + xd * b1 + yd * b2,
                                600.0 * 0.5 + cy + yd * f);
        EXPECT_LT((image_point(lens, direction) - expected).norm(), kRounding_px);
    }
}

// The middle of an image of an even number of columns lies between two pixels: at 399.5 where the
// first one's centre is 0, at 400 where it is 0.5. To the last bit.
TEST(CalibrationFile, TheMiddleOfTheImageIsTheMiddleInAllFormats) {
    std::string storage = with(kCameraInfo, "405.25", "399.5");
    replace(storage, "290.5", "299.5");
    const std::string chain = with(kCamchain, "405.25, 290.5", "399.5, 299.5");
    const std::string colmap = with(kCamerasTxt, "405.75 291", "400 300");
    const std::string calibmar = with(kCalibmar, "405.75, 291", "400, 300");
    std::string metashape = with(kMetashape, "<cx>5.75</cx>", "");
    replace(metashape, "<cy>-9</cy>", "");
    for (const std::string& text : {storage, chain, colmap, calibmar, metashape})
        EXPECT_EQ(parse(text).lens.centre_px, Vector2d(400.0, 300.0)) << text;
}

TEST(CalibrationFile, WithoutDistortionAllAreOnePinhole) {
    const CameraCalibration expected{
        .width_px = 800,
        .height_px = 600,
        .lens = {.focal_px = {700.0, 700.0}, .centre_px = {400.0, 300.0}}};
    ASSERT_TRUE(is_pinhole(expected.lens, 800, 600));
    EXPECT_EQ(parse("cam3: {camera_model: pinhole, intrinsics: [700, 700, 399.5, 299.5], "
                    "distortion_model: none, distortion_coeffs: [], resolution: [800, 600]}"),
              expected);
    EXPECT_EQ(parse("1 SIMPLE_PINHOLE 800 600 700 400 300"), expected);
    EXPECT_EQ(parse("{image_width: 800, image_height: 600, camera_matrix: {data: [700, 0, 399.5, "
                    "0, 700, 299.5, 0, 0, 1]}, distortion_coefficients: {data: [0, 0, 0, 0, 0]}}"),
              expected);
    EXPECT_EQ(parse("<calibration><projection>frame</projection><width>800</width><height>600"
                    "</height><f>700</f></calibration>"),
              expected);
}

// --- calibmar's ports -----------------------------------------------------------------------

std::string behind(std::string_view model, std::string_view parameters) {
    return fmt::format(
        "model: PINHOLE\nparameters: [700, 700, 400, 300]\nnon_svp_model: {}\n"
        "non_svp_parameters: [{}]\nwidth: 800\nheight: 600\n",
        model,
        parameters);
}

// X right is the sled's y, Y down its -x.
TEST(CalibrationFile, AFlatPortIsTurnedIntoTheSledsFrame) {
    const double z = std::sqrt(1.0 - 0.01 - 0.04);
    const CameraCalibration found = parse(
        behind("FLATPORT", fmt::format("0.1, -0.2, {}, 0.015, 0.008, 1.0003, 1.473, 1.34", z)));
    ASSERT_TRUE(found.port);
    EXPECT_FALSE(found.port->dome);
    EXPECT_LT((found.port->normal - Vector3d(0.2, 0.1, z)).norm(), kRounding);
    EXPECT_EQ(found.port->distance_m, 0.015);
    EXPECT_EQ(found.port->thickness_m, 0.008);
}

TEST(CalibrationFile, APortAcrossTheAxisIsAcrossToTheBit) {
    const CameraCalibration found =
        parse(behind("FLATPORT", "0, 0, 1, 0.015, 0.008, 1, 1.473, 1.333"));
    EXPECT_EQ(found.port->normal, Vector3d::UnitZ());
    EXPECT_FALSE(std::signbit(found.port->normal.x()));
}

TEST(CalibrationFile, ADomesCentreIsTurnedIntoTheSledsFrame) {
    const CameraCalibration found =
        parse(behind("DOMEPORT", "0.001, -0.002, 0.003, 0.05, 0.007, 1, 1.473, 1.333"));
    ASSERT_TRUE(found.port && found.port->dome);
    EXPECT_EQ(found.port->dome->centre_m, Vector3d(0.002, 0.001, 0.003));
    EXPECT_EQ(found.port->dome->radius_m, 0.05);
    EXPECT_EQ(found.port->thickness_m, 0.007);
}

TEST(CalibrationFile, RefusesPortsThatNoRigMayHave) {
    const std::string at = "cam:4: non_svp_parameters: ";
    EXPECT_EQ(error_of(behind("FLATPORT", "0, 0, 1, 0.015")), at + "found 4 numbers; allowed: 8");
    EXPECT_EQ(error_of(behind("FLATPORT", "0, 0, 2, 0.015, 0.008, 1, 1.473, 1.333")),
              at + "found the normal [0, 0, 2]; allowed: a unit vector within 60 degrees of "
                   "[0, 0, 1]");
    EXPECT_EQ(error_of(behind("FLATPORT", "0, -1, 0, 0.015, 0.008, 1, 1.473, 1.333")),
              at + "found the normal [0, -1, 0]; allowed: a unit vector within 60 degrees of "
                   "[0, 0, 1]");
    EXPECT_EQ(error_of(behind("FLATPORT", "0, 0, 1, 15, 8, 1, 1.473, 1.333")),
              at + "found int_dist 15; allowed: 0.001 to 10, in metres");
    EXPECT_EQ(error_of(behind("FLATPORT", "0, 0, 1, 0.015, 0, 1, 1.473, 1.333")),
              at + "found int_thick 0; allowed: 0.001 to 1, in metres");
    EXPECT_EQ(error_of(behind("DOMEPORT", "0, 0, 0.06, 0.05, 0.007, 1, 1.473, 1.333")),
              at + "found the centre 0.06 m from the pupil; allowed: within int_radius, 0.05 m");
    EXPECT_EQ(error_of(behind("THICK_PLANAR_REFRACTION", "0, 0, 1, 1, 1, 1, 1, 1")),
              "cam:3: non_svp_model: found 'THICK_PLANAR_REFRACTION'; allowed: NONE, FLATPORT, "
              "DOMEPORT");
}

// --- What is wrong --------------------------------------------------------------------------

// By the rules at the head of the file.
std::string with_mistake(const Mistake& mistake) {
    std::string text;
    std::string from;
    for (const auto& [key, words] : mistake.parts) {
        if (key == "of") text += seed(words);
        if (key == "-") from = words;
        if (key == "+") replace(text, from, words);
        if (key == "behind") text += words + "\n";
    }
    return text;
}

class CalibrationMistake : public testing::TestWithParam<Mistake> {};

TEST_P(CalibrationMistake, IsNamedByLineKeyWhatWasFoundAndWhatIsAllowed) {
    const std::string text = with_mistake(GetParam());
    EXPECT_EQ(error_of(text), "cam:" + GetParam().message) << text;
}

INSTANTIATE_TEST_SUITE_P(InLine,
                         CalibrationMistake,
                         testing::ValuesIn(mistakes_in("rig/camera/mistakes/calibrations.txt", 45)),
                         [](const auto& mistake) { return std::to_string(mistake.param.line); });

// COLMAP's own writer packs a camera as <Q, <I i Q Q, <d d d d.
TEST(CalibrationFile, ColmapsBinaryIsRefusedByNameAndTheWayOutTold) {
    std::string bytes;
    const auto add = [&](std::uint64_t number, int length) {
        for (int i = 0; i < length; ++i)
            bytes += static_cast<char>((number >> (8U * static_cast<unsigned>(i))) & 0xFFU);
    };
    add(1, 8);
    add(1, 4);
    add(1, 4);  // PINHOLE
    add(4000, 8);
    add(3000, 8);
    for (int i = 0; i < 4; ++i) add(0x40A7700000000000U, 8);  // 3000.0
    EXPECT_EQ(error_of(bytes),
              "cam: found COLMAP's cameras.bin, which is binary; allowed: its cameras.txt, which "
              "COLMAP writes with: colmap model_converter --input_path MODEL --output_path TEXT "
              "--output_type TXT");
}

TEST(CalibrationFile, WhatIsNoTextIsSaidByName) {
    using namespace std::string_view_literals;
    const std::string allowed =
        "; allowed, as text: camera_matrix (OpenCV, ROS), cam0 (Kalibr), model and parameters "
        "(calibmar), <calibration> (Metashape), or lines of COLMAP's cameras.txt";
    for (const auto& [bytes, kind] :
         {std::pair{"MATLAB 5.0 MAT-file, Platform\0"sv, "a MATLAB file (.mat)"},
          {"PK\x03\x04\x14\0"sv, "a zip archive, such as .xlsx, .ods or .npz"},
          {"\x93NUMPY\x01\0"sv, "a NumPy array (.npy)"},
          {"\x80\x04\x95"sv, "a pickle of Python"},
          {"\xFF\xD8\xFF\xE0"sv, "a JPEG image"},
          {"\xFF\xFE<\0"sv, "text in UTF-16"},
          {"a\0b"sv, "zero bytes"}})
        EXPECT_EQ(error_of(bytes), fmt::format("cam: found {}{}", kind, allowed));
}

// --- Hostile files --------------------------------------------------------------------------

TEST(CalibrationFile, RefusesValuesWithinValuesWithoutEnd) {
    std::string lists = "camera_matrix: ";
    for (int i = 0; i < 100; ++i) lists += '[';
    for (int i = 0; i < 100; ++i) lists += ']';
    EXPECT_EQ(error_of(lists), "cam:1: found values nested more than 16 deep; allowed: less");
    std::string elements = "<calibration>";
    for (int i = 0; i < 100; ++i) elements += "<a>";
    for (int i = 0; i < 100; ++i) elements += "</a>";
    EXPECT_EQ(error_of(elements + "</calibration>"),
              "cam:1: found values nested more than 16 deep; allowed: less");
    for (const char open : {'[', '{'}) {
        EXPECT_EQ(error_of(std::string(1'000'000, open)),
                  "cam:1: found values nested more than 16 deep; allowed: less");
    }
    EXPECT_TRUE(error_of(std::string(1'000'000, '<')).starts_with("cam:1: not valid XML: "));
}

// Nine lists of nine of the list before are 9^9 values.
TEST(CalibrationFile, RefusesAliasesOfAliases) {
    std::string bomb = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
    for (int i = 1; i < 9; ++i) {
        bomb += fmt::format("a{}: &a{} [", i, i);
        for (int k = 0; k < 9; ++k) bomb += fmt::format("*a{}{}", i - 1, k < 8 ? ", " : "]\n");
    }
    EXPECT_EQ(error_of(bomb), "cam:2: found an alias; allowed: plain values");
}

// Of which yaml-cpp makes documents without end.
TEST(CalibrationFile, RefusesACommaAfterTheLastBracket) {
    EXPECT_EQ(error_of(kFileStorageJson + ","), "cam:19: found a second document; allowed: one");
}

}  // namespace
}  // namespace aphotic::calibration_file_test
