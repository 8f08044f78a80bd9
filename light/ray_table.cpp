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
template <typename T>
std::array<T, kNodesOfCubic> cubic_weights(const T& u) {
    const T a = u;
    const T b = u - 1.0;
    const T c = u - 2.0;
    const T d = u - 3.0;
    return {-b * c * d / 6.0, a * c * d / 2.0, -a * b * d / 2.0, a * b * c / 6.0};
}

// The first of the four nodes around a place.
std::size_t first_node(double node, std::size_t nodes) {
    const double last = static_cast<double>(nodes - kNodesOfCubic);
    return static_cast<std::size_t>(std::clamp(std::floor(node) - 1.0, 0.0, last));
}

void normalise(PackVector& way) {
    const Pack per_length = 1.0 / root(dot(way, way));
    for (Pack& along : way) along *= per_length;
}

}  // namespace

RayTable::Axis::Axis(int count, double most_apart_px)
    : pixels(count),
      nodes(std::max(kNodesOfCubic,
                     static_cast<std::size_t>(std::ceil(count / most_apart_px)) + 1)) {}

double RayTable::Axis::place_px(double node) const {
    return pixels * (node / (static_cast<double>(nodes) - 1.0));
}

template <typename T>
T RayTable::Axis::node_at(const T& place_px) const {
    return place_px / pixels * (static_cast<double>(nodes) - 1.0);
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
    for (std::size_t k = 0; k < rays.size(); ++k) {
        if (nodes_.empty()) {
            rays[k] = pixel_ray(rig_, column, row, lambda_nm_[k]);
            continue;
        }
        const RaySum sum = sum_at(column, row, k);
        rays[k] = {.origin_m = sum.head<3>(), .direction = sum.tail<3>().matrix().normalized()};
    }
}

RayTable::RaySum RayTable::sum_at(double column, double row, std::size_t wavelength) const {
    const double across = across_.node_at(column);
    const std::size_t first = first_node(across, across_.nodes);
    const auto weights = cubic_weights(across - static_cast<double>(first));
    const auto along = nodes_along(first, down_.node_at(row), wavelength);
    RaySum sum = RaySum::Zero();
    for (std::size_t i = 0; i < kNodesOfCubic; ++i) sum += weights[i] * along[i];
    return sum;
}

// At the height `down` among the nodes, those of four columns.
std::array<RayTable::RaySum, kNodesOfCubic> RayTable::nodes_along(std::size_t first_across,
                                                                  double down,
                                                                  std::size_t wavelength) const {
    const std::size_t first = first_node(down, down_.nodes);
    const auto weights = cubic_weights(down - static_cast<double>(first));
    std::array<RaySum, kNodesOfCubic> along;
    for (std::size_t i = 0; i < kNodesOfCubic; ++i) {
        along[i].setZero();
        for (std::size_t j = 0; j < kNodesOfCubic; ++j) {
            const std::size_t place = (first + j) * across_.nodes + first_across + i;
            const Node& node = nodes_[place * lambda_nm_.size() + wavelength];
            along[i] += weights[j] * Eigen::Map<const RaySum>(node.data());
        }
    }
    return along;
}

// Pixels that are neighbours in a row mostly lie between the same nodes.
bool RayTable::look_along_row(const Lanes& column,
                              const Lanes& row,
                              std::span<LaneRay> rays) const {
    if (nodes_.empty()) return false;
    if (std::ranges::any_of(row.lane, [&](double one) { return one != row[0]; })) return false;
    const auto [least, most] = std::ranges::minmax(column.lane);
    const std::size_t first = first_node(across_.node_at(least), across_.nodes);
    if (first_node(across_.node_at(most), across_.nodes) != first) return false;
    const double down = down_.node_at(row[0]);
    for (std::size_t j = 0; j < rays.size(); ++j) {
        const auto along = nodes_along(first, down, j);
        for_each_pack([&](std::size_t k) {
            const Pack across = across_.node_at(column.pack(k));
            const auto w = cubic_weights(across - Pack(static_cast<double>(first)));
            const auto sum = [&](Eigen::Index c) {
                return w[0] * along[0](c) + w[1] * along[1](c) + w[2] * along[2](c) +
                       w[3] * along[3](c);
            };
            set_pack(rays[j].origin_m, k, {sum(0), sum(1), sum(2)});
            set_pack(rays[j].direction, k, {sum(3), sum(4), sum(5)});
        });
    }
    return true;
}

void RayTable::look_at_each(const Lanes& column, const Lanes& row, std::span<LaneRay> rays) const {
    for (std::size_t k = 0; k < kLanes; ++k) {
        for (std::size_t j = 0; j < rays.size(); ++j) {
            if (nodes_.empty()) {
                const WaterRay ray = pixel_ray(rig_, column[k], row[k], lambda_nm_[j]);
                set_lane(rays[j].origin_m, k, ray.origin_m);
                set_lane(rays[j].direction, k, ray.direction);
                continue;
            }
            const RaySum sum = sum_at(column[k], row[k], j);
            set_lane(rays[j].origin_m, k, sum.head<3>());
            set_lane(rays[j].direction, k, sum.tail<3>());
        }
    }
}

void RayTable::look(const Lanes& column, const Lanes& row, std::span<LaneRay> rays) const {
    if (rig_.camera.lens || rig_.camera.port) {
        if (!look_along_row(column, row, rays)) look_at_each(column, row, rays);
        for (LaneRay& ray : rays) {
            for_each_pack([&](std::size_t k) {
                PackVector way = pack(ray.direction, k);
                normalise(way);
                set_pack(ray.direction, k, way);
            });
        }
        return;
    }
    LaneRay& ray = rays.front();
    ray.origin_m = every_lane(Eigen::Vector3d::Zero());
    for_each_pack([&](std::size_t k) {
        PackVector way = pinhole_way(rig_.camera, column.pack(k), row.pack(k));
        normalise(way);
        set_pack(ray.direction, k, way);
    });
}

}  // namespace aphotic
