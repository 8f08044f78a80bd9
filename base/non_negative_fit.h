// SPDX-License-Identifier: BSD-3-Clause
//
// Least squares by coefficients that are not negative, from the normal equations:
//
//   minimise  1/2 x^T G x - b^T x   over x >= 0,      G = A^T A,  b = A^T y
//
// by Lawson and Hanson's active sets: where x_i = 0 the gradient G x - b is 0 or more, elsewhere it
// is 0, to kGradientRounding of its terms. Columns of zeros have the coefficient 0.
//
// C. L. Lawson and R. J. Hanson, Solving Least Squares Problems (1974), chapter 23.
#pragma once

#include <Eigen/Core>

namespace aphotic {

inline constexpr double kGradientRounding = 1e-10;

// G is symmetric and positive semidefinite.
[[nodiscard]] Eigen::VectorXd non_negative_fit(const Eigen::MatrixXd& G, const Eigen::VectorXd& b);

}  // namespace aphotic
