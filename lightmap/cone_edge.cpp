// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/cone_edge.h"

#include "scene_gen/geometry.h"
#include "spectral/image_size.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace aphotic {

namespace {

constexpr double kRightAngle = 0.5 * std::numbers::pi;

// An emitter's rim at its corners and half way between them, and its middle; a point's own
// position.
std::vector<Eigen::Vector3f> places_of(const Strobe& strobe) {
    if (!strobe.emitter) return {strobe.position_m.cast<float>()};
    // The centres of a grid of three by three cells lie two thirds of the way to the rim.
    constexpr double kToTheRim = 1.5;
    std::vector<Eigen::Vector3f> places;
    for (const Eigen::Vector3d& centre : lamp_positions_m(strobe, {.across = 3, .along = 3})) {
        places.push_back(
            (strobe.position_m + kToTheRim * (centre - strobe.position_m)).cast<float>());
    }
    return places;
}

}  // namespace

ConeEdges::ConeEdges(const Rig& rig)
    : width_px_(rig.camera.width_px), height_px_(rig.camera.height_px) {
    std::vector<double> ends_nm{rig.camera.range.first_nm};
    if (rig.camera.port) ends_nm.push_back(rig.camera.range.last_nm);
    const std::size_t pixels = size_of(width_px_) * size_of(height_px_);
    for (const double lambda_nm : ends_nm) {
        Rays& rays = rays_.emplace_back();
        for (auto* plane : {&rays.x_m, &rays.y_m, &rays.slope_x, &rays.slope_y}) {
            plane->reserve(pixels);
        }
        for (int row = 0; row < height_px_; ++row) {
            for (int column = 0; column < width_px_; ++column) {
                const WaterRay ray = pixel_ray(rig, column + 0.5, row + 0.5, lambda_nm);
                rays.of_z_m = static_cast<float>(ray.origin_m.z());
                rays.x_m.push_back(static_cast<float>(ray.origin_m.x()));
                rays.y_m.push_back(static_cast<float>(ray.origin_m.y()));
                rays.slope_x.push_back(static_cast<float>(ray.direction.x() / ray.direction.z()));
                rays.slope_y.push_back(static_cast<float>(ray.direction.y() / ray.direction.z()));
            }
        }
    }
    for (const Strobe& strobe : rig.strobes) {
        for (const aphotic::Cone& cone : strobe.beam.cones) {
            if (cone.weight == 0.0 || strobe.power == 0.0 || cone.half_angle_rad >= kRightAngle) {
                continue;
            }
            const double cos_edge = std::cos(cone.half_angle_rad);
            cones_.push_back({.lamps_m = places_of(strobe),
                              .axis = strobe.axis.cast<float>(),
                              .cos2_edge = static_cast<float>(cos_edge * cos_edge)});
        }
    }
}

std::size_t ConeEdges::most_of(std::size_t thing) const {
    return rays_.size() * (thing == 0 ? 1 : cones_[thing - 1].lamps_m.size());
}

void ConeEdges::count_row(int row, const Sled& sled, Counts& counts) const {
    const std::size_t width = size_of(width_px_);
    const std::size_t first = size_of(row) * width;
    const Plane floor = floor_plane(sled);
    const Eigen::Vector3f normal = floor.normal.cast<float>();
    const auto height = static_cast<float>(floor.normal.dot(floor.point_m));
    std::vector<float> x_m(width);
    std::vector<float> y_m(width);
    std::vector<float> z_m(width);
    std::vector<std::uint8_t> is_seen(width);
    for (auto& thing : counts) thing.assign(width, 0);
    for (const Rays& rays : rays_) {
        const float height_z = height - normal.z() * rays.of_z_m;
        for (std::size_t i = 0; i < width; ++i) {
            const std::size_t p = first + i;
            const float left = height_z - normal.x() * rays.x_m[p] - normal.y() * rays.y_m[p];
            const float fall =
                normal.x() * rays.slope_x[p] + normal.y() * rays.slope_y[p] + normal.z();
            const float depth_m = left / fall;
            is_seen[i] = depth_m > 0.0F ? 1 : 0;
            x_m[i] = rays.x_m[p] + depth_m * rays.slope_x[p];
            y_m[i] = rays.y_m[p] + depth_m * rays.slope_y[p];
            z_m[i] = rays.of_z_m + depth_m;
            counts[0][i] += is_seen[i];
        }
        for (std::size_t k = 0; k < cones_.size(); ++k) {
            const Cone& cone = cones_[k];
            std::vector<std::uint8_t>& within = counts[k + 1];
            for (const Eigen::Vector3f& lamp : cone.lamps_m) {
                for (std::size_t i = 0; i < width; ++i) {
                    const float x = x_m[i] - lamp.x();
                    const float y = y_m[i] - lamp.y();
                    const float z = z_m[i] - lamp.z();
                    const float along = x * cone.axis.x() + y * cone.axis.y() + z * cone.axis.z();
                    const float edge2 = (x * x + y * y + z * z) * cone.cos2_edge;
                    const bool is_within = along > 0.0F && along * along >= edge2;
                    within[i] += static_cast<std::uint8_t>(is_within ? is_seen[i] : 0);
                }
            }
        }
    }
}

std::vector<std::uint8_t> ConeEdges::mask(const Sled& sled, int within_px) const {
    const std::size_t width = size_of(width_px_);
    std::vector<std::uint8_t> mask(width * size_of(height_px_));
    if (within_px == 0) return mask;
    Counts counts(cones_.size() + 1);
    Counts above(counts);
    for (int row = 0; row < height_px_; ++row) {
        count_row(row, sled, counts);
        const std::size_t first = size_of(row) * width;
        for (std::size_t k = 0; k < counts.size(); ++k) {
            const std::vector<std::uint8_t>& now = counts[k];
            const std::size_t most = most_of(k);
            for (std::size_t i = 0; i < width; ++i) {
                mask[first + i] |= static_cast<std::uint8_t>(now[i] > 0 && now[i] < most);
            }
            for (std::size_t i = 1; i < width; ++i) {
                const auto differs = static_cast<std::uint8_t>(now[i] != now[i - 1]);
                mask[first + i] |= differs;
                mask[first + i - 1] |= differs;
            }
            for (std::size_t i = 0; row > 0 && i < width; ++i) {
                const auto differs = static_cast<std::uint8_t>(now[i] != above[k][i]);
                mask[first + i] |= differs;
                mask[first + i - width] |= differs;
            }
        }
        std::swap(counts, above);
    }
    spread(mask, width_px_, within_px - 1);
    return mask;
}

void spread(std::vector<std::uint8_t>& mask, int width_px, int within_px) {
    const std::size_t width = size_of(width_px);
    for (int step = 0; step < within_px; ++step) {
        const std::vector<std::uint8_t> before = mask;
        for (std::size_t i = width; i < mask.size(); ++i) {
            mask[i] |= before[i - width];
            mask[i - width] |= before[i];
        }
        const std::vector<std::uint8_t> rows = mask;
        for (std::size_t start = 0; start < mask.size(); start += width) {
            for (std::size_t i = start + 1; i < start + width; ++i) {
                mask[i] |= rows[i - 1];
                mask[i - 1] |= rows[i];
            }
        }
    }
}

}  // namespace aphotic
