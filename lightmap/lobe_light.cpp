// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/lobe_light.h"

#include "lightmap/row_fit.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace aphotic {

namespace {

constexpr double kFitError = 1e-8;  // relative; a float's rounding is six times as much

// Signed squares are compared, which are in the order of the cosines and need no root.
APHOTIC_WIDE void add_lobe(const Lobe& lobe, const DirectionBlock& V, RowBlock<double>& sum) {
    const double square = lobe.edge_cosine * lobe.edge_cosine;
    const double on_axis = lobe.on_axis;
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        const double along = V.axis[i] * std::abs(V.axis[i]);
        sum[i] += along >= square * V.square[i] ? on_axis : 0.0;
    }
}

// The library's powers do not vectorise. These are right to 1e-9, and have no choices, which do not
// either: with x = cos^2(theta) = m 2^e and m between 1/sqrt(2) and sqrt(2),
//
//   log2 x = e + ln m/ln 2,   ln m = 2 artanh t,   t = (m - 1)/(m + 1),   |t| < 0.172
//
// and 2^y of a whole number and the rest, both by their series.
constexpr int kMantissaBits = 52;
constexpr std::uint64_t kExponentBias = 1023;

APHOTIC_WIDE void take_logarithm(const DirectionBlock& V, RowBlock<double>& log2_cosine) {
    constexpr std::uint64_t kMantissa = 0x000fffffffffffffU;
    constexpr auto kOne = std::bit_cast<std::uint64_t>(1.0);
    constexpr auto kRootOfHalf = std::bit_cast<std::uint64_t>(0.5 * std::numbers::sqrt2);
    constexpr auto kTwo52 = std::bit_cast<std::uint64_t>(0x1p52);  // holds whole numbers at its end
    for (std::size_t i = 0; i < V.count; ++i) {
        const double x = V.axis[i] * V.axis[i] / V.square[i];
        const std::uint64_t bits = std::bit_cast<std::uint64_t>(x) + (kOne - kRootOfHalf);
        const double e = std::bit_cast<double>((bits >> kMantissaBits) | kTwo52) -
                         (0x1p52 + static_cast<double>(kExponentBias));
        const double m = std::bit_cast<double>((bits & kMantissa) + kRootOfHalf);
        const double t = (m - 1.0) / (m + 1.0);
        const double q = t * t;
        double series = 1.0 / 11.0 + q / 13.0;
        series = 1.0 / 9.0 + q * series;
        series = 1.0 / 7.0 + q * series;
        series = 1.0 / 5.0 + q * series;
        series = 1.0 / 3.0 + q * series;
        series = 1.0 + q * series;
        log2_cosine[i] = 0.5 * e + t * series * std::numbers::log2e;
    }
}

// cos^power(theta), of so many.
APHOTIC_WIDE void raise(const RowBlock<double>& log2_cosine,
                        double power,
                        std::size_t count,
                        RowBlock<double>& values) {
    constexpr double kRound = 0x1.8p52;  // what is added to it loses all after the point
    constexpr double kLeast = -1000.0;   // 2^-1000 is nothing
    constexpr double kMost = 100.0;      // of a negative power, where cos(theta) is nothing
    for (std::size_t i = 0; i < count; ++i) {
        const double asked = power * log2_cosine[i];
        const double above = 0.5 * (asked + kLeast + std::abs(asked - kLeast));
        const double y = 0.5 * (above + kMost - std::abs(above - kMost));
        const double rounded = y + kRound;
        const double f = (y - (rounded - kRound)) * std::numbers::ln2;
        double series = 1.0 / 40320.0 + f / 362880.0;
        series = 1.0 / 5040.0 + f * series;
        series = 1.0 / 720.0 + f * series;
        series = 1.0 / 120.0 + f * series;
        series = 1.0 / 24.0 + f * series;
        series = 1.0 / 6.0 + f * series;
        series = 1.0 / 2.0 + f * series;
        series = 1.0 + f * series;
        series = 1.0 + f * series;
        const double of_whole = std::bit_cast<double>(
            (std::bit_cast<std::uint64_t>(rounded) + kExponentBias) << kMantissaBits);
        values[i] = series * of_whole;
    }
}

APHOTIC_WIDE void add_products(const RowBlock<double>& a,
                               const RowBlock<double>& b,
                               RowBlock<double>& sum) {
    for (std::size_t i = 0; i < kBlockCount; ++i) sum[i] += a[i] * b[i];
}

