// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/dispersed_light.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

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

}  // namespace

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
                   const std::array<RayBlock, kIndexNodes>& nodes,
                   const std::vector<IndexShares>& shares,
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
