// SPDX-License-Identifier: BSD-3-Clause
#include "light/ray_table.h"

#include "light/lane_ray.h"
#include "rig/camera/port.h"
#include "rig/geometry.h"
#include "support/random_camera.h"
#include "support/random_rig.h"

#include <gtest/gtest.h>

#include <array>

namespace aphotic::ray_table_test {
namespace {

constexpr std::uint64_t kSeed = 16'100;
constexpr double kGreen_nm = 550.0;
constexpr double kRed_nm = 640.0;
// Of the cells that are looked at, the middles, where a cubic is off most; others may be off as
// much again.
constexpr double kError = 2.0 * kRayTableError;

Rig rig_of(std::uint64_t seed) {
    Rig rig = random_rig(seed);
    rig.camera.port.reset();
    rig.camera.width_px = 300;
    rig.camera.height_px = 210;
    rig.camera.pixel_pitch_m = rig.camera.focal_length_m / 350.0;
    return rig;
}

// Against rays of the places themselves, pixels' centres and others.
void expect_pixel_rays(const Rig& rig) {
    const RayTable table(rig, {kGreen_nm, kRed_nm}, 2);
    constexpr double kStep_px = 7.3;
    for (double row = 0.5; row < rig.camera.height_px; row += kStep_px) {
        for (double column = 0.5; column < rig.camera.width_px; column += kStep_px) {
            std::array<WaterRay, 2> found;
            table.look(column, row, found);
            const std::array nm{kGreen_nm, kRed_nm};
            for (std::size_t k = 0; k < nm.size(); ++k) {
                const WaterRay ray = pixel_ray(rig, column, row, nm[k]);
                EXPECT_LT((found[k].direction - ray.direction).norm(), kError)
                    << column << ", " << row;
                EXPECT_LT((found[k].origin_m - ray.origin_m).norm(), kError)
                    << column << ", " << row;
            }
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

// In a row of pixels between the same nodes, across nodes, and in no row.
TEST(RayTable, OfLanesHasTheRaysOfTheirPlaces) {
    constexpr double kRounding = 1e-14;
    Dice dice(kSeed + 3);
    Rig rig = rig_of(kSeed + 3);
    give_port(PortKind::Flat, dice, rig.camera);
    const RayTable table(rig, {kGreen_nm, kRed_nm}, 1);
    ASSERT_TRUE(table.has_nodes());
    for (const auto& [step_across, step_down] :
         {std::array{1.0, 0.0}, {37.0, 0.0}, {-1.0, 0.0}, {20.0, 13.0}}) {
        for (double row = 1.5; row < 100.0; row += 9.0) {
            Lanes columns{};
            Lanes rows{};
            for (std::size_t k = 0; k < kLanes; ++k) {
                columns[k] =
                    (step_across < 0.0 ? 290.5 : 0.5) + step_across * static_cast<double>(k);
                rows[k] = row + step_down * static_cast<double>(k);
            }
            std::array<LaneRay, 2> found;
            table.look(columns, rows, found);
            for (std::size_t k = 0; k < kLanes; ++k) {
                std::array<WaterRay, 2> single;
                table.look(columns[k], rows[k], single);
                for (std::size_t j = 0; j < 2; ++j) {
                    const auto direction = vector_of_lane(found[j].direction, k);
                    EXPECT_LT((direction - single[j].direction).norm(), kRounding);
                    const auto origin_m = vector_of_lane(found[j].origin_m, k);
                    EXPECT_LT((origin_m - single[j].origin_m).norm(), kRounding);
                }
            }
        }
    }
}

TEST(RayTable, AsksForEachRayWhereItHasAFormulaOrNodesWouldBeAsMany) {
    const Rig rig = rig_of(kSeed + 2);
    EXPECT_FALSE(RayTable(rig, {kGreen_nm}, 1).has_nodes());
    Dice dice(kSeed + 2);
    Rig small = rig;
    small.camera.width_px = 3;
    small.camera.height_px = 4;
    give_port(PortKind::Flat, dice, small.camera);
    const RayTable table(small, {kGreen_nm}, 1);
    EXPECT_FALSE(table.has_nodes());
    WaterRay found;
    table.look(0.5, 1.5, {&found, 1});
    EXPECT_EQ(found.direction, pixel_ray(small, 0.5, 1.5, kGreen_nm).direction);
}

}  // namespace
}  // namespace aphotic::ray_table_test
