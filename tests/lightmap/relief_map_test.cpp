// SPDX-License-Identifier: BSD-3-Clause
//
// Light on a relief against the reference tracer, whose objects and floor tell points, normals and
// shadows by themselves; and on a relief that is a plane against the lightmap of that.
#include "lightmap/relief_map.h"

#include "spectral/phase_loader.h"
#include "support/dice.h"
#include "support/flat.h"
#include "support/random_camera.h"
#include "support/scene_rig.h"
#include "validation/tracer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace aphotic::relief_map_test {
namespace {

// Off edges: cells are checked to kReliefError in their middles, points are floats, the signal's
// own table and spectrum are right to 1e-5.
constexpr double kOfLight = 2e-4;
// Of the signal: sights touch beams' edges between the veil's places and depths, at few pixels.
constexpr double kOfVeil = 1e-2;
constexpr double kOfMostVeil = 1e-3;
constexpr double kMost = 0.98;
constexpr int kEdge_px = 2;

Relief plane_of(const Rig& rig, const ReliefMapMaker& maker) {
    Relief relief{.width_px = rig.camera.width_px, .height_px = rig.camera.height_px};
    const Plane floor = floor_plane(rig.sled);
    for (int row = 0; row < relief.height_px; ++row) {
        for (int column = 0; column < relief.width_px; ++column) {
            const WaterRay ray = maker.ray(column + 0.5, row + 0.5);
            const double length_m = distance_to(floor, ray).value();
            const Eigen::Vector3d point_m = ray.origin_m + length_m * ray.direction;
            relief.point_m.emplace_back(point_m.cast<float>());
            relief.normal.emplace_back(floor.normal.cast<float>());
        }
    }
    return relief;
}

// Of the signal off edges, ascending: how far the one is from the other.
std::vector<double> differences(const ReliefMap& found,
                                const std::vector<float>& of,
                                const std::vector<float>& wanted,
                                const Lightmap& expected) {
    const std::vector<float> signal = signal_of(expected);
    std::vector<double> all;
    for (std::size_t i = 0; i < of.size(); ++i) {
        if (found.edges[i % found.edges.size()] == 0)
            all.push_back(std::abs(of[i] - wanted[i]) / signal[i]);
    }
    std::ranges::sort(all);
    return all;
}

Object thing(const std::string& name, Shape shape, const Rig& rig) {
    return {.name = name, .shape = std::move(shape), .reflectance = rig.seafloor.reflectance};
}

}  // namespace

TEST(ReliefMap, OnAPlaneIsTheLightmapBehindAnyLensAndPort) {
    Dice dice(7);
    for (int k = 0; k < 6; ++k) {
        Rig rig = habcam(240, 180);
        rig.sled = {.altitude_m = dice.between(1.5, 3.0),
                    .pitch_rad = dice.between(-0.2, 0.2),
                    .roll_rad = dice.between(-0.2, 0.2)};
        if (k % 2 == 1) give_lens(kLensKinds.at(static_cast<std::size_t>(k / 2)), dice, rig.camera);
        if (k >= 3) give_port(kPortKinds.at(static_cast<std::size_t>(k - 3)), dice, rig.camera);
        if (k % 3 == 2) give_vignetting(static_cast<std::size_t>(k), dice, rig.camera);
        const ReliefMapMaker maker(rig, {});
        const ReliefMap found = maker.map(plane_of(rig, maker), kEdge_px);
        const Lightmap expected = LightmapMaker(rig, std::nullopt, {}).map(rig.sled);
        EXPECT_LT(differences(found, found.map.samples, expected.samples, expected).back(),
                  kOfLight)
            << k;
        std::size_t on_edges = 0;
        for (const std::uint8_t edge : found.edges) on_edges += edge;
        EXPECT_LT(on_edges, found.edges.size() / 2) << k;
    }
}

TEST(ReliefMap, HasTheVeilUpToEachPixelsRange) {
    Dice dice(3);
    for (int k = 0; k < 4; ++k) {
        Rig rig = habcam(160, 120);
        rig.water.absorption_per_m = flat(0.1);
        rig.water.scatterers = {{flat(0.2), builtin_phase("petzold")}};
        rig.sled = {.altitude_m = dice.between(1.5, 3.0),
                    .pitch_rad = dice.between(-0.3, 0.3),
                    .roll_rad = dice.between(-0.3, 0.3)};
        if (k == 3) give_port(kPortKinds.at(0), dice, rig.camera);
        const ReliefMapMaker maker(rig, {});
        const ReliefMap found = maker.map(plane_of(rig, maker), kEdge_px);
        const Lightmap expected = LightmapMaker(rig, std::nullopt, {}).map(rig.sled);
        ASSERT_EQ(found.map.veil.size(), expected.veil.size());
        const auto off = differences(found, found.map.veil, expected.veil, expected);
        EXPECT_LT(off.back(), kOfVeil) << k;
        EXPECT_LT(off[static_cast<std::size_t>(kMost * static_cast<double>(off.size()))],
                  kOfMostVeil)
            << k;
    }
}

