// SPDX-License-Identifier: BSD-3-Clause
//
// Depth maps of planes, in closed form: along a ray from pupil + W o in the direction W d, a plane
// n . X = h in the world is (h - n . (pupil + W o)) / (n . W d) away.
#include "survey/relief/relief_scene.h"

#include "support/dice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace aphotic::relief_scene_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kWidth_px = 24;
constexpr int kHeight_px = 16;
constexpr double kFocal_px = 20.0;
constexpr double kHalf_m = 20.0;  // of the mesh's side
// Of a vertex to 2^-24 of 20 m, and a depth to 2^-24 of itself, seen aslant.
constexpr double kOfFloats_m = 5e-6;

WaterRay pinhole(double column, double row) {
    const Vector3d way(
        (0.5 * kHeight_px - row) / kFocal_px, (column - 0.5 * kWidth_px) / kFocal_px, 1.0);
    return {.origin_m = Vector3d(0.0, 0.0, 0.05), .direction = way.normalized()};
}

// About these axes, by hand.
Matrix3d turned(double roll, double pitch, double heading) {
    Matrix3d x, y, z;
    x << 1, 0, 0, 0, std::cos(roll), -std::sin(roll), 0, std::sin(roll), std::cos(roll);
    y << std::cos(pitch), 0, std::sin(pitch), 0, 1, 0, -std::sin(pitch), 0, std::cos(pitch);
    z << std::cos(heading), -std::sin(heading), 0, std::sin(heading), std::cos(heading), 0, 0, 0, 1;
    return z * y * x;
}

// z = depth + slopes over north and east, about a middle; and how its file has it.
struct SlopingFloor {
    Vector3d middle_m;
    double north_slope;
    double east_slope;

    [[nodiscard]] double down_at(double north_m, double east_m) const {
        return middle_m.z() + north_slope * (north_m - middle_m.x()) +
               east_slope * (east_m - middle_m.y());
    }
    [[nodiscard]] Mesh mesh(ReliefAxes axes) const {
        Mesh mesh{.vertices_m = {}, .triangles = {{0, 1, 2}, {2, 1, 3}}};
        for (const double north : {-kHalf_m, kHalf_m}) {
            for (const double east : {-kHalf_m, kHalf_m}) {
                const double n = middle_m.x() + north;
                const double e = middle_m.y() + east;
                const double down = down_at(n, e);
                mesh.vertices_m.push_back(axes == ReliefAxes::NorthEastDown ? Vector3d(n, e, down)
                                          : axes == ReliefAxes::EastNorthUp ? Vector3d(e, n, -down)
                                                                            : Vector3d(e, n, down));
            }
        }
        return mesh;
    }
    [[nodiscard]] double depth_m(const CameraStation& camera, const WaterRay& ray) const {
        const Vector3d normal(-north_slope, -east_slope, 1.0);
        const Vector3d from = camera.pupil_m + camera.turn * ray.origin_m - middle_m;
        const double length_m = -normal.dot(from) / normal.dot(camera.turn * ray.direction);
        return ray.origin_m.z() + length_m * ray.direction.z();
    }
};

// Of either frame, at any heading, and where coordinates are those of UTM.
TEST(ReliefScene, APlaneHasItsDepths) {
    Dice dice(5);
    for (int k = 0; k < 12; ++k) {
        const SlopingFloor floor{
            .middle_m = k % 2 == 0 ? Vector3d(0.0, 0.0, 3.0) : Vector3d(5123456.7, 512345.6, 101.3),
            .north_slope = dice.between(-0.3, 0.3),
            .east_slope = dice.between(-0.3, 0.3)};
        const auto axes = static_cast<ReliefAxes>(k % 3);
        const ReliefScene scene(floor.mesh(axes), axes);
        const CameraStation camera{
            .pupil_m =
                floor.middle_m + Vector3d(dice.between(-4.0, 4.0), dice.between(-4.0, 4.0), -4.0),
            .turn =
                turned(dice.between(-0.2, 0.2), dice.between(-0.2, 0.2), dice.between(-4.0, 4.0))};
        const DepthMap map = scene.depth_map(camera, pinhole, kWidth_px, kHeight_px);
        ASSERT_EQ(map.depth_m.size(), std::size_t{kWidth_px * kHeight_px});
        for (int i = 0; i < kWidth_px * kHeight_px; ++i) {
            const WaterRay ray = pinhole(i % kWidth_px + 0.5, i / kWidth_px + 0.5);
            EXPECT_NEAR(
                map.depth_m[static_cast<std::size_t>(i)], floor.depth_m(camera, ray), kOfFloats_m)
                << k << ", " << i;
        }
        const auto under = scene.floor_at(camera.pupil_m.x(), camera.pupil_m.y());
        ASSERT_TRUE(under);
        EXPECT_NEAR(*under, floor.down_at(camera.pupil_m.x(), camera.pupil_m.y()), kOfFloats_m);
    }
}

// A heading of 90 degrees: the image's top shows the east, its right the south.
TEST(ReliefScene, HeadingsTurnClockwise) {
    const SlopingFloor east{
        .middle_m = Vector3d(0.0, 0.0, 5.0), .north_slope = 0.0, .east_slope = 0.2};
    const ReliefScene scene(east.mesh(ReliefAxes::EastNorthUp), ReliefAxes::EastNorthUp);
    const double quarter = 0.5 * std::numbers::pi;
    const DepthMap map =
        scene.depth_map({.pupil_m = Vector3d::Zero(), .turn = turned(0.0, 0.0, quarter)},
                        pinhole,
                        kWidth_px,
                        kHeight_px);
    EXPECT_GT(map.depth_m.front(), 5.0F);
    EXPECT_LT(map.depth_m.back(), 5.0F);
    EXPECT_NEAR(map.depth_m[0], map.depth_m[kWidth_px - 1], kOfFloats_m);
}

// Half of the image looks past the mesh; and a camera elsewhere sees none of it.
TEST(ReliefScene, HasHolesBesideTheMesh) {
    const SlopingFloor floor{
        .middle_m = Vector3d(0.0, 0.0, 2.0), .north_slope = 0.0, .east_slope = 0.0};
    const ReliefScene scene(floor.mesh(ReliefAxes::EastNorthDown), ReliefAxes::EastNorthDown);
    const CameraStation at_edge{.pupil_m = Vector3d(0.0, kHalf_m, 0.0),
                                .turn = Matrix3d::Identity()};
    const DepthMap map = scene.depth_map(at_edge, pinhole, kWidth_px, kHeight_px);
    for (int i = 0; i < kWidth_px * kHeight_px; ++i)
        EXPECT_EQ(std::isfinite(map.depth_m[static_cast<std::size_t>(i)]),
                  i % kWidth_px < kWidth_px / 2)
            << i;
    EXPECT_TRUE(scene.is_seen(at_edge, pinhole, kWidth_px, kHeight_px));
    const CameraStation off{.pupil_m = Vector3d(0.0, 100.0, 0.0), .turn = Matrix3d::Identity()};
    EXPECT_FALSE(scene.is_seen(off, pinhole, kWidth_px, kHeight_px));
    EXPECT_FALSE(scene.floor_at(0.0, 100.0));
    const CameraStation under{.pupil_m = Vector3d(0.0, 0.0, 3.0), .turn = Matrix3d::Identity()};
    EXPECT_FALSE(scene.is_seen(under, pinhole, kWidth_px, kHeight_px));
}

}  // namespace
}  // namespace aphotic::relief_scene_test
