// SPDX-License-Identifier: BSD-3-Clause
//
// Linear fit in the largest error, not in its square:
//
//   minimise over x   max_i |sum_j A_ij x_j - b_i|
//
// by Lawson's iteration: least squares under weights u_i, each multiplied by its residual and
// made to sum to 1 again, tends to the minimax fit; the best of the iterations is returned, so
// more of them are never worse. (C. L. Lawson, thesis, UCLA 1961; J. R. Rice and K. H. Usow,
// Mathematics of Computation 22, 1968.)
//
// Columns may depend on one another, or nearly: a ridge on every column, scaled to a
// largest element of 1, makes the smallest of equally good solutions the answer. Of nearly
// dependent columns it may cost an error of the ridge times the solution.
//
// Under any weights that sum to 1 the least root of sum u_i r_i^2 is no more than the minimax
// error: a fit that is known to end over `give_up` is given up at once.
#pragma once

#include <Eigen/Core>

#include <limits>

namespace aphotic {

struct MinimaxFit {
    Eigen::VectorXd x;
    double error = 0.0;      // infinite: given up before any fit
    Eigen::ArrayXd weights;  // u_i of the last iteration
};

struct MinimaxOptions {
    int iterations = 60;
    double ridge = 1e-7;
    double give_up = std::numeric_limits<double>::infinity();
    Eigen::ArrayXd weights{};  // to start from, such as a similar fit's; empty: equal
};

[[nodiscard]] MinimaxFit minimax_fit(const Eigen::MatrixXd& a,
                                     const Eigen::VectorXd& b,
                                     const MinimaxOptions& options = {});

// What no minimax fit can be better than when one of the candidates, a column each, joins the
// columns of a: the least root of sum u_i r_i^2, for each candidate.
[[nodiscard]] Eigen::ArrayXd minimax_lower_bounds(const Eigen::MatrixXd& a,
                                                  const Eigen::VectorXd& b,
                                                  const Eigen::MatrixXd& candidates,
                                                  const Eigen::ArrayXd& weights);

}  // namespace aphotic
