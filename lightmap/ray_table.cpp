// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/ray_table.h"

#include "base/parallel.h"
#include "image/image_size.h"
#include "lightmap/row_light.h"
#include "rig/geometry.h"

#include <algorithm>
#include <cmath>

namespace aphotic {

namespace {

constexpr std::size_t kNodesOfCubic = 4;

std::size_t nodes_over(const Camera& camera) {
    constexpr double kShareOfFocalLength = 1.0 / 64.0;
    const double focal_px = camera.focal_length_m / camera.pixel_pitch_m;
    const double apart_px = std::min(kShareOfFocalLength * focal_px, RayTable::kMostRowsApart);
    const double steps = std::ceil(camera.height_px / apart_px);
    return std::max(kNodesOfCubic, static_cast<std::size_t>(steps) + 1);
}

// Lagrange's through 0, 1, 2, 3.
std::array<double, kNodesOfCubic> cubic_weights(double u) {
    const double a = u;
    const double b = u - 1.0;
    const double c = u - 2.0;
    const double d = u - 3.0;
    return {-b * c * d / 6.0, a * c * d / 2.0, -a * b * d / 2.0, a * b * c / 6.0};
}

// Planes of a block in the table's order.
std::array<RowBlock<double>*, 5> planes_of(RayBlock& rays) {
    return {&rays.D_x, &rays.D_y, &rays.o_x, &rays.o_y, &rays.ahead};
}

APHOTIC_WIDE void combine(const double* first,
                          std::size_t stride,
                          const std::array<double, kNodesOfCubic>& weights,
                          RowBlock<double>& values) {
    const double w_0 = weights[0], w_1 = weights[1], w_2 = weights[2], w_3 = weights[3];
    const double* const row_1 = first + stride;
    const double* const row_2 = row_1 + stride;
    const double* const row_3 = row_2 + stride;
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        values[i] = w_0 * first[i] + w_1 * row_1[i] + w_2 * row_2[i] + w_3 * row_3[i];
    }
}

}  // namespace

RayTable::RayTable(const Rig& rig, double lambda_nm, int threads)
    : height_px_(rig.camera.height_px),
      stride_((size_of(rig.camera.width_px) + kBlockCount - 1) / kBlockCount * kBlockCount),
      nodes_(nodes_over(rig.camera)),
      planes_(rig.camera.port ? 5 : 2),
      front_m_(aphotic::front_m(rig.camera.port)),
      samples_(planes_ * stride_ * nodes_) {
    parallel_for(nodes_, size_of(threads), [&](std::size_t node, std::size_t) {
        const double row =
            height_px_ * (static_cast<double>(node) / (static_cast<double>(nodes_) - 1.0));
        for (std::size_t column = 0; column < stride_; ++column) {
            // What is beyond the image counts for nothing, and must be a number.
            const int shown = std::min(static_cast<int>(column), rig.camera.width_px - 1);
            const WaterRay ray = pixel_ray(rig, shown + 0.5, row, lambda_nm);
            const Eigen::Vector3d D = ray.direction / ray.direction.z();
            const double ahead = ray.origin_m.z() - front_m_;
            const Eigen::Vector3d o_m = ray.origin_m - ahead * D;
            const std::array<double, 5> values{D.x(), D.y(), o_m.x(), o_m.y(), ahead};
            for (std::size_t k = 0; k < planes_; ++k)
                samples_[(k * nodes_ + node) * stride_ + column] = values.at(k);
        }
    });
}

RayTable::Nodes RayTable::nodes_of(int row) const {
    const double steps = static_cast<double>(nodes_) - 1.0;
    const double place = (row + 0.5) / height_px_ * steps;
    const double first = std::clamp(std::floor(place) - 1.0, 0.0, steps - 3.0);
    return {.first = static_cast<std::size_t>(first) * stride_,
            .weights = cubic_weights(place - first)};
}

void RayTable::look_from(int row, int first_column, RayBlock& rays) const {
    const Nodes nodes = nodes_of(row);
    const auto to = planes_of(rays);
    for (std::size_t k = 0; k < planes_; ++k) {
        combine(plane(k) + nodes.first + first_column, stride_, nodes.weights, *to.at(k));
    }
}

void RayTable::look_at(int row, const RowBlock<int>& columns, RayBlock& rays) const {
    const Nodes nodes = nodes_of(row);
    const auto to = planes_of(rays);
    for (std::size_t k = 0; k < planes_; ++k) {
        const double* const first = plane(k) + nodes.first;
        for (std::size_t i = 0; i < kBlockCount; ++i) {
            const double* node = first + columns[i];
            double value = 0.0;
            for (const double weight : nodes.weights) {
                value += weight * *node;
                node += stride_;
            }
            (*to.at(k))[i] = value;
        }
    }
}

std::shared_ptr<const RayTable> ray_table(const Rig& rig, double lambda_nm, int threads) {
    const Port& port = rig.camera.port;
    if (!rig.camera.lens && (!port || is_across_axis(*port))) return nullptr;
    return std::make_shared<RayTable>(rig, lambda_nm, threads);
}

}  // namespace aphotic