APHOTIC_WIDE void take_cosines(const DirectionBlock& V, RowBlock<double>& cosines) {
    for (std::size_t i = 0; i < kBlockCount; ++i) cosines[i] = V.axis[i] / std::sqrt(V.square[i]);
}

APHOTIC_WIDE void add_soft_lobe(const SoftLobe& lobe,
                                const RowBlock<double>& cosines,
                                RowBlock<double>& sum) {
    const double none = lobe.edge_cosine;
    const double per_cosine = 1.0 / (lobe.full_cosine - lobe.edge_cosine);
    const double on_axis = lobe.on_axis;
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        const double place = (cosines[i] - none) * per_cosine;
        const double above = place > 0.0 ? place : 0.0;
        const double t = above < 1.0 ? above : 1.0;
        sum[i] += on_axis * (t * t * (3.0 - 2.0 * t));
    }
}

std::vector<double> exponents_but_1(const Beam& beam) {
    std::vector<double> others;
    for (const Cone& cone : beam.cones) {
        const bool is_known = std::ranges::find(others, cone.exponent) != others.end();
        if (cone.exponent != 1.0 && !is_known) others.push_back(cone.exponent);
    }
    return others;
}

void find_sharp(const LobeLight& light, const DirectionBlock& V, LobeWork& work) {
    // A cone of 90 degrees ends where its cosine does, and has no edge to look for.
    constexpr double kNoEdge = 1e-15;
    double everywhere = 0.0;
    for (const Lobe& lobe : light.sharp) {
        if (lobe.exponent == 1.0 && lobe.edge_cosine < kNoEdge) everywhere += lobe.on_axis;
    }
    work.cosines.fill(everywhere);
    for (const Lobe& lobe : light.sharp) {
        if (lobe.exponent == 1.0 && lobe.edge_cosine >= kNoEdge) add_lobe(lobe, V, work.cosines);
    }
    work.powers.resize(light.other_exponents.size());
    for (std::size_t k = 0; k < work.powers.size(); ++k) {
        work.powers[k].fill(0.0);
        for (const Lobe& lobe : light.sharp) {
            if (lobe.exponent == light.other_exponents[k]) add_lobe(lobe, V, work.powers[k]);
        }
    }
}

}  // namespace

LobeLight lobe_light(const Beam& beam, double factor) {
    LobeLight light{.sharp = {}, .soft = {}, .other_exponents = exponents_but_1(beam)};
    const std::vector<Lobe> lobes = lobes_of(beam);
    for (std::size_t k = 0; k < lobes.size(); ++k) {
        const Cone& cone = beam.cones[k];
        const Lobe& lobe = lobes[k];
        const double on_axis = factor * lobe.on_axis;
        if (cone.edge_rad == 0.0) {
            light.sharp.push_back({lobe.edge_cosine, on_axis, lobe.exponent});
        } else {
            const double full_cosine = std::cos(cone.half_angle_rad - cone.edge_rad);
            light.soft.push_back({full_cosine, lobe.edge_cosine, on_axis, lobe.exponent});
        }
    }
    return light;
}

void look_into(const LobeLight& light,
               const DirectionBlock& V,
               Edges edges,
               LobeWork& work,
               RowBlock<double>& intensity) {
    if (edges == Edges::Found) find_sharp(light, V, work);
    intensity = work.cosines;
    if (!light.soft.empty()) take_cosines(V, work.cosine);
    for (const SoftLobe& lobe : light.soft) {
        if (lobe.exponent == 1.0) add_soft_lobe(lobe, work.cosine, intensity);
    }
    if (light.other_exponents.empty()) return;
    // A power is smooth along a row, whatever the lobes' edges.
    take_samples(V, false, work.samples);
    take_logarithm(work.samples, work.log2_of_samples);
    bool has_logarithm = false;
    for (std::size_t k = 0; k < work.powers.size(); ++k) {
        work.factors = work.powers[k];
        for (const SoftLobe& lobe : light.soft) {
            if (lobe.exponent != light.other_exponents[k]) continue;
            add_soft_lobe(lobe, work.cosine, work.factors);
        }
        const double power = light.other_exponents[k] - 1.0;
        raise(work.log2_of_samples, power, kFitSamples, work.power_of_samples);
        if (!V.is_in_order || !fit(work.power_of_samples, 0.0, kFitError, work.power)) {
            if (!has_logarithm) take_logarithm(V, work.log2_cosine);
            has_logarithm = true;
            raise(work.log2_cosine, power, kBlockCount, work.power);
        }
        add_products(work.factors, work.power, intensity);
    }
}

}  // namespace aphotic
