// SPDX-License-Identifier: BSD-3-Clause
//
// Images of a step of 0.3 m, corrected by depth maps of each kind and by meshes: one cosine lamp
// 0.3 m ahead of the camera, in water that absorbs nothing, so that the signal is z^2/d^4 in closed
// form.
#include "base/npy_file.h"
#include "rig/rig.h"
#include "support/command_test.h"
#include "support/exr_file.h"
#include "support/geotiff.h"
#include "support/png.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <sstream>
#include <vector>

namespace aphotic::relief_test {
namespace {

constexpr int kWidth_px = 64;
constexpr int kHeight_px = 48;
constexpr double kFocal_px = 100.0;
constexpr double kLamp_m = 0.3;  // ahead, up the image
constexpr double kEven = 1e-4;   // of a signal's table, floats and cells
constexpr double kUneven = 0.2;  // what a plane leaves: 0.75
constexpr const char* kRig = R"(title = "step"
[sled]
altitude_m = 2.0
[camera]
resolution = [64, 48]
pixel_pitch_um = 100.0
focal_length_mm = 10.0
range_nm = [400, 700]
response = "nikon-d5100"
[water]
multiple = 0
[seafloor]
[beam.b]
cones = [{ part = "all", half_angle_deg = 90, weight = 1 }]
[[strobe]]
name = "lamp"
position_m = [0.3, 0.0, 0.0]
direction = [0.0, 0.0, 1.0]
beam = "b"
)";

double step_m(int column) {
    return column < kWidth_px / 2 ? 2.0 : 2.3;
}

class CommandRelief : public CommandTest {
  protected:
    CommandRelief() {
        write_file(path("rig.toml"), kRig);
        write_file(path("nav.csv"), "image,altitude_m,pitch_deg,roll_deg\nstep.exr,2.0,0,0\n");
        std::vector<float> planes;
        for (int c = 0; c < 3; ++c) {
            for (int row = 0; row < kHeight_px; ++row) {
                for (int column = 0; column < kWidth_px; ++column)
                    planes.push_back(static_cast<float>(signal(column, row)));
            }
        }
        write_exr(path("step.exr"), kWidth_px, planes);
        write_depths("axis", [](int column, int /*row*/) { return step_m(column); });
    }
    static double signal(int column, int row) {
        const double z = step_m(column);
        const double ahead = z * (0.5 * kHeight_px - row - 0.5) / kFocal_px - kLamp_m;
        const double across = z * (column + 0.5 - 0.5 * kWidth_px) / kFocal_px;
        return z * z / std::pow(ahead * ahead + across * across + z * z, 2);
    }
    void write_depths(const std::string& folder,
                      const std::function<double(int column, int row)>& depth_m,
                      const std::string& name = "step") const {
        std::filesystem::create_directories(path(folder));
        std::vector<float> depths;
        for (int row = 0; row < kHeight_px; ++row)
            for (int column = 0; column < kWidth_px; ++column)
                depths.push_back(static_cast<float>(depth_m(column, row)));
        write_npy(path(folder) / (name + ".npy"), {kHeight_px, kWidth_px}, depths);
    }
    // Of a table of image, altitude_m, pitch_deg, roll_deg.
    [[nodiscard]] std::vector<Sled> poses_in(const std::string& file) const {
        constexpr double kDegree_rad = std::numbers::pi / 180.0;
        std::vector<Sled> sleds;
        std::istringstream lines(text_of(file));
        std::string line;
        std::getline(lines, line);
        for (Sled sled; std::getline(lines, line); sleds.push_back(sled)) {
            std::istringstream fields(line.substr(line.find(',') + 1));
            char comma = ' ';
            fields >> sled.altitude_m >> comma >> sled.pitch_rad >> comma >> sled.roll_rad;
            sled.pitch_rad *= kDegree_rad;
            sled.roll_rad *= kDegree_rad;
        }
        return sleds;
    }
    // Of planes below these poses, each that of the image `shift` further on.
    void write_maps(const std::vector<Sled>& sleds,
                    const std::string& folder,
                    bool is_along_ray,
                    std::size_t shift) const {
        for (std::size_t i = 0; i < sleds.size(); ++i) {
            const Sled& sled = sleds[(i + shift) % sleds.size()];
            const Eigen::Vector3d down(-std::sin(sled.pitch_rad),
                                       std::cos(sled.pitch_rad) * std::sin(sled.roll_rad),
                                       std::cos(sled.pitch_rad) * std::cos(sled.roll_rad));
            write_depths(
                folder,
                [&](int column, int row) {
                    const Eigen::Vector3d sight((0.5 * kHeight_px - row - 0.5) / kFocal_px,
                                                (column + 0.5 - 0.5 * kWidth_px) / kFocal_px,
                                                1.0);
                    const double depth_m = sled.altitude_m * down.z() / down.dot(sight);
                    return is_along_ray ? depth_m * sight.norm() : depth_m;
                },
                fmt::format("{:06}", i + 1));
        }
    }
    // The largest departure from the image's middle.
    [[nodiscard]] double unevenness(const std::string& options) const {
        std::filesystem::remove_all(path("out"));
        done(Arguments("correct step.exr --rig rig.toml --gain 1 --format exr --mask -o out " +
                       options));
        const std::vector<float> green = read_exr(path("out/step.exr"), {"G"});
        const double middle = green[green.size() / 2 + kWidth_px / 4];
        double most = 0.0;
        for (const float sample : green) most = std::max(most, std::abs(sample / middle - 1.0));
        return most;
    }
};

TEST_F(CommandRelief, AStepIsEvenByItsDepthMapAlone) {
    EXPECT_GT(unevenness("--nav nav.csv"), kUneven);
    EXPECT_LT(unevenness("--nav nav.csv --depth-map axis"), kEven);
    EXPECT_LT(unevenness("--depth-map axis"), kEven);
    EXPECT_LT(unevenness("--depth-map axis/step.npy"), kEven);
    EXPECT_LT(unevenness("--nav nav.csv --depth-map axis --normals floor"), kEven);
    write_depths("ray", [](int column, int row) {
        const double x = (column + 0.5 - 0.5 * kWidth_px) / kFocal_px;
        const double y = (row + 0.5 - 0.5 * kHeight_px) / kFocal_px;
        return step_m(column) * std::hypot(1.0, x, y);
    });
    EXPECT_LT(unevenness("--depth-map ray --depth-is ray"), kEven);
    EXPECT_GT(unevenness("--depth-map ray"), 0.5 * kUneven);
    write_depths("mm", [](int column, int /*row*/) { return 1000.0 * step_m(column); });
    EXPECT_LT(unevenness("--depth-map mm --depth-unit mm"), kEven);
}

// At 2 m, which is the left half's depth.
TEST_F(CommandRelief, IsLeftOutOfObservedMaps) {
    done(Arguments("observe step.exr --nav nav.csv --altitude 2 --depth-map axis -o map.exr"),
         "relief: depth maps of axis, along the axis");
    const std::vector<float> counts = read_exr(path("map.exr"), {"count.G"});
    for (std::size_t i = 0; i < counts.size(); ++i)
        EXPECT_EQ(counts[i], i % kWidth_px < kWidth_px / 2 ? 1.0F : 0.0F) << i;
}

// A hole of three pixels takes the plane around it, is as even as the rest, and is marked by 32;
// both sides of the step are edges, 8; and nothing else is marked.
TEST_F(CommandRelief, HolesAndJumpsAreMarked) {
    constexpr std::uint32_t kRange = 32;
    constexpr std::uint32_t kEdge = 8;
    write_depths("holes", [](int column, int row) {
        return column == 10 && row >= 20 && row < 23 ? 0.0 : step_m(column);
    });
    EXPECT_LT(unevenness("--depth-map holes --edge-px 1"), kEven);
    const DecodedPng mask = decode_png(text_of("out/step.mask.png"));
    for (int row = 0; row < kHeight_px; ++row) {
        for (int column = 0; column < kWidth_px; ++column) {
            const bool is_hole = column == 10 && row >= 20 && row < 23;
            const bool is_edge = column == kWidth_px / 2 - 1 || column == kWidth_px / 2;
            const auto i = static_cast<std::size_t>(row * kWidth_px + column);
            EXPECT_EQ(mask.pixels[i] & 0xFFU,
                      is_hole   ? kRange
                      : is_edge ? kEdge
                                : 0U)
                << column << ", " << row;
        }
    }
}

// A survey over a plane, whose depth maps are those of its true poses, in closed form: along rays
// but taken along the axis; or those of other images.
TEST_F(CommandRelief, MapsOfAnotherConventionOrOfOtherImagesAreWarnedOf) {
    constexpr int kImages = 14;
    std::string wide = kRig;
    wide.replace(wide.find("multiple = 0"), 12, "absorption = \"pope-fry-1997\"");
    write_file(path("rig.toml"), wide);
    done(
        Arguments(fmt::format("survey rig.toml --images {} --texture 0.05 --no-noise -o s "
                              "--altitude 1.5,2.5 --black-level 0 --white-level 65535",
                              kImages)));
    const std::vector<Sled> sleds = poses_in("s/navigation.txt");
    ASSERT_EQ(sleds.size(), std::size_t{kImages});
    write_maps(sleds, "right", false, 0);
    write_maps(sleds, "rays", true, 0);
    write_maps(sleds, "others", false, 3);
    const auto said = [&](const std::string& maps) {
        return done(Arguments("correct s/raw --bayer RGGB --rig rig.toml --black-level 0 "
                              "--white-level 65535 --nav s/navigation.txt -o o-" +
                              maps + " --depth-map " + maps))
            .err;
    };
    EXPECT_FALSE(has(said("right"), "depth"));
    EXPECT_TRUE(has(said("rays"), "the other depth convention"));
    EXPECT_TRUE(has(said("others"), "belong to other images"));
}

// What an image without one strobe becomes by the light that was on, on the depth map's floor, is
// what it becomes with all of them by all of it.
TEST_F(CommandRelief, AStrobeThatIsOutIsToldOnReliefToo) {
    constexpr double kOfQuantities = 0.01;  // integers of a dark corner
    std::string rig = kRig;
    rig += rig.substr(rig.find("[[strobe]]"));
    rig.replace(rig.rfind("\"lamp\""), 6, "\"aft\"");
    rig.replace(rig.rfind("[0.3,"), 5, "[-0.8,");
    rig.replace(rig.find("multiple = 0"), 12, "absorption = \"pope-fry-1997\"");
    write_file(path("rig.toml"), rig);
    const std::string survey =
        "survey rig.toml --images 10 --texture 0.05 --no-noise --electrons-per-signal 20000 "
        "--black-level 0 --white-level 65535 -o ";
    done(Arguments(survey + "lit"));
    done(Arguments(survey + "unlit --set strobe.aft.power=0"));
    write_maps(poses_in("lit/navigation.txt"), "maps", false, 0);
    const auto corrected = [&](const std::string& raw) {
        const CommandResult run =
            done(Arguments("correct " + raw +
                           "/raw --rig rig.toml --depth-map maps --bayer RGGB "
                           "--black-level 0 --white-level 65535 --gain 1 --format exr "
                           "--dropouts correct -o o-" +
                           raw));
        const std::vector<float> green = read_exr(path("o-" + raw + "/000004.exr"), {"G"});
        return std::pair(green, run.err);
    };
    const auto expected = corrected("lit").first;
    std::filesystem::copy(path("unlit/raw/000004.tif"),
                          path("lit/raw/000004.tif"),
                          std::filesystem::copy_options::overwrite_existing);
    std::filesystem::remove_all(path("o-lit"));
    const auto [found, said] = corrected("lit");
    EXPECT_TRUE(has(said, "000004.tif: strobe aft did not fire")) << said;
    for (std::size_t i = 0; i < found.size(); ++i)
        EXPECT_NEAR(found[i], expected[i], kOfQuantities * expected[i]) << i;
}

// The step in the world, its edge under a camera that is bound that way: 300 m out, 100 m deep.
class CommandMesh : public CommandRelief {
  protected:
    static constexpr double kEast_m = 500300.0;
    static constexpr double kNorth_m = 5000700.0;
    static constexpr double kDepth_m = 100.0;

