// SPDX-License-Identifier: BSD-3-Clause
//
// Cones over blocks of directions (beam_light.h): with c = cos(theta) = V.a/|V|,
//
//   I/c = sum of A_k c^(n_k - 1) S_k(c)   over the cones with theta <= gamma_k
//
// as rig/beam/beam.h has them. Powers are right to 1e-8; each exponent that is not 1 costs one,
// however many cones have it.
#pragma once

#include "lightmap/direction_block.h"
#include "rig/beam/beam.h"

#include <vector>

namespace aphotic {

// Falls by S to 0 at edge_cosine.
struct SoftLobe {
    double full_cosine = 0.0;
    double edge_cosine = 0.0;
    double on_axis = 0.0;
    double exponent = 1.0;
};

struct LobeLight {
    std::vector<Lobe> sharp;
    std::vector<SoftLobe> soft;
    std::vector<double> other_exponents;  // than 1, each once
};
[[nodiscard]] LobeLight lobe_light(const Beam& beam, double factor);

struct LobeWork {
    // What sharp lobes of exponent 1 give of the intensity; and for each other exponent, those
    // lobes' intensity on the axis as far as they reach.
    RowBlock<double> cosines;
    std::vector<RowBlock<double>> powers;
    RowBlock<double> factors;  // of a power, soft lobes included
    RowBlock<double> cosine;
    RowBlock<double> log2_cosine;
    RowBlock<double> power;
    DirectionBlock samples;
    RowBlock<double> log2_of_samples;
    RowBlock<double> power_of_samples;
};

void look_into(const LobeLight& light,
               const DirectionBlock& V,
               Edges edges,
               LobeWork& work,
               RowBlock<double>& intensity);

}  // namespace aphotic
