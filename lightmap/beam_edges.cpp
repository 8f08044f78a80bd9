// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/beam_edges.h"

#include "lightmap/row_light.h"

#include <cmath>

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
