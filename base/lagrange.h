// SPDX-License-Identifier: BSD-3-Clause
//
// Lagrange's cubic through the values at 0, 1, 2 and 3: sum_k weight_k(a) y_k at a. Exact for
// polynomials of degree 3.
#pragma once

#include <array>

namespace aphotic {

[[nodiscard]] constexpr std::array<double, 4> lagrange_weights(double a) {
    const double b = a - 1.0;
    const double c = a - 2.0;
    const double d = a - 3.0;
    return {-b * c * d / 6.0, a * c * d / 2.0, -a * b * d / 2.0, a * b * c / 6.0};
}

}  // namespace aphotic
