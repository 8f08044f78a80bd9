// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/table_light.h"

#include "lightmap/row_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace aphotic {

namespace {

constexpr double kFullTurn = 2.0 * std::numbers::pi;

APHOTIC_IN_LOOP double within(double x, double least, double most) {
    const double above = x > least ? x : least;
    return above < most ? above : most;
}

// V off the axis.
APHOTIC_WIDE void find_axial_angle(const DirectionBlock& V, TableAnglesBlock& angles) {
    for (std::size_t i = 0; i < V.count; ++i) {
        const double off = std::sqrt(V.along[i] * V.along[i] + V.across[i] * V.across[i]);
        angles.vertical[i] = arctangent(off, V.axis[i]);
    }
}

APHOTIC_WIDE void find_type_c_turn(const DirectionBlock& V, TableAnglesBlock& angles) {
    for (std::size_t i = 0; i < V.count; ++i) {
        const double turn = arctangent(-V.across[i], V.along[i]);
        angles.horizontal[i] = turn < 0.0 ? turn + kFullTurn : turn;
    }
}

// Types A and B: longitude of `turning` about the line across all `axis`, latitude of `rising`.
APHOTIC_WIDE void find_globe_angles(const RowBlock<double>& rising,
                                    const RowBlock<double>& turning,
                                    const RowBlock<double>& axis,
                                    std::size_t count,
                                    RowBlock<double>& latitude,
                                    RowBlock<double>& longitude) {
    for (std::size_t i = 0; i < count; ++i) {
        const double off = std::sqrt(turning[i] * turning[i] + axis[i] * axis[i]);
        latitude[i] = arctangent(rising[i], off);
        longitude[i] = arctangent(turning[i], axis[i]);
    }
}

void find_angles(const TableLight& light, const DirectionBlock& V, TableAnglesBlock& angles) {
    switch (light.angles) {
        case TableAngles::TypeA:
            find_globe_angles(
                V.along, V.across, V.axis, V.count, angles.vertical, angles.horizontal);
            return;
        case TableAngles::TypeB:
            find_globe_angles(
                V.across, V.along, V.axis, V.count, angles.horizontal, angles.vertical);
            return;
        case TableAngles::TypeC:
            find_axial_angle(V, angles);
            if (!light.horizontal.nodes.empty()) find_type_c_turn(V, angles);
            return;
    }
}

// Angles are smooth along a row, but where it passes close to a pole or the turn begins anew.
void find_angles(const TableLight& light, const DirectionBlock& V, TableWork& work) {
    constexpr double kFitError_rad = 1e-9;  // what the reference takes for an edge
    if (!V.is_in_order) {
        find_angles(light, V, work.angles);
        return;
    }
    const bool has_turn = !light.horizontal.nodes.empty();
    take_samples(V, true, work.samples);
    find_angles(light, work.samples, work.of_samples);
    const auto is_fit = [](const RowBlock<double>& samples, RowBlock<double>& values) {
        return fit(samples, kFitError_rad, 0.0, values);
    };
    if (is_fit(work.of_samples.vertical, work.angles.vertical) &&
        (!has_turn || is_fit(work.of_samples.horizontal, work.angles.horizontal))) {
        return;
    }
    find_angles(light, V, work.angles);
}

APHOTIC_WIDE void take_lengths(const DirectionBlock& V, RowBlock<double>& lengths) {
    for (std::size_t i = 0; i < kBlockCount; ++i) lengths[i] = std::sqrt(V.square[i]);
}

// Leaves 1 where the angle is within the nodes' range too.
APHOTIC_WIDE void keep_within(const RowBlock<double>& angles,
                              double first,
                              double last,
                              RowBlock<double>& is_within) {
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        const double angle = angles[i];
        const bool is_in = (angle >= first) & (angle <= last);
        is_within[i] = is_in ? is_within[i] : 0.0;
    }
}

// The node below each angle, and its place from that to the next.
struct Places {
    RowBlock<std::int32_t> index;
    RowBlock<double> share;
};

APHOTIC_WIDE void find_even_places(const NodeFinder& finder,
                                   const RowBlock<double>& angles,
                                   Places& places) {
    const double first = finder.nodes.front();
    const double last = finder.nodes.back();
    const double per_rad = finder.buckets_per_rad;
    const auto last_step = static_cast<std::int32_t>(finder.nodes.size()) - 2;
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        const double place = (within(angles[i], first, last) - first) * per_rad;
        const auto found = static_cast<std::int32_t>(place);
        const std::int32_t step = found < last_step ? found : last_step;
        places.index[i] = step;
        places.share[i] = place - static_cast<double>(step);
    }
}

APHOTIC_WIDE void find_uneven_places(const NodeFinder& finder,
                                     const RowBlock<double>& angles,
                                     Places& places) {
    const double first = finder.nodes.front();
    const double last = finder.nodes.back();
    const double per_rad = finder.buckets_per_rad;
    const std::int32_t* const by_bucket = finder.by_bucket.data();
    const double* const next = finder.next.data();
    const double* const nodes = finder.nodes.data();
    const double* const per_step = finder.per_step.data();
    RowBlock<double> inside;
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        inside[i] = within(angles[i], first, last);
        places.index[i] = by_bucket[static_cast<std::int32_t>((inside[i] - first) * per_rad)];
    }
    for (int k = 0; k < finder.most_in_bucket; ++k) {
        for (std::size_t i = 0; i < kBlockCount; ++i) {
            places.index[i] += inside[i] >= next[places.index[i]] ? 1 : 0;
        }
    }
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        places.share[i] = (inside[i] - nodes[places.index[i]]) * per_step[places.index[i]];
    }
}

