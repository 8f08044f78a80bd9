// SPDX-License-Identifier: BSD-3-Clause
//
// Variances of what is fitted by balanced half-samples: what the same fit makes of halves of the
// images, x_h, and of all, x,
//
//   variance = mean over kHalves halves of (x_h - x)^2
//
// Of a mean of independent images that is its variance, for var x_h = 2 var x and cov(x_h, x) =
// var x. It knows no model of the noise, nor that the light is anything like a straight line in
// the numbers: where many answers explain the images all but alike, halves come to different ones.
//
// Images go to kHalves + 1 groups in turn. Half h, from 1 on, has those groups whose number has an
// even count of bits in common with h (Walsh's functions), so that any two halves share a half of
// theirs (P. J. McCarthy, Rev. Int. Stat. Inst. 37 (1969) 239).
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <functional>

namespace aphotic {

inline constexpr std::size_t kHalves = 15;

[[nodiscard]] bool is_in_half(std::size_t image, std::size_t half);

// values_of(half): of half 1 to kHalves; of 0: of all.
[[nodiscard]] Eigen::VectorXd variances_by_halves(
    const std::function<Eigen::VectorXd(std::size_t half)>& values_of);

}  // namespace aphotic
