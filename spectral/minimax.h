// SPDX-License-Identifier: BSD-3-Clause
//
// Linear fit that minimises the largest error instead of the squares:
//
//   minimise over x   max_i |sum_j A_ij x_j - b_i|
//
// by Lawson's iteration: least squares with weights u_i, each multiplied by its residual and
// normalised to a sum of 1, converges to the minimax fit; the best iteration is returned, so more
// of them are never worse. (C. L. Lawson, thesis, UCLA 1961; J. R. Rice and K. H. Usow, Mathematics
// of Computation 22, 1968.)
//
// Columns may be linearly dependent, or nearly: a ridge on every column, scaled to a largest
// element of 1, selects the smallest of equally good solutions. For nearly dependent columns it may
// cost an error of the ridge times the solution.
//
// For any weights that sum to 1, the least root of sum u_i r_i^2 is a lower bound of the minimax
// error: a fit whose bound exceeds `give_up` is abandoned at once.
#pragma once

#include <Eigen/Core>

#include <limits>

namespace aphotic {

struct MinimaxFit {
    Eigen::VectorXd x;
    double error = 0.0;      // infinite: abandoned before any fit
    Eigen::ArrayXd weights;  // u_i of the last iteration
};

struct MinimaxOptions {
    int iterations = 60;
    double ridge = 1e-7;
    double give_up = std::numeric_limits<double>::infinity();
    Eigen::ArrayXd weights{};  // initial weights, such as a similar fit's; empty: equal
};

[[nodiscard]] MinimaxFit minimax_fit(const Eigen::MatrixXd& a,
                                     const Eigen::VectorXd& b,
                                     const MinimaxOptions& options = {});

// A lower bound of any minimax fit if one of the candidates, a column each, is added to the columns
// of a: the least root of sum u_i r_i^2, for each candidate.
[[nodiscard]] Eigen::ArrayXd minimax_lower_bounds(const Eigen::MatrixXd& a,
                                                  const Eigen::VectorXd& b,
                                                  const Eigen::MatrixXd& candidates,
                                                  const Eigen::ArrayXd& weights);

}  // namespace aphotic
