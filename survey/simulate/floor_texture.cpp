// SPDX-License-Identifier: BSD-3-Clause
#include "survey/simulate/floor_texture.h"

#include <array>
#include <cmath>

namespace aphotic {
namespace {

constexpr double kCoarsest_m = 0.64;
constexpr int kOctaves = 6;

// The finalizer of SplitMix64 (Steele, Lea, Flood, OOPSLA 2014).
std::uint64_t mixed(std::uint64_t x) {
    x = (x ^ (x >> 30U)) * 0xBF58476D1CE4E5B9U;
    x = (x ^ (x >> 27U)) * 0x94D049BB133111EBU;
    return x ^ (x >> 31U);
}

// Of mean 0 and variance 1: the sum of four 16-bit numbers, uniform from 0 to 1, whose variance is
// 4/12. Nearly normal, and fast.
double corner(std::uint64_t seed, std::int64_t x, std::int64_t y) {
    const std::uint64_t bits =
        mixed(mixed(seed + static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15U) +
              static_cast<std::uint64_t>(y));
    double sum = 0.0;
    for (unsigned shift = 0; shift < 64; shift += 16)
        sum += (static_cast<double>((bits >> shift) & 0xFFFFU) + 0.5) * 0x1p-16;
    return (sum - 2.0) * std::sqrt(3.0);
}

struct Blend {
    std::int64_t cell;
    std::array<double, 2> weight;
};

Blend blend_at(double x) {
    const double cell = std::floor(x);
    const double t = x - cell;
    const double weight = t * t * t * (t * (6.0 * t - 15.0) + 10.0);
    return {.cell = static_cast<std::int64_t>(cell), .weight = {1.0 - weight, weight}};
}

}  // namespace

FloorTexture::FloorTexture(double contrast, std::uint64_t seed)
    : spread_(std::sqrt(std::log1p(contrast * contrast))), seed_(seed) {}

double FloorTexture::at(double x_m, double y_m) const {
    double sum = 0.0;
    double squares = 0.0;
    double scale_per_m = 1.0 / kCoarsest_m;
    for (std::uint64_t octave = 1; octave <= kOctaves; ++octave, scale_per_m *= 2.0) {
        const std::uint64_t seed = mixed(seed_ + octave);
        // Otherwise all grids would have a corner at the origin.
        const double shift = 0.37 * static_cast<double>(octave);
        const Blend x = blend_at(x_m * scale_per_m + shift);
        const Blend y = blend_at(y_m * scale_per_m + shift);
        for (const std::size_t j : {0U, 1U}) {
            for (const std::size_t i : {0U, 1U}) {
                const double weight = x.weight.at(i) * y.weight.at(j);
                sum += weight * corner(seed,
                                       x.cell + static_cast<std::int64_t>(i),
                                       y.cell + static_cast<std::int64_t>(j));
                squares += weight * weight;
            }
        }
    }
    return std::exp(spread_ * (sum / std::sqrt(squares) - 0.5 * spread_));
}

}  // namespace aphotic