    void write_place(double heading_deg, const std::string& tilts = "0,0") const {
        write_file(path("place.csv"),
                   fmt::format(
                       "image,altitude_m,pitch_deg,roll_deg,easting [m],northing [m],heading [deg],"
                       "depth [m]\nstep.exr,2.0,{},{},{},{},{}\n",
                       tilts,
                       kEast_m,
                       kNorth_m,
                       heading_deg,
                       kDepth_m));
    }
    // Corners ahead, to starboard and down of the camera, four to a face; heights up.
    void write_ply(const std::string& file,
                   double heading_deg,
                   const std::vector<std::array<double, 3>>& corners) const {
        const double heading = heading_deg * std::numbers::pi / 180.0;
        std::string ply = fmt::format(
            "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\n"
            "property double z\nelement face {}\nproperty list uchar int "
            "vertex_indices\nend_header\n",
            corners.size(),
            corners.size() / 4);
        for (const auto& [ahead, across, down] : corners)
            ply += fmt::format("{} {} {}\n",
                               kEast_m + ahead * std::sin(heading) + across * std::cos(heading),
                               kNorth_m + ahead * std::cos(heading) - across * std::sin(heading),
                               -kDepth_m - down);
        for (std::size_t i = 0; i < corners.size(); i += 4)
            ply += fmt::format("4 {} {} {} {}\n", i, i + 1, i + 2, i + 3);
        write_file(path(file), ply);
    }
    void write_step(double heading_deg) const {
        write_ply("step.ply",
                  heading_deg,
                  {{-3, -3, 2.0},
                   {3, -3, 2.0},
                   {3, 0, 2.0},
                   {-3, 0, 2.0},  //
                   {-3, 0, 2.3},
                   {3, 0, 2.3},
                   {3, 3, 2.3},
                   {-3, 3, 2.3},  //
                   {-3, 0, 2.0},
                   {3, 0, 2.0},
                   {3, 0, 2.3},
                   {-3, 0, 2.3}});
    }
    // Green of the step's image after these options.
    [[nodiscard]] std::vector<float> corrected(const std::string& options) const {
        static_cast<void>(unevenness(options));
        return read_exr(path("out/step.exr"), {"G"});
    }
    static void expect_same(const std::vector<float>& found,
                            const std::vector<float>& expected,
                            double within) {
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t i = 0; i < found.size(); ++i)
            EXPECT_NEAR(found[i], expected[i], within * expected[i]) << i;
    }
};

