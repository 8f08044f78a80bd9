// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/ray_table.h"

#include "lightmap/row_light.h"
#include "rig/camera/port.h"
#include "rig/geometry.h"
#include "support/random_camera.h"
#include "support/random_rig.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace aphotic::ray_table_test {
namespace {

constexpr std::uint64_t kSeed = 16'100;
constexpr double kGreen_nm = 550.0;
// The header's 1e-9 for formulas that change over a third of f: 3^4 times as much. Places change
// over a port's size, 0.1 m at most.
constexpr double kSlopeError = 8.1e-8;
constexpr double kPlaceError_m = 0.1 * kSlopeError;

Rig rig_of(std::uint64_t seed) {
    Rig rig = random_rig(seed);
    rig.camera.port.reset();
    rig.camera.width_px = 300;
    rig.camera.height_px = 210;
    rig.camera.pixel_pitch_m = rig.camera.focal_length_m / 350.0;
    return rig;
}

// Against rays of the pixels themselves, at each row of some columns.
void expect_pixel_rays(const Rig& rig) {
    const std::shared_ptr<const RayTable> table = ray_table(rig, kGreen_nm, 1);
    ASSERT_TRUE(table);
    EXPECT_EQ(table->has_port(), rig.camera.port.has_value());
    EXPECT_EQ(table->front_m(), front_m(rig.camera.port));
    const auto block = std::make_unique<RayBlock>();
    const auto picked = std::make_unique<RayBlock>();
    RowBlock<int> columns{};
    for (std::size_t i = 0; i < kBlockCount; ++i) columns[i] = static_cast<int>((7 * i) % 300);
    for (int row = 0; row < rig.camera.height_px; ++row) {
        table->look_from(row, kRowBlock, *block);
        table->look_at(row, columns, *picked);
        const auto expect = [&](const RayBlock& rays, std::size_t i, int column) {
            const WaterRay ray = pixel_ray(rig, column + 0.5, row + 0.5, kGreen_nm);
            const Eigen::Vector3d D = ray.direction / ray.direction.z();
            const double steep = D.squaredNorm();
            EXPECT_NEAR(rays.D_x[i], D.x(), kSlopeError * steep) << column << ", " << row;
            EXPECT_NEAR(rays.D_y[i], D.y(), kSlopeError * steep) << column << ", " << row;
            if (!table->has_port()) return;
            const Eigen::Vector3d begins(rays.o_x[i] + rays.ahead[i] * rays.D_x[i],
                                         rays.o_y[i] + rays.ahead[i] * rays.D_y[i],
                                         table->front_m() + rays.ahead[i]);
            EXPECT_LT((begins - ray.origin_m).norm(), kPlaceError_m * steep);
        };
        for (std::size_t i = 0; i < kBlockCount; i += 13) {
            expect(*block, i, kRowBlock + static_cast<int>(i));
            expect(*picked, i, columns[i]);
        }
    }
}

TEST(RayTable, HasTheRaysOfEveryLens) {
    for (const LensKind kind : kLensKinds) {
        SCOPED_TRACE(static_cast<int>(kind));
        Dice dice(kSeed);
        Rig rig = rig_of(kSeed);
        give_lens(kind, dice, rig.camera);
        expect_pixel_rays(rig);
    }
}

TEST(RayTable, HasTheRaysThroughEveryPort) {
    for (const PortKind kind : kPortKinds) {
        SCOPED_TRACE(static_cast<int>(kind));
        Dice dice(kSeed + 1);
        Rig rig = rig_of(kSeed + 1);
        give_port(kind, dice, rig.camera);
        if (kind == PortKind::Flat) give_lens(LensKind::RadialTangential, dice, rig.camera);
        expect_pixel_rays(rig);
    }
}

TEST(RayTable, IsNoneWhereRaysHaveAFormula) {
    Dice dice(kSeed + 2);
    Rig rig = rig_of(kSeed + 2);
    EXPECT_EQ(ray_table(rig, kGreen_nm, 1), nullptr);
    give_port(PortKind::Flat, dice, rig.camera);
    EXPECT_EQ(ray_table(rig, kGreen_nm, 1), nullptr);
}

}  // namespace
}  // namespace aphotic::ray_table_test
