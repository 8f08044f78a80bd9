// SPDX-License-Identifier: BSD-3-Clause
#include "light/steep_crease.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <variant>

namespace aphotic {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180.0;

// The nodes, of one angle of a table, at which the slope of I jumps by more than `most`. value(i,
// k): at node i of this angle and k of the other; per_rad(k): ratio of the nodes' angle to the arc
// on the globe.
template <typename Value, typename PerRad>
std::vector<double> steep_nodes(const std::vector<double>& nodes,
                                std::size_t others,
                                double most,
                                const Value& value,
                                const PerRad& per_rad) {
    std::vector<double> steep;
    const auto slope = [&](std::size_t i, std::size_t k) {  // from i to the next, 0 past the ends
        return i + 1 < nodes.size() ? (value(i + 1, k) - value(i, k)) / (nodes[i + 1] - nodes[i])
                                    : 0.0;
    };
    for (std::size_t i = 0; i < nodes.size() && nodes.size() > 1; ++i) {
        double jump = 0.0;
        for (std::size_t k = 0; k < others; ++k) {
            const double before = i > 0 ? slope(i - 1, k) : 0.0;
            jump = std::max(jump, std::abs(slope(i, k) - before) * per_rad(k));
        }
        if (jump > most) steep.push_back(nodes[i]);
    }
    return steep;
}

// The same table with only its steep lines, for its creases.
BeamTable with_steep_lines(const BeamTable& table) {
    const std::size_t rows = table.vertical_rad.size();
    const double most = kSteepPerDegree / kDegree_rad * largest_intensity(table);
    const auto value = [&](std::size_t v, std::size_t h) { return table.intensity[h * rows + v]; };
    const auto per_way = [](double cosine) { return cosine > 1e-6 ? 1.0 / cosine : 0.0; };
    const auto even = [](std::size_t) { return 1.0; };
    const auto about_vertical = [&](std::size_t v) {
        const double V = table.vertical_rad[v];
        return per_way(table.angles == TableAngles::TypeC ? std::sin(V) : std::cos(V));
    };
    const auto about_horizontal = [&](std::size_t h) {
        return per_way(std::cos(table.horizontal_rad[h]));
    };
    const bool is_b = table.angles == TableAngles::TypeB;
    const auto of_v = [&](std::size_t v, std::size_t h) { return value(v, h); };
    const auto of_h = [&](std::size_t h, std::size_t v) { return value(v, h); };
    BeamTable steep = table;
    const std::size_t columns = table.horizontal_rad.size();
    steep.vertical_rad =
        is_b ? steep_nodes(table.vertical_rad, columns, most, of_v, about_horizontal)
             : steep_nodes(table.vertical_rad, columns, most, of_v, even);
    steep.horizontal_rad =
        is_b ? steep_nodes(table.horizontal_rad, rows, most, of_h, even)
             : steep_nodes(table.horizontal_rad, rows, most, of_h, about_vertical);
    // With a single column, the table would be round.
    if (steep.horizontal_rad.size() == 1) steep.horizontal_rad.push_back(steep.horizontal_rad[0]);
    return steep;
}

double least_step(const std::vector<double>& angles_rad) {
    double least = std::numbers::pi;
    for (std::size_t i = 1; i < angles_rad.size(); ++i)
        least = std::min(least, angles_rad[i] - angles_rad[i - 1]);
    return least;
}

// A soft edge is even in the cosine.
double half_lit_rad(const Cone& cone) {
    if (cone.edge_rad == 0.0) return cone.half_angle_rad;
    return std::acos(std::midpoint(std::cos(cone.half_angle_rad - cone.edge_rad),
                                   std::cos(cone.half_angle_rad)));
}

}  // namespace

std::vector<Crease> steep_creases(const Beam& beam, const BeamFrame& frame) {
    constexpr double kMostSlope = 1.5;  // of a smoothstep over 1
    Beam steep = beam;
    const double largest = most_intensity(beam);
    std::erase_if(steep.cones, [&](const Cone& cone) {
        Beam alone = beam;
        alone.cones = {cone};
        const double per_degree =
            kMostSlope * most_intensity(alone) / (cone.edge_rad / kDegree_rad);
        return cone.edge_rad == 0.0 || per_degree <= kSteepPerDegree * largest;
    });
    if (const auto* table = std::get_if<BeamTable>(&beam.pattern)) {
        steep.pattern = with_steep_lines(*table);
    } else if (const auto* optics = std::get_if<BeamOptics>(&beam.pattern)) {
        const double blur_rad =
            optics->aperture_m * std::abs(1.0 / optics->distance_m - 1.0 / optics->focal_length_m);
        if (is_focused(*optics) || blur_rad * kSteepPerDegree > kDegree_rad) return {};
    }
    std::vector<Crease> creases = creases_of(steep, frame);
    creases.pop_back();  // the plane across the axis, where light ends without a step
    return creases;
}

bool crosses(const Crease& crease, const std::array<Eigen::Vector3d, 3>& towards) {
    // The largest deviation of the path from the parabola, as a share of its change.
    constexpr double kOff = 0.02;
    const auto height = [&](const Eigen::Vector3d& V) {
        if (!crease.is_quadratic) return crease.l.dot(V) / V.norm() - crease.at;
        return V.dot(crease.Q * V) / V.squaredNorm() - crease.at;
    };
    const double middle = height(towards[0]);
    const double first = height(towards[1]);
    const double last = height(towards[2]);
    const double bend = 0.5 * (first + last) - middle;
    const double slope = 0.5 * (first - last);
    const bool turns = std::abs(slope) < 2.0 * std::abs(bend);
    const double extreme = turns ? middle - 0.25 * slope * slope / bend : middle;
    const double room = kOff * (std::abs(bend) + std::abs(slope));
    return std::min({middle, first, last, extreme}) <= room &&
           std::max({middle, first, last, extreme}) >= -room;
}

double narrowest_rad(const Beam& beam) {
    double narrowest = std::numbers::pi;
    for (const Cone& cone : beam.cones) {
        narrowest = std::min({narrowest, 2.0 * half_lit_rad(cone), 2.0 / std::sqrt(cone.exponent)});
    }
    const bool is_steep = !steep_creases(beam, frame_about(Eigen::Vector3d::UnitZ())).empty();
    if (const auto* table = std::get_if<BeamTable>(&beam.pattern); table != nullptr && is_steep) {
        narrowest = std::min({narrowest,
                              2.0 * least_step(table->vertical_rad),
                              2.0 * least_step(table->horizontal_rad)});
    }
    if (const auto* optics = std::get_if<BeamOptics>(&beam.pattern)) {
        narrowest = std::min(narrowest,
                             2.0 * std::atan(0.5 * std::min(optics->along_m, optics->across_m) /
                                             optics->distance_m));
    }
    return narrowest;
}

}  // namespace aphotic
