// SPDX-License-Identifier: BSD-3-Clause
//
// Where light behind a port may not be interpolated over the water's index (light/index_nodes.h),
// and what it is there.
//
//   G(n) = I cos(i) / d^2 of one lamp, by the ray of index n
//   doubt = max |G(n) - sum_j G(n_j) l_j(n)|       over the indices n half way between nodes
//
// Where a kink of the beam (a row of a table, an end of a soft edge, of a blur, of a highlight)
// lies between two nodes, G is no polynomial of n. Half way between nodes a single kink shows at
// least a third of the most that it does anywhere; G that is smooth but steep shows nearly all.
// What shows nothing is a ray that crosses a kink and comes back between two of these indices.
// Unless the kink is steep, that is little, for the way is short: so steep kinks are looked for as
// such (rig/beam/beam_crease.h), on the parabola through the nodes.
//
// Pixels whose doubts are over kMostDoubt of their signal, or where a lamp's ray crosses a steep
// kink, are computed by a ray for each wavelength of the spectral grid instead:
//
//   S_c = sum_i w_ci G(n_i) exp(-K_i l(n_i))
//
// On which side of a beam's edge such a pixel is, is still the middle index's to say.
#pragma once

#include "light/index_nodes.h"
#include "light/path_table.h"
#include "lightmap/row_light.h"
#include "rig/beam/beam_crease.h"

#include <array>
#include <vector>

namespace aphotic {

inline constexpr float kMostDoubt = 1e-5F;

// Kinks at which the slope of I changes by more than this share of the largest I over a degree; and
// the ends of soft edges and blurs that are so steep. In the lamp's own frame, turned.
inline constexpr double kSteepPerDegree = 0.1;
[[nodiscard]] std::vector<Crease> steep_creases(const Beam& beam);

// 1 where the way of the direction from the first index to the last crosses one, else as it was.
void note_crossings(const std::vector<Crease>& creases,
                    const std::array<DirectionBlock, kIndexNodes>& at_nodes,
                    bool has_sides,
                    RowBlock<float>& crosses);

// In the order of a map: the nodes of light, the middle one, the first and the last; then those
// half way between the middle and either, and l_j there.
using IndexShares = std::array<double, kIndexNodes>;
inline constexpr std::array<std::size_t, 2 * kIndexNodes - 1> kLookOrder{2, 0, 4, 1, 3};
inline constexpr std::array<IndexShares, kLookOrder.size() - kIndexNodes> kHalfWay{
    {{0.75, 0.375, -0.125}, {0.75, -0.125, 0.375}}};

// Of one lamp: its factors at each node, and at an index whose shares these are.
void take_doubt(const std::array<RowBlock<float>, kIndexNodes>& at_nodes,
                const IndexShares& shares,
                const RowBlock<float>& found,
                RowBlock<float>& doubt);
[[nodiscard]] bool is_in_doubt(const RowBlock<float>& doubt, const RowBlock<float>& factors);

// The floor's light of one lamp spectrum by wavelength of the grid; a highlight's has no nodes
// where there is none.
struct DispersedSpectrum {
    SpectralSum diffuse;
    SpectralSum highlight;
};

// Adds the light of one lamp along these rays. `block` holds the beam's sides of the middle ray.
using TotalBlock = std::array<RowBlock<double>, kChannels>;
void add_dispersed(const RayTerms& terms,
                   const PathSteps& steps,
                   const RayNodes& nodes,
                   const std::vector<std::vector<double>>& shares,
                   int count,
                   const LampTerms& lamp,
                   const DispersedSpectrum& spectrum,
                   LampBlock& block,
                   TotalBlock& totals);

}  // namespace aphotic
