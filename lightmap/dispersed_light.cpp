// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/dispersed_light.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

namespace aphotic {
namespace {

using BlockArray = Eigen::Array<double, kRowBlock, 1>;

void add_light(const RowBlock<float>& factors,
               const BlockArray& left,
               const SpectralSum& sum,
               Eigen::Index wavelength,
               TotalBlock& totals) {
    const BlockArray light =
        left * Eigen::Map<const Eigen::Array<float, kRowBlock, 1>>(factors.data()).cast<double>();
    for (std::size_t c = 0; c < kChannels; ++c) {
        Eigen::Map<BlockArray>(totals[c].data()) +=
            sum.weights(wavelength, static_cast<Eigen::Index>(c)) * light;
    }
}

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kDegree_rad = std::numbers::pi / 180.0;

// The nodes, of one angle of a table, at which the slope of I jumps by more than `most`. value(i,
// k): at node i of this angle and k of the other; per_rad(k): nodes' angle to the way on the globe.
template <typename Value, typename PerRad>
std::vector<double> steep_nodes(const std::vector<double>& nodes,
                                std::size_t others,
                                double most,
                                const Value& value,
                                const PerRad& per_rad) {
    std::vector<double> steep;
    const auto slope = [&](std::size_t i, std::size_t k) {  // from i to the next, 0 beyond the ends
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

// The same table of its steep lines alone, for its creases.
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
    // One column would be that of a round table.
    if (steep.horizontal_rad.size() == 1) steep.horizontal_rad.push_back(steep.horizontal_rad[0]);
    return steep;
}

}  // namespace

std::vector<Crease> steep_creases(const Beam& beam) {
    constexpr double kMostSlope = 1.5;  // of a smoothstep over 1
    Beam steep = beam;
    steep.turn_rad = 0.0;
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
    const BeamFrame lamp{Vector3d::UnitZ(), Vector3d::UnitX(), Vector3d::UnitY()};
    std::vector<Crease> creases = creases_of(steep, lamp);
    creases.pop_back();  // the plane across the axis, where light ends without a step
    return creases;
}

void note_crossings(const std::vector<Crease>& creases,
                    const std::array<DirectionBlock, kIndexNodes>& at_nodes,
                    bool has_sides,
                    RowBlock<float>& crosses) {
    // How far the way may be from the parabola, as a share of what it changes.
    constexpr double kOff = 0.02;
    for (const Crease& crease : creases) {
        const auto height = [&](const DirectionBlock& V, std::size_t i) {
            const double length2 = V.square[i];
            const Vector3d w = has_sides ? Vector3d(V.along[i], V.across[i], V.axis[i])
                                         : Vector3d(0.0, 0.0, V.axis[i]);
            if (!crease.is_quadratic) return crease.l.dot(w) / std::sqrt(length2) - crease.at;
            return w.dot(crease.Q * w) / length2 - crease.at;
        };
        for (std::size_t i = 0; i < kBlockCount; ++i) {
            const double middle = height(at_nodes[0], i);
            const double first = height(at_nodes[1], i);
            const double last = height(at_nodes[2], i);
            const double bend = 0.5 * (first + last) - middle;
            const double slope = 0.5 * (first - last);
            const bool turns = std::abs(slope) < 2.0 * std::abs(bend);
            const double extreme = turns ? middle - 0.25 * slope * slope / bend : middle;
            const double room = kOff * (std::abs(bend) + std::abs(slope));
            const double least = std::min({middle, first, last, extreme});
            const double most = std::max({middle, first, last, extreme});
            if (least <= room && most >= -room) crosses[i] = 1.0F;
        }
    }
}

void take_doubt(const std::array<RowBlock<float>, kIndexNodes>& at_nodes,
                const IndexShares& shares,
                const RowBlock<float>& found,
                RowBlock<float>& doubt) {
    const auto a = static_cast<float>(shares[0]);
    const auto b = static_cast<float>(shares[1]);
    const auto c = static_cast<float>(shares[2]);
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        const float told = a * at_nodes[0][i] + b * at_nodes[1][i] + c * at_nodes[2][i];
        doubt[i] = std::max(doubt[i], std::abs(found[i] - told));
    }
}

bool is_in_doubt(const RowBlock<float>& doubt, const RowBlock<float>& factors) {
    int count = 0;
    for (std::size_t i = 0; i < kBlockCount; ++i)
        count += static_cast<int>(doubt[i] > kMostDoubt * factors[i]);
    return count > 0;
}

void add_dispersed(const RayTerms& terms,
                   const PathSteps& steps,
                   const RayNodes& nodes,
                   const std::vector<std::vector<double>>& shares,
                   int count,
                   const LampTerms& lamp,
                   const DispersedSpectrum& spectrum,
                   LampBlock& block,
                   TotalBlock& totals) {
    RayBlock rays;
    for (std::size_t k = 0; k < shares.size(); ++k) {
        const auto wavelength = static_cast<Eigen::Index>(k);
        look_between(terms, steps, nodes, shares[k], count, rays);
        shine(rays, lamp, Edges::Kept, block);
        // What is outside the tables' paths is told by the nodes.
        static_cast<void>(weigh(rays, lamp, steps, block));
        const BlockArray path_m =
            steps.first_m +
            Eigen::Map<const Eigen::Array<float, kRowBlock, 1>>(block.place.data()).cast<double>() /
                steps.steps_per_m;
        const BlockArray left = (-spectrum.diffuse.K_per_m(wavelength) * path_m).exp();
        add_light(block.diffuse, left, spectrum.diffuse, wavelength, totals);
        if (spectrum.highlight.K_per_m.size() == 0) continue;
        weigh_highlight(rays, lamp, block);
        add_light(block.highlight, left, spectrum.highlight, wavelength, totals);
    }
}

}  // namespace aphotic
