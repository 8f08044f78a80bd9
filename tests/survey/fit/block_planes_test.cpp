// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/block_planes.h"

#include "lightmap/relief_map.h"
#include "support/fit_rig.h"
#include "support/hills.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace aphotic::block_planes_test {
namespace {

constexpr double kOfFloats = 1e-6;
constexpr int kWidth_px = 120;
constexpr int kHeight_px = 90;
constexpr int kBlock_px = 6;

Rig rig_of_blocks() {
    FitRigNumbers numbers;
    numbers.width_px = kWidth_px;
    numbers.height_px = kHeight_px;
    return fit_rig(numbers).rig();
}

// z by column and row. Normals are straight up: the floor's parts are level.
template <typename Depth>
Relief level_parts(const ReliefMapMaker& rays, const Depth& depth_m) {
    Relief relief{.width_px = kWidth_px, .height_px = kHeight_px};
    for (int row = 0; row < kHeight_px; ++row) {
        for (int column = 0; column < kWidth_px; ++column) {
            const WaterRay ray = rays.ray(column + 0.5, row + 0.5);
            const Eigen::Vector3d point_m =
                depth_m(column, row) / ray.direction.z() * ray.direction;
            relief.point_m.emplace_back(point_m.cast<float>());
            relief.normal.emplace_back(0.0F, 0.0F, -1.0F);
        }
    }
    return relief;
}

class BlockPlanes : public testing::Test {
  protected:
    [[nodiscard]] std::vector<Plane> planes_of(const Relief& relief) const {
        return block_planes(relief, places_, rig_);
    }
    [[nodiscard]] static bool is_known(const Plane& plane) {
        return std::isfinite(plane.point_m.z()) && std::isfinite(plane.normal.z());
    }
    // Of the block that holds a pixel.
    [[nodiscard]] std::size_t place(int column, int row) const {
        return static_cast<std::size_t>(row / kBlock_px) * places_.across() +
               static_cast<std::size_t>(column / kBlock_px);
    }

    Rig rig_ = rig_of_blocks();
    ReliefMapMaker rays_{rig_, {}};
    FitPlaces places_ = fit_places(kWidth_px, kHeight_px, kWidth_px / kBlock_px);
};

TEST_F(BlockPlanes, OfAPlaneAreThatPlane) {
    const Plane floor = floor_plane({.altitude_m = 1.7, .pitch_rad = 0.1, .roll_rad = -0.05});
    Relief relief{.width_px = kWidth_px, .height_px = kHeight_px};
    for (int row = 0; row < kHeight_px; ++row) {
        for (int column = 0; column < kWidth_px; ++column) {
            const WaterRay ray = rays_.ray(column + 0.5, row + 0.5);
            relief.point_m.emplace_back(
                (distance_to(floor, ray).value() * ray.direction).cast<float>());
            relief.normal.emplace_back(floor.normal.cast<float>());
        }
    }
    for (const Plane& plane : planes_of(relief)) {
        EXPECT_LT((plane.normal - floor.normal).norm(), kOfFloats);
        EXPECT_NEAR(floor.normal.dot(plane.point_m - floor.point_m), 0.0, kOfFloats);
    }
}

// The mean over a block of width b lies off the floor at its middle by the bend within it, a k^2
// b^2/24 each way, and the normal by about k times that.
TEST_F(BlockPlanes, OfHillsTouchThem) {
    constexpr double kBlock_m = 0.08;
    const Hills hills{.depth_m = 2.0, .height_m = 0.05, .k_per_m = 6.0};
    const double bend_m = hills.height_m * std::pow(hills.k_per_m * kBlock_m, 2) / 12.0;
    for (const Plane& plane : planes_of(relief_of(hills, rays_, kWidth_px, kHeight_px))) {
        const double x_m = plane.point_m.x();
        const double y_m = plane.point_m.y();
        EXPECT_NEAR(plane.point_m.z(), hills.z_m(x_m, y_m), bend_m);
        EXPECT_LT((plane.normal - hills.normal(x_m, y_m)).norm(), hills.k_per_m * bend_m);
    }
}

// A step of 0.3 m from column 63 on: within the blocks from column 60 to 65 the range jumps.
TEST_F(BlockPlanes, BlocksOfTwoFloorsHaveNone) {
    const Relief step =
        level_parts(rays_, [](int column, int /*row*/) { return column < 63 ? 2.3 : 2.0; });
    const std::vector<Plane> planes = planes_of(step);
    for (int row = 0; row < kHeight_px; row += kBlock_px) {
        EXPECT_FALSE(is_known(planes[place(62, row)])) << row;
        EXPECT_TRUE(is_known(planes[place(66, row)])) << row;
        EXPECT_TRUE(is_known(planes[place(10, row)])) << row;
    }
}

// A post before the middle of the image, 0.5 m high. By similar triangles the lamp 0.5 m ahead
// throws its shadow backwards, the one behind forwards; beside it there is none.
TEST_F(BlockPlanes, BlocksInAStrobesShadowHaveNone) {
    const Relief post = level_parts(rays_, [](int column, int row) {
        return column >= 54 && column < 66 && row >= 42 && row < 48 ? 1.5 : 2.0;
    });
    const std::vector<Plane> planes = planes_of(post);
    EXPECT_FALSE(is_known(planes[place(60, 50)]));
    EXPECT_FALSE(is_known(planes[place(60, 39)]));
    EXPECT_TRUE(is_known(planes[place(10, 50)]));
    EXPECT_TRUE(is_known(planes[place(110, 39)]));
    EXPECT_TRUE(is_known(planes[place(60, 10)]));
    EXPECT_TRUE(is_known(planes[place(60, 45)]));  // its top
}

TEST_F(BlockPlanes, BlocksOfUnknownPixelsHaveNone) {
    Relief flat = level_parts(rays_, [](int /*column*/, int /*row*/) { return 2.0; });
    flat.point_m[flat.at(40, 40)].setConstant(std::numeric_limits<float>::quiet_NaN());
    std::size_t unknown = 0;
    for (const Plane& plane : planes_of(flat)) unknown += is_known(plane) ? 0 : 1;
    EXPECT_EQ(unknown, 1U);
}

}  // namespace
}  // namespace aphotic::block_planes_test
