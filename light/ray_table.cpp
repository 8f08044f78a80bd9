// SPDX-License-Identifier: BSD-3-Clause
#include "light/ray_table.h"

#include "base/parallel.h"
#include "image/image_size.h"
#include "rig/camera/lens.h"
#include "rig/geometry.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace aphotic {
namespace {

constexpr std::size_t kNodesOfCubic = 4;

// Lagrange's cubic through 0, 1, 2, 3.
std::array<double, kNodesOfCubic> cubic_weights(double u) {
    const double a = u;
    const double b = u - 1.0;
    const double c = u - 2.0;
    const double d = u - 3.0;
    return {-b * c * d / 6.0, a * c * d / 2.0, -a * b * d / 2.0, a * b * c / 6.0};
}

// The first of the four nodes around a place, and their weights.
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

}  // namespace

RayTable::Axis::Axis(int count, double most_apart_px)
    : pixels(count),
      nodes(std::max(kNodesOfCubic,
                     static_cast<std::size_t>(std::ceil(count / most_apart_px)) + 1)) {}

double RayTable::Axis::place_px(double node) const {
    return pixels * (node / (static_cast<double>(nodes) - 1.0));
}

RayTable::RayTable(const Rig& rig, std::vector<double> lambda_nm, int threads)
    : rig_(rig), lambda_nm_(std::move(lambda_nm)), across_(1, 1.0), down_(1, 1.0) {
    if (!rig.camera.lens && !rig.camera.port) return;
    constexpr double kFirstOfFocalLength = 1.0 / 32.0;
    const double pixels = static_cast<double>(rig.camera.width_px) * rig.camera.height_px;
    double apart_px = kFirstOfFocalLength * rig.camera.focal_length_m / rig.camera.pixel_pitch_m;
    do {
        across_ = Axis(rig.camera.width_px, apart_px);
        down_ = Axis(rig.camera.height_px, apart_px);
        nodes_.clear();
        if (static_cast<double>(across_.nodes * down_.nodes) >= pixels) return;
        make_nodes(threads);
        apart_px *= 0.5;
    } while (!is_exact());
}

void RayTable::make_nodes(int threads) {
    nodes_.resize(across_.nodes * down_.nodes * lambda_nm_.size());
    parallel_for(down_.nodes, size_of(threads), [&](std::size_t j, std::size_t) {
        const double row = down_.place_px(static_cast<double>(j));
        for (std::size_t i = 0; i < across_.nodes; ++i) {
            const double column = across_.place_px(static_cast<double>(i));
            Node* node = &nodes_[(j * across_.nodes + i) * lambda_nm_.size()];
            for (const double nm : lambda_nm_) {
                const WaterRay ray = pixel_ray(rig_, column, row, nm);
                std::copy_n(ray.origin_m.data(), 3, node->begin());
                std::copy_n(ray.direction.data(), 3, node->begin() + 3);
                ++node;
            }
        }
    });
}

bool RayTable::is_exact() const {
    const auto is_exact_at = [&](double node_across, double node_down) {
        const double column = across_.place_px(node_across);
        const double row = down_.place_px(node_down);
        WaterRay found;
        look(column, row, {&found, 1});
        const WaterRay ray = pixel_ray(rig_, column, row, lambda_nm_.front());
        return (found.direction - ray.direction).norm() <= kRayTableError &&
               (found.origin_m - ray.origin_m).norm() <= kRayTableError;
    };
    constexpr std::size_t kMostCells = 32;  // along a line
    const auto is_exact_along = [&](std::size_t nodes, const auto& at_node) {
        const std::size_t cells = nodes - 1;
        const std::size_t asked = std::min(cells, kMostCells);
        for (std::size_t k = 0; k < asked; ++k) {
            const std::size_t cell = asked > 1 ? k * (cells - 1) / (asked - 1) : 0;
            if (!at_node(static_cast<double>(cell) + 0.5)) return false;
        }
        return true;
    };
    const auto middles_of = [](std::size_t nodes) {
        const std::size_t cells = nodes - 1;
        const std::size_t middle = cells / 2;
        return std::array<double, 3>{
            0.5, static_cast<double>(middle) + 0.5, static_cast<double>(cells) - 0.5};
    };
    bool is = true;
    for (const double row : middles_of(down_.nodes))
        is = is &&
             is_exact_along(across_.nodes, [&](double column) { return is_exact_at(column, row); });
    for (const double column : middles_of(across_.nodes))
        is =
            is && is_exact_along(down_.nodes, [&](double row) { return is_exact_at(column, row); });
    return is;
}

void RayTable::look(double column, double row, std::span<WaterRay> rays) const {
    if (nodes_.empty()) {
        for (std::size_t k = 0; k < rays.size(); ++k)
            rays[k] = pixel_ray(rig_, column, row, lambda_nm_[k]);
        return;
    }
    const Stencil across = stencil_at(column, across_.pixels, across_.nodes);
    const Stencil down = stencil_at(row, down_.pixels, down_.nodes);
    const std::size_t wavelengths = lambda_nm_.size();
    for (std::size_t k = 0; k < rays.size(); ++k) {
        Eigen::Array<double, 6, 1> sum = Eigen::Array<double, 6, 1>::Zero();
        for (std::size_t j = 0; j < kNodesOfCubic; ++j) {
            const Node* node =
                &nodes_[((down.first + j) * across_.nodes + across.first) * wavelengths + k];
            Eigen::Array<double, 6, 1> of_row = Eigen::Array<double, 6, 1>::Zero();
            for (std::size_t i = 0; i < kNodesOfCubic; ++i, node += wavelengths)
                of_row +=
                    across.weights[i] * Eigen::Map<const Eigen::Array<double, 6, 1>>(node->data());
            sum += down.weights[j] * of_row;
        }
        rays[k] = {.origin_m = sum.head<3>(), .direction = sum.tail<3>().matrix().normalized()};
    }
}

void RayTable::look(const Lanes& column, const Lanes& row, std::span<LaneRay> rays) const {
    if (rig_.camera.lens || rig_.camera.port) {
        std::vector<WaterRay> found(rays.size());
        for (std::size_t k = 0; k < kLanes; ++k) {
            look(column[k], row[k], found);
            for (std::size_t j = 0; j < rays.size(); ++j) {
                set_lane(rays[j].origin_m, k, found[j].origin_m);
                set_lane(rays[j].direction, k, found[j].direction);
            }
        }
        return;
    }
    LaneRay& ray = rays.front();
    ray.origin_m = every_lane(Eigen::Vector3d::Zero());
    for_each_pack([&](std::size_t k) {
        PackVector way = pinhole_way(rig_.camera, column.pack(k), row.pack(k));
        const Pack per_length = 1.0 / root(dot(way, way));
        for (Pack& along : way) along *= per_length;
        set_pack(ray.direction, k, way);
    });
}

}  // namespace aphotic