// Both cast shadows on the floor, and the ball on the block.
TEST(ReliefMap, OverABlockAndABallIsTheReferences) {
    Rig rig = habcam(320, 240);
    rig.sled.altitude_m = 2.5;
    for (Strobe& strobe : rig.strobes) strobe.emitter.reset();
    rig.objects.push_back(
        thing("block", Box{.least_m = {-0.5, -0.3, 2.1}, .most_m = {0.1, 0.2, 2.5}}, rig));
    rig.objects.push_back(
        thing("ball", Sphere{.centre_m = {0.35, 0.45, 2.2}, .radius_m = 0.25}, rig));
    const Tracer tracer(rig, {});
    const std::vector<unsigned char> edges = tracer.on_edges(rig.camera.range, kEdge_px);
    const std::vector<double> expected = tracer.rows(0, rig.camera.height_px);
    Rig bare = rig;
    bare.objects.clear();
    const ReliefMapMaker maker(bare, {});
    Relief relief{.width_px = rig.camera.width_px, .height_px = rig.camera.height_px};
    for (int row = 0; row < relief.height_px; ++row) {
        for (int column = 0; column < relief.width_px; ++column) {
            const auto seen = tracer.seen(column + 0.5, row + 0.5, 550.0).value();
            relief.point_m.emplace_back(seen.point_m.cast<float>());
            relief.normal.emplace_back(seen.normal.cast<float>());
        }
    }
    const ReliefMap found = maker.map(relief, kEdge_px);
    std::size_t compared = 0;
    std::size_t off = 0;
    std::size_t shaded = 0;
    const Lightmap plane = LightmapMaker(bare, std::nullopt, {}).map(bare.sled);
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const std::size_t pixel = i % edges.size();
        if (edges[pixel] != 0 || found.edges[pixel] != 0) continue;
        ++compared;
        off += std::abs(found.map.samples[i] - expected[i]) > kOfLight * expected[i] ? 1 : 0;
        shaded += expected[i] < 0.7 * static_cast<double>(plane.samples[i]) ? 1 : 0;
    }
    EXPECT_GT(compared, expected.size() / 2) << expected.size();
    EXPECT_GT(shaded, expected.size() / 50) << shaded << "else no shadow is told apart";
    // The shadow's own border is known to a vertex of the mesh, a pixel here.
    EXPECT_LE(off, compared / 1000) << off << " of " << compared;
}

// Each row of an image is an image by itself, of which every pixel has its light.
TEST(ReliefMap, OfOneRowIsThatRow) {
    const Rig rig = habcam(64, 48);
    Rig row_rig = rig;
    row_rig.camera.height_px = 1;
    const ReliefMapMaker maker(rig, {});
    const Relief whole = plane_of(rig, maker);
    constexpr int kRow = 20;
    Relief one{.width_px = whole.width_px, .height_px = 1};
    for (int column = 0; column < whole.width_px; ++column) {
        one.point_m.push_back(whole.point_m[whole.at(column, kRow)]);
        one.normal.push_back(whole.normal[whole.at(column, kRow)]);
    }
    const ReliefMap found = ReliefMapMaker(row_rig, {}).map(one, 0);
    const ReliefMap expected = maker.map(whole, kEdge_px);
    for (int column = 0; column < whole.width_px; ++column) {
        const std::size_t there = whole.at(column, kRow);
        if (expected.edges[there] != 0) continue;
        EXPECT_NEAR(found.map.samples[static_cast<std::size_t>(column)],
                    expected.map.samples[there],
                    kOfLight * expected.map.samples[there])
            << column;
    }
}

// No light comes back from beyond kReliefPaths, and the veil ends there.
TEST(ReliefMap, IsDarkFarAway) {
    Rig rig = habcam(64, 48);
    rig.water.absorption_per_m = flat(0.1);
    rig.water.scatterers = {{flat(0.2), builtin_phase("petzold")}};
    const ReliefMapMaker maker(rig, {});
    Relief relief = plane_of(rig, maker);
    relief.point_m[relief.at(20, 20)] *= 1e4F;
    const ReliefMap found = maker.map(relief, 0);
    EXPECT_EQ(found.map.samples[relief.at(20, 20)], 0.0F);
    EXPECT_GT(found.map.veil[relief.at(20, 20)], found.map.veil[relief.at(20, 22)]);
    EXPECT_LT(found.map.veil[relief.at(20, 20)], 2.0F * found.map.veil[relief.at(20, 22)]);
}

TEST(ReliefMap, IsDarkWhereNothingIsKnown) {
    const Rig rig = habcam(64, 48);
    const ReliefMapMaker maker(rig, {});
    Relief relief = plane_of(rig, maker);
    relief.point_m[relief.at(20, 20)].setConstant(std::numeric_limits<float>::quiet_NaN());
    const ReliefMap found = maker.map(relief, 1);
    EXPECT_EQ(found.map.samples[relief.at(20, 20)], 0.0F);
    EXPECT_EQ(found.edges[relief.at(20, 20)], 1);
    EXPECT_EQ(found.edges[relief.at(20, 22)], 0);
    EXPECT_GT(found.map.samples[relief.at(20, 22)], 0.0F);
}

}  // namespace aphotic::relief_map_test
