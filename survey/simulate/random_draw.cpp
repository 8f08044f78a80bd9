// SPDX-License-Identifier: BSD-3-Clause
#include "survey/simulate/random_draw.h"

#include <cmath>
#include <numbers>

namespace aphotic {
namespace {

// log k!; from 10 up Stirling's series, whose first omitted term is under 1e-10 of it.
double log_factorial(double k) {
    if (k < 10.0) {
        double product = 1.0;
        for (double i = 2.0; i <= k; i += 1.0) product *= i;
        return std::log(product);
    }
    const double k2 = k * k;
    return (k + 0.5) * std::log(k) - k + 0.5 * std::log(2.0 * std::numbers::pi) +
           (1.0 / 12.0 - (1.0 / 360.0 - 1.0 / (1260.0 * k2)) / k2) / k;
}

double few_events(RandomSource& random, double mu) {
    const double least = std::exp(-mu);
    double count = 0.0;
    for (double product = uniform(random); product > least; product *= uniform(random))
        count += 1.0;
    return count;
}

// The names and numbers are the paper's.
double many_events(RandomSource& random, double mu) {
    const double b = 0.931 + 2.53 * std::sqrt(mu);
    const double a = -0.059 + 0.02483 * b;
    const double inverse_alpha = 1.1239 + 1.1328 / (b - 3.4);
    const double v_r = 0.9277 - 3.6224 / (b - 2.0);
    const double log_mu = std::log(mu);
    while (true) {
        const double u = uniform(random) - 0.5;
        const double v = uniform(random);
        const double us = 0.5 - std::abs(u);
        const double k = std::floor((2.0 * a / us + b) * u + mu + 0.43);
        if (us >= 0.07 && v <= v_r) return k;
        if (k < 0.0 || (us < 0.013 && v > us)) continue;
        if (std::log(v * inverse_alpha / (a / (us * us) + b)) <=
            k * log_mu - mu - log_factorial(k)) {
            return k;
        }
    }
}

}  // namespace

RandomSource random_of(std::uint64_t seed, int image) {
    std::seed_seq words{static_cast<std::uint32_t>(seed),
                        static_cast<std::uint32_t>(seed >> 32U),
                        static_cast<std::uint32_t>(image)};
    return RandomSource(words);
}

double uniform(RandomSource& random) {
    return static_cast<double>(random() >> 11U) * 0x1p-53;
}

double normal(RandomSource& random) {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform(random)));
    return radius * std::cos(2.0 * std::numbers::pi * uniform(random));
}

double poisson(RandomSource& random, double mu) {
    if (!(mu > 0.0)) return 0.0;
    return mu < kFewEvents ? few_events(random, mu) : many_events(random, mu);
}

}  // namespace aphotic
