// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/pov_scene.h"

#include "base/error.h"
#include "rig/camera/lens.h"
#include "rig/file/rig_reader.h"
#include "scene_gen/render_plan.h"
#include "support/refusal.h"
#include "tests/support/closed_form.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <regex>
#include <sstream>

namespace aphotic::pov_scene_test {
namespace {

using Eigen::Vector3d;
using Numbers = std::vector<double>;

constexpr double kPi = std::numbers::pi;
const std::string kLambda = "#declare Aphotic_Lambda = ";

// Straight lines between numbers that no short decimal holds.
Spectrum sloping(double first, double last) {
    return {"sloping", {400.0, 700.0}, {first, last}};
}

// No two numbers alike, no symmetry, and few of them short in decimal.
Rig odd_rig() {
    Strobe fore{.name = "fore",
                .position_m = {1.0 / 3.0, -0.1, 0.2},
                .axis = Vector3d(-0.3, 0.1, 0.9).normalized(),
                .beam = {.name = "b",
                         .weights = ConeWeights::Flux,
                         .cones = {{.part = "core", .half_angle_rad = 0.3, .weight = 0.7},
                                   {.part = "halo", .half_angle_rad = kPi / 2, .weight = 0.3}}},
                .spectrum = sloping(0.1, 0.7),
                .power = 1.1,
                .emitter = std::nullopt};
    Strobe aft = fore;
    aft.name = "aft";
    aft.position_m = {-0.7, 0.4, -0.1};
    aft.axis = Vector3d(0.2, -0.3, 0.7).normalized();
    aft.beam.cones = {{.part = "all", .half_angle_rad = 1.2, .weight = 1.0}};
    return {.title = "odd",
            .sled = {.altitude_m = 2.3, .pitch_rad = 0.07, .roll_rad = -0.05},
            .camera = {.width_px = 13,
                       .height_px = 7,
                       .pixel_pitch_m = 6.45e-4,
                       .focal_length_m = 0.0123,
                       .range = {400.0, 700.0},
                       .sensor = Sensor({sloping(1, 1), sloping(1, 1), sloping(1, 1)},
                                        ResponseKind::Energy),
                       .port = std::nullopt},
            .water = {.absorption_per_m = sloping(0.02, 0.6), .uniform_loss_per_m = 0.01},
            .seafloor = {.reflectance = sloping(0.3, 0.5)},
            .strobes = {fore, aft},
            .digest = ""};
}

Rig with_port(Rig rig) {
    rig.camera.port =
        PortWindow{.distance_m = 0.05, .thickness_m = 0.012, .glass = builtin_glass("bk7")};
    return rig;
}

struct Generated {
    std::vector<PlannedWavelength> wavelengths;
    std::vector<FrameScene> scenes;
};

Generated generated(const Rig& rig,
                    const std::vector<double>& lambda_nm = {450.0, 550.0, 650.0},
                    const SceneOptions& options = {}) {
    Generated all{.wavelengths = in_frames(rig, lambda_nm, options), .scenes = {}};
    const std::vector<LampGrid> lamps = scene_lamps(rig, all.wavelengths, options);
    all.scenes = make_scenes(rig, lamps, options, all.wavelengths);
    return all;
}

std::vector<FrameScene> scenes_of(const Rig& rig,
                                  const std::vector<double>& lambda_nm = {450.0, 550.0, 650.0},
                                  const SceneOptions& options = {}) {
    return generated(rig, lambda_nm, options).scenes;
}

std::string sdl_of(const Rig& rig) {
    return scenes_of(rig).front().sdl;
}

// The scene as POV-Ray reads it: without what stands behind // on each line.
std::string without_comments(const std::string& sdl) {
    std::istringstream lines(sdl);
    std::string rest;
    for (std::string line; std::getline(lines, line);) {
        rest += line.substr(0, line.find("//")) + "\n";
    }
    return rest;
}

Numbers numbers_in(const std::string& text) {
    static const std::regex kNumber(R"([-+]?\d+\.?\d*(e[-+]?\d+)?)");
    Numbers numbers;
    for (std::sregex_iterator at(text.begin(), text.end(), kNumber), end; at != end; ++at) {
        numbers.push_back(std::stod(at->str()));
    }
    return numbers;
}

// The numbers of each line that begins like this, comments aside.
std::vector<Numbers> numbers_after(const std::string& sdl, const std::string& start) {
    std::istringstream lines(without_comments(sdl));
    std::vector<Numbers> found;
    for (std::string line; std::getline(lines, line);) {
        const std::size_t first = line.find_first_not_of(' ');
        if (first == std::string::npos || !line.substr(first).starts_with(start)) continue;
        found.push_back(numbers_in(line.substr(first + start.size())));
    }
    return found;
}

Numbers one_after(const std::string& sdl, const std::string& start) {
    const auto found = numbers_after(sdl, start);
    EXPECT_EQ(found.size(), 1U) << "lines that begin with " << start;
    return found.empty() ? Numbers(8, 0.0) : found.front();
}

std::string input_error(const Rig& rig, const SceneOptions& options = {}) {
    return refusal_of([&] { static_cast<void>(scenes_of(rig, {450.0, 550.0, 650.0}, options)); });
}

// --- Names and order ------------------------------------------------------------------- --------

TEST(PovScene, IsNamedAfterItsWavelengths) {
    const auto scenes = scenes_of(odd_rig(), {478.0, 575.6, 638.4, 690.0});
    ASSERT_EQ(scenes.size(), 2U);
    EXPECT_EQ(scenes[0].name, "band_478_576_638nm");
    EXPECT_EQ(scenes[1].name, "band_690nm");
}

TEST(PovScene, NamesHaveDecimalsWhereWholeNumbersWouldBeAlike) {
    const auto scenes = scenes_of(
        odd_rig(), {500.0, 500.21, 500.24}, {.wavelengths_per_frame = 1, .emitter_lamps = {}});
    ASSERT_EQ(scenes.size(), 3U);
    EXPECT_EQ(scenes[0].name, "band_500.00nm");
    EXPECT_EQ(scenes[1].name, "band_500.21nm");
    EXPECT_EQ(scenes[2].name, "band_500.24nm");
}

TEST(PovScene, KeepsTheWavelengthsInTheirOrder) {
    const std::vector<double> lambda_nm{450.0, 500.0, 550.0, 600.0, 650.0};
    for (const int per_frame : {1, 2, 3}) {
        const auto scenes = scenes_of(
            odd_rig(), lambda_nm, {.wavelengths_per_frame = per_frame, .emitter_lamps = {}});
        std::vector<double> found_nm;
        for (const FrameScene& scene : scenes) {
            Numbers in_frame_nm = one_after(scene.sdl, kLambda);
            in_frame_nm.erase(std::unique(in_frame_nm.begin(), in_frame_nm.end()),
                              in_frame_nm.end());
            EXPECT_LE(in_frame_nm.size(), static_cast<std::size_t>(per_frame));
            found_nm.insert(found_nm.end(), in_frame_nm.begin(), in_frame_nm.end());
        }
        EXPECT_EQ(found_nm, lambda_nm) << per_frame << " a frame";
        EXPECT_EQ(scenes.size(),
                  (5U + static_cast<unsigned>(per_frame) - 1U) / static_cast<unsigned>(per_frame));
    }
}

// --- Numbers --------------------------------------------------------------------------- --------

// The fade law 2/(1 + (d/f)^2) deviates from 2 f^2/d^2 by (f/d)^2: under 1e-6 from the nearest
// point of the floor on. A power of two keeps the scaling exact.
TEST(PovScene, FadesByTheInverseSquareFromTheNearestFloorOn) {
    Rig rig = odd_rig();
    rig.strobes[0].position_m.z() = 2.2;  // some 12 cm above the floor
    const double fade_m = one_after(sdl_of(rig), "#declare Aphotic_Fade_Distance = ").front();
    const closed_form::Vector down = closed_form::world_down(rig.sled);
    const closed_form::Vector to_floor{
        -rig.strobes[0].position_m.x(), -rig.strobes[0].position_m.y(), 2.3 - 2.2};
    const double height_m = closed_form::dot(to_floor, down);
    EXPECT_LE(std::pow(fade_m / height_m, 2.0), 1e-6);
    EXPECT_GT(fade_m, 1e-10) << "POV-Ray takes less for no fading at all";
    EXPECT_EQ(fade_m, std::exp2(std::round(std::log2(fade_m))));
}

// --- Only what the scene requires ------------------------------------------------------ --------

TEST(PovScene, HasNoLampThatDoesNotShine) {
    Rig rig = odd_rig();
    rig.strobes[0].beam.cones[0].weight = 0.0;
    EXPECT_EQ(numbers_after(sdl_of(rig), "{").size(), 2U) << "a cone of weight 0";
    rig.strobes[0].power = 0.0;
    EXPECT_EQ(numbers_after(sdl_of(rig), "Aphotic_Strobe (").size(), 1U) << "a strobe of power 0";
}

// --- Port ------------------------------------------------------------------------------ --------

TEST(PovScene, RefusesAStrobeInTheHousing) {
    Rig rig = with_port(odd_rig());
    rig.strobes[1].position_m = {0.01, -0.01, 0.03};
    const std::string message = input_error(rig);
    EXPECT_TRUE(message.starts_with("strobe 'aft' has a lamp inside the camera's housing"))
        << message;
    rig.strobes[1].position_m = {0.0, 0.0, 0.07};
    EXPECT_EQ(input_error(rig), "nothing was said") << "in front of the port";
    rig.strobes[1].position_m = {0.01, -0.01, 0.03};
    rig.camera.port.reset();
    EXPECT_EQ(input_error(rig), "nothing was said") << "without a housing";
}

// POV-Ray passes over surfaces within 1e-4 of its units of the last.
TEST(PovScene, HasPortsInUnitsInWhichPovrayFindsTheirSurfaces) {
    Rig rig = with_port(odd_rig());
    EXPECT_EQ(scene_unit_m(rig), 1.0);
    rig.camera.port->thickness_m = 1e-3;
    EXPECT_EQ(scene_unit_m(rig), 1.0) << "the thinnest that the reader takes";
    rig.camera.port->dome = Dome{.centre_m = {0.0, 0.0, 0.04995}, .radius_m = 0.05};
    EXPECT_LE(scene_unit_m(rig), 0.05);
    EXPECT_EQ(input_error(rig), "nothing was said");
    rig.camera.port->dome->centre_m.z() = 0.049999;
    EXPECT_EQ(input_error(rig),
              "camera.port: found 0.001 mm of air between the pupil and the glass; allowed for a "
              "render: 0.01 mm or more, since POV-Ray ignores surfaces that are closer");
}

TEST(PovScene, RefusesATiltedPortThatRaysHardlyMeet) {
    Rig rig = with_port(odd_rig());
    const double tilt_rad = 87.0 * std::numbers::pi / 180.0 - half_view_rad(rig.camera);
    rig.camera.port->normal = {0.0, std::sin(tilt_rad), std::cos(tilt_rad)};
    const std::string message = input_error(rig);
    EXPECT_TRUE(message.starts_with("camera.port.normal: found a view that reaches ")) << message;
    EXPECT_TRUE(message.find("allowed for a render: up to 85") != std::string::npos) << message;
}

// Facing aft from 10 cm above the floor, with 30 cm from edge to edge.
TEST(PovScene, RefusesAnEmitterThatReachesUnderTheFloor) {
    Rig rig = odd_rig();
    rig.sled = {.altitude_m = 2.0, .pitch_rad = 0.0, .roll_rad = 0.0};
    rig.strobes[0].position_m = {0.5, 0.0, 1.9};
    rig.strobes[0].axis = -Vector3d::UnitX();
    rig.strobes[0].emitter = Emitter{.across_m = 0.01, .along_m = 0.3};
    EXPECT_EQ(input_error(rig, {.emitter_lamps = LampGrid{.across = 1, .along = 2}}),
              "nothing was said")
        << "lamps at 7.5 cm from the middle";
    const std::string message =
        input_error(rig, {.emitter_lamps = LampGrid{.across = 1, .along = 4}});
    EXPECT_TRUE(message.starts_with("strobe 'fore' has a lamp at or below the sea floor"))
        << message;
}

// --- Words of the user ----------------------------------------------------------------- --------

TEST(PovScene, KeepsTheUsersWordsInComments) {
    const Rig plain = odd_rig();
    for (const std::string words : {"\"quoted\"",
                                    "two\nlight_source { 0, 9 }",
                                    "two\rlight_source { 0, 9 }",
                                    "two\r\n#end",
                                    "*/ light_source { 0, 9 } /*",
                                    "#end",
                                    "} } }",
                                    "form\f feed\v tab",
                                    "back\\slash\\",
                                    "braces {} of fmt {0}",
                                    "K\xC3\xB6ln"}) {
        Rig rig = plain;
        rig.title = words;
        rig.strobes[0].name = words;
        rig.strobes[0].beam.name = words;
        rig.strobes[0].beam.cones[0].part = words;
        const std::string sdl = sdl_of(rig);
        EXPECT_EQ(without_comments(sdl), without_comments(sdl_of(plain))) << words;
        EXPECT_EQ(std::count(sdl.begin(), sdl.end(), '\r'), 0) << words;
        EXPECT_EQ(render_ini(rig), render_ini(plain)) << words;
    }
}

TEST(PovScene, SaysWhatItIs) {
    const std::string sdl = sdl_of(odd_rig());
    EXPECT_NE(sdl.find("// Description: odd\n"), std::string::npos);
    EXPECT_NE(sdl.find("// Strobe: fore\n"), std::string::npos);
    EXPECT_NE(sdl.find("// halo\n"), std::string::npos);
    EXPECT_NE(sdl.find("// File: band_450_550_650nm.pov\n"), std::string::npos);
    for (const char* wavelength : {"red    450 nm", "green  550 nm", "blue   650 nm"}) {
        EXPECT_NE(sdl.find(wavelength), std::string::npos) << wavelength;
    }
}

// --- Objects --------------------------------------------------------------------------- --------

Object object_of(const Shape& shape) {
    return {.name = "thing", .shape = shape, .reflectance = sloping(0.25, 0.75)};
}

TEST(PovObjects, MayNotReachIntoTheHousing) {
    Rig rig = with_port(odd_rig());
    rig.objects = {object_of(Sphere{.centre_m = {0.0, 0.0, 1.0}, .radius_m = 0.1})};
    EXPECT_NO_THROW((void)scenes_of(rig, {550.0}));
    rig.objects = {object_of(Sphere{.centre_m = {0.0, 0.0, 0.2}, .radius_m = 0.19})};
    EXPECT_THROW((void)scenes_of(rig, {550.0}), InputError);
}

}  // namespace
}  // namespace aphotic::pov_scene_test
