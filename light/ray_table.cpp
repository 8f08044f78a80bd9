// SPDX-License-Identifier: BSD-3-Clause
#include "light/ray_table.h"

#include "base/parallel.h"
#include "image/image_size.h"
#include "rig/geometry.h"

#include <algorithm>
#include <cmath>

namespace aphotic {
namespace {

constexpr std::size_t kNodesOfCubic = 4;

// Lagrange's through 0, 1, 2, 3.
std::array<double, kNodesOfCubic> cubic_weights(double u) {
    const double a = u;
    const double b = u - 1.0;
    const double c = u - 2.0;
    const double d = u - 3.0;
    return {-b * c * d / 6.0, a * c * d / 2.0, -a * b * d / 2.0, a * b * c / 6.0};
}

// The first of the four nodes about a place, and what each counts.
struct Stencil {
    std::size_t first;
    std::array<double, kNodesOfCubic> weights;
};

Stencil stencil_at(double place, double pixels, std::size_t nodes) {
    const double steps = static_cast<double>(nodes) - 1.0;
    const double node = place / pixels * steps;
    const double first = std::clamp(std::floor(node) - 1.0, 0.0, steps - 3.0);
    return {.first = static_cast<std::size_t>(first), .weights = cubic_weights(node - first)};
}

double apart_px(const Camera& camera) {
    constexpr double kShareOfFocalLength = 1.0 / 64.0;
    return kShareOfFocalLength * camera.focal_length_m / camera.pixel_pitch_m;
}

}  // namespace

RayTable::Axis::Axis(int pixels_, double most_apart_px)
    : pixels(pixels_),
      nodes(std::max(kNodesOfCubic,
                     static_cast<std::size_t>(std::ceil(pixels_ / most_apart_px)) + 1)) {}

RayTable::RayTable(const Rig& rig, double lambda_nm, int threads)
    : rig_(rig),
      lambda_nm_(lambda_nm),
      across_(rig.camera.width_px, apart_px(rig.camera)),
      down_(rig.camera.height_px, apart_px(rig.camera)) {
    const std::size_t pixels = size_of(rig.camera.width_px) * size_of(rig.camera.height_px);
    const bool has_formula = !rig.camera.lens && !rig.camera.port;
    if (has_formula || across_.nodes * down_.nodes >= pixels) return;
    nodes_.resize(across_.nodes * down_.nodes);
    parallel_for(down_.nodes, size_of(threads), [&](std::size_t j, std::size_t) {
        const auto place = [](const Axis& axis, std::size_t node) {
            return axis.pixels *
                   (static_cast<double>(node) / (static_cast<double>(axis.nodes) - 1.0));
        };
        for (std::size_t i = 0; i < across_.nodes; ++i) {
            const WaterRay ray = pixel_ray(rig_, place(across_, i), place(down_, j), lambda_nm_);
            Node& node = nodes_[j * across_.nodes + i];
            std::copy_n(ray.origin_m.data(), 3, node.begin());
            std::copy_n(ray.direction.data(), 3, node.begin() + 3);
        }
    });
}

WaterRay RayTable::at(double column, double row) const {
    if (nodes_.empty()) return pixel_ray(rig_, column, row, lambda_nm_);
    const Stencil across = stencil_at(column, across_.pixels, across_.nodes);
    const Stencil down = stencil_at(row, down_.pixels, down_.nodes);
    Node sum{};
    for (std::size_t j = 0; j < kNodesOfCubic; ++j) {
        const Node* const row_of_nodes = &nodes_[(down.first + j) * across_.nodes + across.first];
        for (std::size_t i = 0; i < kNodesOfCubic; ++i) {
            const double weight = down.weights[j] * across.weights[i];
            for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += weight * row_of_nodes[i][k];
        }
    }
    return {.origin_m = {sum[0], sum[1], sum[2]},
            .direction = Eigen::Vector3d(sum[3], sum[4], sum[5]).normalized()};
}

}  // namespace aphotic
