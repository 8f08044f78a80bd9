// SPDX-License-Identifier: BSD-3-Clause
//
// Random numbers for simulated surveys: independent of the standard library, whose distributions
// vary.
//
//   normal     mean 0, variance 1; by Box and Muller
//   poisson    mean and variance mu: under kFewEvents by Knuth's product of uniforms, else by the
//              transformed rejection PTRS of W. Hoermann, "The transformed rejection method for
//              generating Poisson random variables", Insurance: Mathematics and Economics 12 (1993)
//
// poisson(0) is 0.
#pragma once

#include <cstdint>
#include <random>

namespace aphotic {

using RandomSource = std::mt19937_64;

// For one image of a survey; 0 is the survey as a whole. It depends on nothing else, so that images
// can be made in any order.
[[nodiscard]] RandomSource random_of(std::uint64_t seed, int image);

// From 0 to below 1.
[[nodiscard]] double uniform(RandomSource& random);
[[nodiscard]] double normal(RandomSource& random);

inline constexpr double kFewEvents = 10.0;
[[nodiscard]] double poisson(RandomSource& random, double mu);

}  // namespace aphotic
