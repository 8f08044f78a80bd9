// SPDX-License-Identifier: BSD-3-Clause
//
// Gauss and Legendre's rule of n points:
//
//   int_0^1 f(x) dx ~ sum_i w_i f(x_i)
//
// exact for polynomials of degree 2 n - 1. One point is the middle; two are 1/2 -+ 1/sqrt(12), with
// weights of 1/2.
#pragma once

#include <vector>

namespace aphotic {

struct GaussNode {
    double at = 0.0;      // from 0 to 1
    double weight = 0.0;  // their sum is 1
};

// By place, ascending; none for 0 points. Computed once for each number of points. Thread-safe.
[[nodiscard]] const std::vector<GaussNode>& gauss_rule(unsigned points);

}  // namespace aphotic
