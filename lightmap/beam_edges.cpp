// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/beam_edges.h"

#include "lightmap/row_light.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace aphotic {

BeamEdges beam_edges(const Strobe& strobe) {
    BeamEdges edges{.cosines = {},
                    .has_rim = false,
                    .beam = strobe.beam,
                    .frame = frame_about(strobe.axis),
                    .turned_frame = turned_frame(strobe.beam, strobe.axis)};
    if (strobe.power == 0.0) return edges;
    for (const double edge_rad : edges_rad(strobe.beam))
        edges.cosines.push_back(std::cos(edge_rad));
    edges.has_rim = has_rim(strobe.beam);
    return edges;
}

bool is_smooth_between(const BeamEdges& edges) {
    const bool is_table = std::holds_alternative<BeamTable>(edges.beam.pattern);
    return !edges.has_rim && !is_table && (edges.cosines.empty() || edges.beam.window);
}

bool is_between(const BeamEdges& edges,
                const DirectionBlock& V,
                std::size_t first,
                std::size_t count) {
    if (edges.cosines.empty()) return true;
    RowBlock<double> cosine;
    for (std::size_t i = 0; i < count; ++i)
        cosine[i] = V.axis[first + i] / std::sqrt(V.square[first + i]);
    double widest_step = 0.0;
    for (std::size_t i = 1; i < count; ++i)
        widest_step = std::max(widest_step, std::abs(cosine[i] - cosine[i - 1]));
    return std::ranges::all_of(edges.cosines, [&](double edge) {
        return std::all_of(cosine.begin(),
                           cosine.begin() + static_cast<std::ptrdiff_t>(count),
                           [&](double c) { return std::abs(c - edge) > widest_step; });
    });
}

void count_within(const BeamEdges& edges,
                  std::size_t edge,
                  const RayBlock& rays,
                  const DirectionBlock& V,
                  std::uint8_t* counts) {
    if (edge < edges.cosines.size()) {
        count_within(rays, V, edges.cosines[edge], counts);
        return;
    }
    const auto& [axis, along, across] = edges.turned_frame;
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        const Eigen::Vector3d towards =
            V.along[i] * along + V.across[i] * across + V.axis[i] * axis;
        const bool is_within = rays.w3[i] > 0.0F && is_within_rim(edges.beam, edges.frame, towards);
        counts[i] = static_cast<std::uint8_t>(counts[i] + (is_within ? 1 : 0));
    }
}

}  // namespace aphotic