TEST_F(CommandMesh, AStepIsWhatItsDepthMapIs) {
    constexpr double kOfFloats = 2e-5;  // of vertices, some metres off
    const std::vector<float> by_map = corrected("--depth-map axis");
    for (const double heading_deg : {0.0, 90.0, 217.0}) {
        write_place(heading_deg);
        write_step(heading_deg);
        EXPECT_LT(unevenness("--nav place.csv --relief step.ply"), kEven) << heading_deg;
        expect_same(corrected("--nav place.csv --relief step.ply"), by_map, kOfFloats);
    }
    write_place(0.0);  // to the east of what is not turned along
    write_step(90.0);
    EXPECT_GT(unevenness("--nav place.csv --relief step.ply"), 0.5 * kUneven);
}

// Level floors under tilted cameras, and floors that are tilted under level ones, are the plane of
// the navigation: as a mesh by depth, and as a grid of heights by altitude.
TEST_F(CommandMesh, APlaneIsTheNavigationsPlane) {
    constexpr double kPitch = 7.0 * std::numbers::pi / 180.0;
    write_file(path("nav.csv"), "image,altitude_m,pitch_deg,roll_deg\nstep.exr,2.0,7,-3\n");
    const std::vector<float> by_plane = corrected("--nav nav.csv");
    write_place(40.0, "7,-3");
    std::vector<float> heights(64, -90.0F);
    write_file(
        path("level.tif"),
        geotiff_of(heights, {.width = 8, .height = 8, .tie = {4, 4, 0, kEast_m, kNorth_m, 0}}));
    expect_same(
        corrected("--nav place.csv --relief level.tif --relief-place altitude"), by_plane, kEven);
    heights.assign(64, 90.0F);
    write_file(
        path("depths.tif"),
        geotiff_of(heights, {.width = 8, .height = 8, .tie = {4, 4, 0, kEast_m, kNorth_m, 0}}));
    expect_same(corrected("--nav place.csv --relief depths.tif --relief-axes east-north-down "
                          "--relief-place altitude"),
                by_plane,
                kEven);
    write_file(path("nav.csv"), "image,altitude_m,pitch_deg,roll_deg\nstep.exr,2.0,7,0\n");
    const std::vector<float> by_pitch = corrected("--nav nav.csv");
    // With the bow up by p the floor falls away ahead by tan p.
    const double fall = 4.0 * std::tan(kPitch);
    write_ply("slope.ply",
              90.0,
              {{-4, -4, 2 - fall}, {4, -4, 2 + fall}, {4, 4, 2 + fall}, {-4, 4, 2 - fall}});
    write_place(90.0);
    for (const std::string by : {"depth", "altitude"})
        expect_same(
            corrected("--nav place.csv --relief slope.ply --relief-place " + by), by_pitch, kEven);
}

