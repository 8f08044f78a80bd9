// SPDX-License-Identifier: BSD-3-Clause
//
// No crease that passes between a tile's pixels may be overlooked: looked for pixel by pixel, of
// random rigs with lenses, ports and beams of every kind.
#include "light/tile_cone.h"

#include "rig/geometry.h"
#include "support/random_beam.h"
#include "support/random_camera.h"
#include "support/random_rig.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <vector>

namespace aphotic::tile_cone_test {
namespace {

constexpr double kGreen_nm = 550.0;
constexpr int kTile_px = 16;

double height_over(const Crease& crease, const Eigen::Vector3d& V) {
    if (crease.is_quadratic) return V.dot(crease.Q * V) / V.squaredNorm() - crease.at;
    return crease.l.dot(V) / V.norm() - crease.at;
}

Rig rig_of_few_pixels(std::uint64_t seed) {
    Rig rig = random_rig(seed);
    rig.camera.port.reset();
    rig.camera.width_px = 80;
    rig.camera.height_px = 64;
    rig.camera.pixel_pitch_m = rig.camera.focal_length_m / 70.0;
    return rig;
}

// f(rays of the tile's places, rays of all its pixels) of each tile.
template <typename F>
void for_each_tile(const Rig& rig, const F& f) {
    const Plane floor = floor_plane(rig.sled);
    const auto ray_at = [&](double column, double row) {
        return floor_ray(pixel_ray(rig, column + 0.5, row + 0.5, kGreen_nm), floor);
    };
    for (int row = 0; row < rig.camera.height_px; row += kTile_px) {
        for (int column = 0; column < rig.camera.width_px; column += kTile_px) {
            std::vector<FloorRay> rays;
            for (const auto& [x, y] : tile_places(kTile_px, kTile_px))
                rays.push_back(ray_at(column + x, row + y));
            std::vector<FloorRay> pixels;
            for (int k = 0; k < kTile_px * kTile_px; ++k)
                pixels.push_back(ray_at(column + k % kTile_px, row + k / kTile_px));
            f(rays, pixels);
        }
    }
}

TEST(TileCone, OverlooksNoCrease) {
    int crossed = 0;
    int spared = 0;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        Dice dice(seed);
        Rig rig = rig_of_few_pixels(seed);
        if (seed % 2 == 0) give_lens(kLensKinds.at(seed / 2 % kLensKinds.size()), dice, rig.camera);
        const Strobe& strobe = rig.strobes.front();
        const Beam beam = random_beam_of(kBeamKinds.at(seed % kBeamKinds.size()), dice);
        const std::vector<Crease> creases = creases_of(beam, frame_about(strobe.axis));
        for_each_tile(rig, [&](const auto& rays, const auto& pixels) {
            const TileCone cone = tile_cone(strobe.position_m, rays);
            if (!cone.sees_all) return;
            for (const Crease& crease : creases) {
                bool is_over = false;
                bool is_under = false;
                for (const FloorRay& ray : pixels) {
                    const double height = height_over(crease, towards(strobe.position_m, ray));
                    is_over |= height >= 0.0;
                    is_under |= height <= 0.0;
                }
                const bool is_found = comes_into(cone, crease);
                if (is_over && is_under) {
                    ++crossed;
                    EXPECT_TRUE(is_found) << "seed " << seed;
                } else if (!is_found) {
                    ++spared;
                }
            }
        });
    }
    EXPECT_GT(crossed, 100);
    EXPECT_GT(spared, 2 * crossed);
}

TEST(TileCone, HoldsThePlanesOfAllItsRays) {
    double widest_rad = 0.0;
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        const Rig rig = rig_of_few_pixels(seed);
        const Eigen::Vector3d lamp_m = rig.strobes.front().position_m;
        for_each_tile(rig, [&](const auto& rays, const auto& pixels) {
            const TileCone cone = plane_cone(lamp_m, rays);
            for (const FloorRay& ray : pixels) {
                const Eigen::Vector3d normal =
                    (ray.origin_m - lamp_m).cross(ray.direction).normalized();
                const double turn_rad =
                    std::atan2(normal.cross(cone.middle).norm(), normal.dot(cone.middle));
                ASSERT_LE(turn_rad, cone.radius_rad) << "seed " << seed;
                widest_rad = std::max(widest_rad, turn_rad);
            }
        });
    }
    EXPECT_GT(widest_rad, 0.1);
}

}  // namespace
}  // namespace aphotic::tile_cone_test
