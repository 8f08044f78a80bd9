// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/beam_light.h"

#include <cmath>

namespace aphotic {

namespace {

APHOTIC_WIDE void refract_round(const BeamWindow& window,
                                const DirectionBlock& V,
                                DirectionBlock& in_air) {
    const double n2 = window.water_index * window.water_index;
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        const double along = V.square[i] - n2 * (V.square[i] - V.axis[i] * V.axis[i]);
        const bool is_ahead = (V.axis[i] > 0.0) & (along > 0.0);
        in_air.axis[i] = std::sqrt(is_ahead ? along : 0.0);
        in_air.square[i] = V.square[i];
    }
}

APHOTIC_WIDE void refract_sides(const BeamWindow& window,
                                const DirectionBlock& V,
                                DirectionBlock& in_air) {
    const double n = window.water_index;
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        in_air.along[i] = n * V.along[i];
        in_air.across[i] = n * V.across[i];
    }
}

APHOTIC_WIDE void find_let_out(const DirectionBlock& in_air, RowBlock<double>& is_let_out) {
    for (std::size_t i = 0; i < kBlockCount; ++i) is_let_out[i] = in_air.axis[i] > 0.0 ? 1.0 : 0.0;
}

// Of one polarisation, light / (T / cos(theta)) of what rig/beam/beam_window.cpp has for each face:
// with the sums and differences of both faces' shares, Fresnel's products have one denominator.
APHOTIC_IN_LOOP double denominator(double outer_near,
                                   double outer_far,
                                   double inner_near,
                                   double inner_far) {
    const double sums = (outer_near + outer_far) * (inner_near + inner_far);
    const double differences = (outer_near - outer_far) * (inner_near - inner_far);
    return sums * sums - differences * differences;
}

// rig/beam/beam_window.h's factor.
APHOTIC_WIDE void take_factors(const BeamWindow& window,
                               const DirectionBlock& in_air,
                               RowBlock<double>& factors) {
    const double g = window.glass_index;
    const double n = window.water_index;
    const double per_g2 = 1.0 / (g * g);
    const double per_n2 = 1.0 / (n * n);
    for (std::size_t i = 0; i < in_air.count; ++i) {
        const double c2 = in_air.axis[i] * in_air.axis[i] / in_air.square[i];
        const double sine2 = c2 < 1.0 ? 1.0 - c2 : 0.0;
        const double c = std::sqrt(c2);
        const double cos_glass = std::sqrt(1.0 - sine2 * per_g2);
        const double cos_water = std::sqrt(1.0 - sine2 * per_n2);
        const double light = 16.0 * g * g * n * cos_glass * cos_glass * cos_water;
        const double s = denominator(c, g * cos_glass, g * cos_glass, n * cos_water);
        const double p = denominator(g * c, cos_glass, n * cos_glass, g * cos_water);
        factors[i] = 0.5 * light * (s + p) / (s * p) * n * n * cos_water;
    }
}

APHOTIC_WIDE void multiply(const RowBlock<double>& a,
                           const RowBlock<double>& b,
                           RowBlock<double>& product) {
    for (std::size_t i = 0; i < kBlockCount; ++i) product[i] *= a[i] * b[i];
}

template <class... Fs>
struct KindCases : Fs... {
    using Fs::operator()...;
};
template <class... Fs>
KindCases(Fs...) -> KindCases<Fs...>;

}  // namespace

BeamLight beam_light(const Beam& beam, double factor) {
    const double scaled = factor * beam.per_flux;
    return std::visit(
        KindCases{
            [&](std::monostate) {
                return BeamLight{.kind = lobe_light(beam, factor), .window = beam.window};
            },
            [&](const BeamTable& table) {
                return BeamLight{
                    .kind = table_light(table, scaled), .window = beam.window, .is_round = false};
            },
            [&](const BeamOptics& optics) {
                return BeamLight{
                    .kind = optics_light(optics, scaled), .window = beam.window, .is_round = false};
            }},
        beam.pattern);
}

BeamFrame turned_frame(const Beam& beam, const Eigen::Vector3d& axis) {
    const BeamFrame frame = frame_about(axis);
    const double c = std::cos(beam.turn_rad);
    const double s = std::sin(beam.turn_rad);
    return {.axis = axis,
            .along = c * frame.along + s * frame.across,
            .across = c * frame.across - s * frame.along};
}

void look_into(const BeamLight& light, const DirectionBlock& V, Edges edges, BeamBlock& block) {
    if (light.window) {
        block.in_air.is_in_order = V.is_in_order;
        refract_round(*light.window, V, block.in_air);
        if (!light.is_round) refract_sides(*light.window, V, block.in_air);
        if (edges == Edges::Found) find_let_out(block.in_air, block.is_let_out);
    }
    const DirectionBlock& seen = light.window ? block.in_air : V;
    std::visit(KindCases{[&](const LobeLight& lobes) {
                             look_into(lobes, seen, edges, block.lobes, block.intensity);
                             block.reach = &seen.axis;
                         },
                         [&](const TableLight& table) {
                             look_into(table, seen, edges, block.table, block.intensity);
                             block.reach = &block.table.length;
                         },
                         [&](const OpticsLight& optics) {
                             look_into(optics, seen, edges, block.optics, block.intensity);
                             block.reach = &seen.axis;
                         }},
               light.kind);
    if (light.window) {
        take_factors(*light.window, block.in_air, block.window_factor);
        multiply(block.window_factor, block.is_let_out, block.intensity);
    }
}

}  // namespace aphotic
