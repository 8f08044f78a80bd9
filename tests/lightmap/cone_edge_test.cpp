// SPDX-License-Identifier: BSD-3-Clause
//
// Edges of cones in the image: against a circle by closed form, and against the reference tracer,
// which has its own geometry.
#include "lightmap/cone_edge.h"

#include "base/atomic_file.h"
#include "rig/file/rig_reader.h"
#include "support/cones_seen.h"
#include "validation/tracer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aphotic::cone_edge_test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

Rig small_rig(const std::string& scene) {
    Rig rig = read_rig(std::string(APHOTIC_SOURCE_DIR) + "/scenes/" + scene);
    // The same view in fewer pixels.
    constexpr int kWidth = 160;
    rig.camera.pixel_pitch_m *= static_cast<double>(rig.camera.width_px) / kWidth;
    rig.camera.height_px = rig.camera.height_px * kWidth / rig.camera.width_px;
    rig.camera.width_px = kWidth;
    return rig;
}

// One lamp at the pupil of a level sled: its cone's edge is the circle of radius f tan(g).
TEST(ConeEdge, OneLampAtThePupilHasACircle) {
    constexpr double kAngle = 10.0 * kDegree;
    constexpr int kSide = 101;
    constexpr double kRadius_px = 35.0;
    Rig rig = small_rig("habcam.toml");
    rig.sled = {.altitude_m = 2.0, .pitch_rad = 0.0, .roll_rad = 0.0};
    rig.camera.width_px = kSide;
    rig.camera.height_px = kSide;
    rig.camera.pixel_pitch_m = rig.camera.focal_length_m * std::tan(kAngle) / kRadius_px;
    rig.strobes.erase(rig.strobes.begin() + 1, rig.strobes.end());
    rig.strobes[0].position_m.setZero();
    rig.strobes[0].axis = Eigen::Vector3d::UnitZ();
    rig.strobes[0].beam.cones = {{.part = "narrow", .half_angle_rad = kAngle, .weight = 1.0},
                                 {.part = "wide", .half_angle_rad = 90 * kDegree, .weight = 1.0},
                                 {.part = "dark", .half_angle_rad = 5 * kDegree, .weight = 0.0}};
    const ConeEdges edges(rig);
    for (const int within : {1, 2, 5}) {
        const std::vector<std::uint8_t> mask = edges.mask(rig.sled, within);
        for (int row = 0; row < kSide; ++row) {
            for (int column = 0; column < kSide; ++column) {
                const double off_px =
                    std::abs(std::hypot(column - kSide / 2, row - kSide / 2) - kRadius_px);
                const bool is_marked = mask[static_cast<std::size_t>(row * kSide + column)] != 0;
                // A step along a row or column changes the radius by 0.707 to 1, a diagonal one by
                // 1.414; the circle bends by less than 0.1 on the way.
                if (off_px < 0.70 * within - 0.1) {
                    EXPECT_TRUE(is_marked) << within << ": " << column << ", " << row;
                }
                if (off_px > 1.1 + 1.42 * (within - 1)) {
                    EXPECT_FALSE(is_marked) << within << ": " << column << ", " << row;
                }
            }
        }
    }
    EXPECT_EQ(std::ranges::count(edges.mask(rig.sled, 0), 0), kSide * kSide);
}

Rig tilted(const std::string& scene) {
    Rig rig = small_rig(scene);
    rig.sled.roll_rad = -7.0 * kDegree;
    rig.sled.altitude_m = 1.6;
    return rig;
}

TEST(ConeEdge, MarksWhatTheReferenceMarks) {
    // The reference takes up to three times this, for what a port and floors seen aslant make of a
    // pixel's angle; an edge less than 0.7 pixels away lies between the pixel and a neighbour.
    constexpr double kReach_px = 0.2;
    for (const char* scene : {"habcam.toml", "port.toml"}) {
        const Rig rig = tilted(scene);
        const Tracer tracer(rig, {.signals = false, .planes_nm = {550.0}, .threads = 2});
        const std::vector<unsigned char> wanted = tracer.on_edges(rig.camera.range, kReach_px);
        const std::vector<std::uint8_t> found = ConeEdges(rig).mask(rig.sled, 1);
        ASSERT_EQ(found.size(), wanted.size());
        std::size_t missed = 0;
        // At the image's rim, an edge may pass between a pixel and one that is not there.
        const auto width = static_cast<std::size_t>(rig.camera.width_px);
        for (std::size_t i = width; i < wanted.size() - width; ++i) {
            const bool is_inside = i % width > 0 && i % width < width - 1;
            missed += is_inside && wanted[i] > found[i] ? 1 : 0;
        }
        EXPECT_GT(std::ranges::count(wanted, 1), 100) << scene;
        EXPECT_EQ(missed, 0U) << scene;
    }
}

