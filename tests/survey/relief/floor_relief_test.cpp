// SPDX-License-Identifier: BSD-3-Clause
#include "survey/relief/floor_relief.h"

#include "support/dice.h"
#include "support/has.h"
#include "support/random_camera.h"
#include "support/refusal.h"
#include "support/scene_rig.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace aphotic::floor_relief_test {
namespace {

constexpr double kOfFloats_m = 1e-5;
constexpr float kHole = std::numeric_limits<float>::quiet_NaN();

Rig rig_of(int width_px, int height_px) {
    Rig rig = habcam(width_px, height_px);
    rig.sled = {.altitude_m = 2.2, .pitch_rad = 0.15, .roll_rad = -0.1};
    return rig;
}

// Of the plane of the rig's sled.
DepthMap map_of(const Rig& rig, const ReliefMapMaker& rays, DepthIs is) {
    DepthMap map{.width_px = rig.camera.width_px, .height_px = rig.camera.height_px, .depth_m = {}};
    for (int row = 0; row < map.height_px; ++row) {
        for (int column = 0; column < map.width_px; ++column) {
            const WaterRay ray = rays.ray(column + 0.5, row + 0.5);
            const double length_m = distance_to(floor_plane(rig.sled), ray).value();
            const Eigen::Vector3d point_m = ray.origin_m + length_m * ray.direction;
            const double depth_m = is == DepthIs::AlongAxis ? point_m.z() : point_m.norm();
            map.depth_m.push_back(static_cast<float>(depth_m));
        }
    }
    return map;
}

double off_plane_m(const Relief& relief, std::size_t pixel, const Sled& sled) {
    return std::abs(height_above(floor_plane(sled), relief.point_m[pixel].cast<double>()));
}

}  // namespace

TEST(FloorRelief, HasThePointsOfEitherConventionBehindAnyPort) {
    Dice dice(11);
    for (int k = 0; k < 8; ++k) {
        Rig rig = rig_of(64, 48);
        if (k % 4 > 0)
            give_port(kPortKinds.at(static_cast<std::size_t>(k % 4 - 1)), dice, rig.camera);
        const DepthIs is = k < 4 ? DepthIs::AlongAxis : DepthIs::AlongRay;
        const ReliefMapMaker rays(rig, {});
        const FloorRelief found =
            floor_relief(map_of(rig, rays, is), is, NormalsFrom::Depth, rays, std::nullopt);
        for (std::size_t i = 0; i < found.relief.point_m.size(); ++i) {
            EXPECT_LT(off_plane_m(found.relief, i, rig.sled), kOfFloats_m) << k << ", " << i;
            const Eigen::Vector3d normal = found.relief.normal[i].cast<double>();
            EXPECT_GT(normal.dot(floor_plane(rig.sled).normal), 1.0 - 1e-6) << k << ", " << i;
        }
    }
}

// A small hole takes the plane around it, a large one the navigation's, or nothing.
TEST(FloorRelief, FillsHoles) {
    const Rig rig = rig_of(180, 120);
    const ReliefMapMaker rays(rig, {});
    DepthMap map = map_of(rig, rays, DepthIs::AlongAxis);
    const auto at = [&](int column, int row) {
        return static_cast<std::size_t>(row * 180 + column);
    };
    for (int row = 50; row < 53; ++row)
        for (int column = 50; column < 53; ++column) map.depth_m[at(column, row)] = kHole;
    for (int row = 60; row < 120; ++row)
        for (int column = 100; column < 180; ++column) map.depth_m[at(column, row)] = kHole;
    const auto made = [&](const std::optional<Sled>& floor) {
        return floor_relief(map, DepthIs::AlongAxis, NormalsFrom::Depth, rays, floor);
    };
    const FloorRelief without = made(std::nullopt);
    EXPECT_EQ(without.filled[at(51, 51)], 1);
    EXPECT_EQ(without.filled[at(49, 49)], 0);
    EXPECT_LT(off_plane_m(without.relief, at(51, 51), rig.sled), kOfFloats_m);
    EXPECT_FALSE(without.relief.knows(at(150, 100)));
    Sled other = rig.sled;
    other.altitude_m += 0.1;
    const FloorRelief with = made(other);
    EXPECT_LT(off_plane_m(with.relief, at(150, 100), other), kOfFloats_m);
    EXPECT_LT(off_plane_m(with.relief, at(51, 51), rig.sled), kOfFloats_m);
    map.depth_m.assign(map.depth_m.size(), kHole);
    EXPECT_TRUE(
        has(refusal_of([&] { (void)made(std::nullopt); }), "no depth in any of 21600 pixels"));
}

}  // namespace aphotic::floor_relief_test