TEST_F(CommandMesh, IsSaidAndLeftOutOfObservedMaps) {
    write_place(90.0);
    write_step(90.0);
    done(Arguments("correct step.exr --rig rig.toml --gain 1 --format exr -o out --nav place.csv "
                   "--relief step.ply"),
         "relief: step.ply, east-north-up, by the navigation's depths");
    EXPECT_EQ(json_in("out/correction.json").at("settings").at("depth").at("placed_by"), "depth");
    done(Arguments(
             "observe step.exr --rig rig.toml --nav place.csv --altitude 2 --relief step.ply -o "
             "map.exr"),
         "relief: step.ply");
    const std::vector<float> counts = read_exr(path("map.exr"), {"count.G"});
    for (std::size_t i = 0; i < counts.size(); ++i)
        EXPECT_EQ(counts[i], i % kWidth_px < kWidth_px / 2 ? 1.0F : 0.0F) << i;
}

// What is beside the mesh takes the navigation's plane, and is marked.
TEST_F(CommandMesh, BesideTheMeshIsThePlane) {
    write_place(0.0);
    write_ply("half.ply", 0.0, {{-3, -3, 2}, {3, -3, 2}, {3, 0, 2}, {-3, 0, 2}});
    const std::vector<float> by_plane = corrected("--nav nav.csv");
    expect_same(corrected("--nav place.csv --relief half.ply --edge-px 0"), by_plane, kEven);
    const DecodedPng mask = decode_png(text_of("out/step.mask.png"));
    for (std::size_t i = 0; i < by_plane.size(); ++i)
        EXPECT_EQ((mask.pixels[i] & 32U) != 0, i % kWidth_px >= kWidth_px / 2) << i;
}

