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
    const auto cosine = [&](std::size_t i) { return V.axis[i] / std::sqrt(V.square[i]); };
    for (const double edge : edges.cosines) {
        double nearest = std::abs(cosine(first) - edge);
        double widest_step = 0.0;
        for (std::size_t i = first + 1; i < first + count; ++i) {
            nearest = std::min(nearest, std::abs(cosine(i) - edge));
            widest_step = std::max(widest_step, std::abs(cosine(i) - cosine(i - 1)));
        }
        if (nearest <= widest_step) return false;
    }
    return true;
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