void find_places(const NodeFinder& finder, const RowBlock<double>& angles, Places& places) {
    (finder.is_even ? find_even_places : find_uneven_places)(finder, angles, places);
}

APHOTIC_WIDE void take_between(const double* table,
                               const Places& vertical,
                               const RowBlock<double>& is_within,
                               RowBlock<double>& intensity) {
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        const double low = table[vertical.index[i]];
        const double high = table[vertical.index[i] + 1];
        const double share = vertical.share[i];
        intensity[i] = is_within[i] * ((1.0 - share) * low + share * high);
    }
}

APHOTIC_WIDE void take_between(const double* table,
                               std::int32_t rows,
                               const Places& vertical,
                               const Places& horizontal,
                               const RowBlock<double>& is_within,
                               RowBlock<double>& intensity) {
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        const std::int32_t at = horizontal.index[i] * rows + vertical.index[i];
        const double v = vertical.share[i];
        const double h = horizontal.share[i];
        const double near = (1.0 - v) * table[at] + v * table[at + 1];
        const double far = (1.0 - v) * table[at + rows] + v * table[at + rows + 1];
        intensity[i] = is_within[i] * ((1.0 - h) * near + h * far);
    }
}

}  // namespace

NodeFinder node_finder(const std::vector<double>& nodes) {
    constexpr double kMostBuckets = 4096.0;
    const double range = nodes.back() - nodes.front();
    NodeFinder finder{.nodes = nodes, .per_step = {}, .by_bucket = {}, .next = {}};
    double least = range;
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
        const double step = nodes[i + 1] - nodes[i];
        least = std::min(least, step);
        finder.per_step.push_back(1.0 / step);
        finder.next.push_back(nodes[i + 1]);
    }
    finder.next.back() = std::numeric_limits<double>::infinity();
    const double buckets = std::min(std::ceil(range / least), kMostBuckets);
    finder.buckets_per_rad = buckets / range;
    // As loops over angles find it, to the bit: so no rounding puts a node in another.
    const auto bucket_of = [&](double angle) {
        return static_cast<std::size_t>((angle - nodes.front()) * finder.buckets_per_rad);
    };
    std::vector<int> inside(bucket_of(nodes.back()) + 1, 0);
    for (std::size_t i = 1; i + 1 < nodes.size(); ++i) ++inside[bucket_of(nodes[i])];
    std::int32_t before = 0;
    for (const int count : inside) {
        finder.by_bucket.push_back(before);
        before += count;
    }
    finder.most_in_bucket = *std::ranges::max_element(inside);
    constexpr double kRounding_rad = 1e-14;
    const double steps = static_cast<double>(nodes.size() - 1);
    finder.is_even = true;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const double even = nodes.front() + range * static_cast<double>(i) / steps;
        finder.is_even &= std::abs(nodes[i] - even) <= kRounding_rad;
    }
    if (finder.is_even) finder.buckets_per_rad = steps / range;
    return finder;
}

TableLight table_light(const BeamTable& table, double factor) {
    TableLight light{.angles = table.angles,
                     .vertical = node_finder(table.vertical_rad),
                     .horizontal = {},
                     .intensity = table.intensity,
                     .vertical_limits = {},
                     .horizontal_limits = {}};
    if (table.horizontal_rad.size() > 1) light.horizontal = node_finder(table.horizontal_rad);
    for (double& I : light.intensity) I *= factor;
    const std::vector<TableEdge> edges = edges_of(table);
    const auto limits_of = [&](TableAngle angle, const NodeFinder& finder) {
        TableLimits limits;
        const auto is_step = [&](double at_rad) {
            return std::ranges::find(edges, TableEdge{angle, at_rad}) != edges.end();
        };
        (is_step(finder.nodes.front()) ? limits.steps : limits.others).first = finder.nodes.front();
        (is_step(finder.nodes.back()) ? limits.steps : limits.others).last = finder.nodes.back();
        return limits;
    };
    light.vertical_limits = limits_of(TableAngle::Vertical, light.vertical);
    // Type C's goes all about; what a fit is off by must not put it before 0.
    if (table.angles != TableAngles::TypeC)
        light.horizontal_limits = limits_of(TableAngle::Horizontal, light.horizontal);
    return light;
}

void look_into(const TableLight& light,
               const DirectionBlock& V,
               Edges edges,
               TableWork& work,
               RowBlock<double>& intensity) {
    const bool has_turn = !light.horizontal.nodes.empty();
    find_angles(light, V, work);
    take_lengths(V, work.length);
    const auto keep = [&](TableEnds TableLimits::*ends, RowBlock<double>& is_within) {
        const TableEnds& vertical = light.vertical_limits.*ends;
        const TableEnds& horizontal = light.horizontal_limits.*ends;
        keep_within(work.angles.vertical, vertical.first, vertical.last, is_within);
        if (light.angles == TableAngles::TypeC) return;
        keep_within(work.angles.horizontal, horizontal.first, horizontal.last, is_within);
    };
    if (edges == Edges::Found) {
        work.is_within.fill(1.0);
        keep(&TableLimits::steps, work.is_within);
    }
    work.is_lit = work.is_within;
    keep(&TableLimits::others, work.is_lit);
    Places vertical;
    find_places(light.vertical, work.angles.vertical, vertical);
    if (!has_turn) {
        take_between(light.intensity.data(), vertical, work.is_lit, intensity);
        return;
    }
    Places horizontal;
    find_places(light.horizontal, work.angles.horizontal, horizontal);
    take_between(light.intensity.data(),
                 static_cast<std::int32_t>(light.vertical.nodes.size()),
                 vertical,
                 horizontal,
                 work.is_lit,
                 intensity);
}

}  // namespace aphotic