TEST_F(CommandMesh, WhatCannotBeIsRefused) {
    write_place(0.0);
    write_step(0.0);
    write_file(path("far.ply"), text_of("step.ply"));
    write_file(path("far.csv"),
               "image,altitude_m,east_m,north_m,heading_deg\nstep.exr,2.0,12,7,0\n");
    write_file(path("step.txt"), "");
    const std::string correct = "correct step.exr --rig rig.toml --format exr -o out ";
    const Cases cases{
        {Arguments(correct + "--relief step.ply"), "--nav"},
        {Arguments(correct + "--nav place.csv --relief step.ply --depth-map axis"), "--depth-map"},
        {Arguments(correct + "--nav place.csv --relief-axes east-north-up"), "--relief"},
        {Arguments(correct + "--nav nav.csv --relief step.ply"),
         "nav.csv: found no east_m, north_m, heading_deg for it; needed by --relief"},
        {Arguments(correct + "--nav far.csv --relief step.ply"),
         "step.ply: no image sees it: found cameras at east 12.0 to 12.0 m, north 7.0 to 7.0 "
         "m, "
         "and the mesh at east 500297.0 to 500303.0 m"},
        {Arguments(correct + "--nav place.csv --relief step.txt"), "found the extension '.txt'"},
        {Arguments("observe step.exr --nav place.csv --altitude 2 --relief step.ply -o m.exr"),
         "--relief needs --rig"}};
    for (const auto& [arguments, why] : cases) refused(arguments, why);
    write_file(path("deep.csv"),
               fmt::format("image,altitude_m,east_m,north_m,heading_deg,depth_m\n"
                           "step.exr,2.0,{},{},0,-100\n",
                           kEast_m,
                           kNorth_m));
    refused(Arguments(correct + "--nav deep.csv --relief step.ply"),
            "allowed: a mesh with the navigation's sea level");
}

TEST_F(CommandRelief, MapsThatCannotBeAreRefused) {
    write_depths("mm", [](int column, int /*row*/) { return 1000.0 * step_m(column); });
    write_depths("holes", [](int /*column*/, int /*row*/) { return 0.0; });
    std::filesystem::create_directories(path("none"));
    const std::string correct = "correct step.exr --rig rig.toml --format exr -o out ";
    const Cases cases{
        {Arguments(correct + "--depth-map mm"),
         "found a median depth of 2300 m in its depth map, and an altitude of 2 m"},
        {Arguments(correct + "--depth-map holes"), "found no depth in any of 3072 pixels"},
        {Arguments(correct + "--depth-map none"), "found no depth map for it in none"},
        {Arguments(correct + "--depth-map axis --normals floor"), "--normals floor needs --nav"},
        {Arguments(correct), "--rig needs --nav"},
        {Arguments("correct step.exr --map step.exr --depth-map axis --format exr -o out"),
         "--relief need --rig"}};
    for (const auto& [arguments, why] : cases) refused(arguments, why);
}

}  // namespace
}  // namespace aphotic::relief_test
