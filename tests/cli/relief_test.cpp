// SPDX-License-Identifier: BSD-3-Clause
//
// Images of a step of 0.3 m, corrected by depth maps of each kind: one cosine lamp 0.3 m ahead of
// the camera, in water that absorbs nothing, so that the signal is z^2/d^4 in closed form.
#include "base/npy_file.h"
#include "rig/rig.h"
#include "support/command_test.h"
#include "support/exr_file.h"
#include "support/png.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <sstream>

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
         "--depth-map need --rig"}};
    for (const auto& [arguments, why] : cases) refused(arguments, why);
}

}  // namespace
}  // namespace aphotic::relief_test