// To the pixel: those whose neighbours have other cones in the map's own light.
TEST(ConeEdge, MarksWhereTheMapsConesChange) {
    for (const double roll : {-7.0, 0.0, 11.0}) {
        Rig rig = tilted("habcam.toml");
        rig.sled.roll_rad = roll * kDegree;
        const std::vector<double> cones = cones_seen(rig);
        const auto width = static_cast<std::size_t>(rig.camera.width_px);
        std::vector<std::uint8_t> wanted(cones.size());
        const auto compare = [&](std::size_t a, std::size_t b) {
            if (cones[a] != cones[b]) wanted[a] = wanted[b] = 1;
        };
        for (std::size_t i = 0; i < cones.size(); ++i) {
            if (i % width > 0) compare(i, i - 1);
            if (i >= width) compare(i, i - width);
        }
        EXPECT_EQ(ConeEdges(rig).mask(rig.sled, 1), wanted) << "roll " << roll;
        EXPECT_GT(std::ranges::count(wanted, 1), 100);
    }
}

// How much a sample differs from the mean of its neighbours on both sides.
double bend(const double* sample, std::ptrdiff_t step) {
    return std::abs(sample[-step] + sample[step] - 2.0 * sample[0]) / (2.0 * sample[0]);
}

TEST(ConeEdge, OffTheMaskTracedLightIsSmooth) {
    // The light of a cone bends by less in one of these pixels; the least edge is a step of several
    // times as much.
    constexpr double kBend = 2e-3;
    for (const char* scene : {"habcam.toml", "habcam-emitters.toml", "port.toml"}) {
        const Rig rig = tilted(scene);
        const auto width = static_cast<std::size_t>(rig.camera.width_px);
        const Tracer tracer(rig, {.signals = false, .planes_nm = {450.0}, .threads = 2});
        const std::vector<double> light = tracer.rows(0, rig.camera.height_px);
        const std::vector<std::uint8_t> mask = ConeEdges(rig).mask(rig.sled, 1);
        double off = 0.0;
        double on = 0.0;
        for (std::size_t i = width; i < light.size() - width; ++i) {
            if (i % width == 0 || i % width == width - 1) continue;
            double& largest = mask[i] == 0 ? off : on;
            largest = std::max({largest,
                                bend(&light[i], 1),
                                bend(&light[i], std::ssize(mask) / rig.camera.height_px)});
        }
        EXPECT_LT(off, kBend) << scene;
        EXPECT_GT(on, 5.0 * kBend) << scene;
        EXPECT_LT(std::ranges::count(mask, 1), std::ssize(mask) / 2) << scene;
    }
}

TEST(ConeEdge, TheHorizonIsOneAndTheSkyHasNone) {
    Rig rig = small_rig("habcam.toml");
    rig.sled = {.altitude_m = 2.0, .pitch_rad = 85.0 * kDegree, .roll_rad = 0.0};
    const std::vector<std::uint8_t> mask = ConeEdges(rig).mask(rig.sled, 1);
    const auto width = static_cast<std::ptrdiff_t>(rig.camera.width_px);
    // With the bow up by 85 degrees the camera looks forward: its top rows, aft of a level sled's
    // horizon, see water alone or floor alone, and some row between sees the change in all columns.
    std::ptrdiff_t full_rows = 0;
    for (auto row = mask.begin(); row != mask.end(); row += width) {
        full_rows += std::count(row, row + width, 1) == width ? 1 : 0;
    }
    EXPECT_EQ(full_rows, 2);
}

TEST(ConeEdge, SpreadingKeepsBitsAndRowsApart) {
    constexpr int kWidth = 5;
    std::vector<std::uint8_t> mask(25);
    mask[4] = 1;   // top right corner
    mask[22] = 2;  // in the bottom row's middle
    spread(mask, kWidth, 1);
    EXPECT_EQ(mask, (std::vector<std::uint8_t>{0, 0, 0, 1, 1,  //
                                               0, 0, 0, 1, 1,  //
                                               0, 0, 0, 0, 0,  //
                                               0, 2, 2, 2, 0,  //
                                               0, 2, 2, 2, 0}));
    spread(mask, kWidth, 1);
    EXPECT_EQ(mask[2 * kWidth + 2], 3);
    EXPECT_EQ(mask[kWidth], 0);
}

TEST(ConeEdge, ImagesOfOneRowOrColumnAreMarkedAndSpreadAlongIt) {
    const std::vector<std::uint8_t> line{0, 0, 0, 1, 0, 0, 2};
    for (const int width : {1, 7}) {
        std::vector<std::uint8_t> mask = line;
        spread(mask, width, 2);
        EXPECT_EQ(mask, (std::vector<std::uint8_t>{0, 1, 1, 1, 3, 3, 2})) << width;
    }
    // The middle row and column of an image with an odd number of both.
    Rig rig = tilted("habcam.toml");
    constexpr int kSide = 101;
    rig.camera.width_px = rig.camera.height_px = kSide;
    for (const int within : {1, 3}) {
        rig.camera.width_px = rig.camera.height_px = 1;
        EXPECT_EQ(ConeEdges(rig).mask(rig.sled, within).size(), 1U);
        rig.camera.height_px = kSide;
        const std::vector<std::uint8_t> column = ConeEdges(rig).mask(rig.sled, within);
        std::swap(rig.camera.width_px, rig.camera.height_px);
        const std::vector<std::uint8_t> row = ConeEdges(rig).mask(rig.sled, within);
        for (const auto& found : {row, column}) {
            ASSERT_EQ(found.size(), 101U);
            EXPECT_GT(std::ranges::count(found, 1), 0);
            EXPECT_LT(std::ranges::count(found, 1), kSide);
        }
    }
}

}  // namespace
}  // namespace aphotic::cone_edge_test
