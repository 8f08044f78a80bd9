// SPDX-License-Identifier: BSD-3-Clause
#include "base/non_negative_fit.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace aphotic {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// The unconstrained minimum over some of the coefficients, with the others 0.
VectorXd minimum_over(const MatrixXd& G, const VectorXd& b, const std::vector<Index>& free) {
    VectorXd x = VectorXd::Zero(b.size());
    if (free.empty()) return x;
    const MatrixXd part = G(free, free);
    const VectorXd right = b(free);
    const VectorXd found = part.ldlt().solve(right);
    x(free) = found;
    return x;
}

// For scaled equations, whose diagonal is 1 or 0.
VectorXd scaled_fit(const MatrixXd& G, const VectorXd& b) {
    const Index count = b.size();
    const auto most_steps = 10 * count + 10;
    VectorXd x = VectorXd::Zero(count);
    std::vector<Index> free;
    std::vector<bool> is_free(static_cast<std::size_t>(count), false);
    const double rounding = kGradientRounding * b.cwiseAbs().maxCoeff();
    for (Index step = 0; step < most_steps; ++step) {
        const VectorXd fall = b - G * x;
        Index best = -1;
        for (Index i = 0; i < count; ++i) {
            if (is_free[static_cast<std::size_t>(i)] || G(i, i) <= 0.0) continue;
            if (fall(i) > rounding && (best < 0 || fall(i) > fall(best))) best = i;
        }
        if (best < 0) break;
        is_free[static_cast<std::size_t>(best)] = true;
        free.push_back(best);
        // Moves towards the minimum until a coefficient would become negative; such ones become 0
        // and are no longer free.
        for (VectorXd to = minimum_over(G, b, free);; to = minimum_over(G, b, free)) {
            double share = 1.0;
            for (const Index i : free) {
                if (to(i) <= 0.0) share = std::min(share, x(i) / (x(i) - to(i)));
            }
            if (!(share < 1.0)) {
                x = to;
                break;
            }
            x += share * (to - x);
            std::erase_if(free, [&](Index i) {
                if (x(i) > std::numeric_limits<double>::epsilon() || to(i) > 0.0) return false;
                x(i) = 0.0;
                is_free[static_cast<std::size_t>(i)] = false;
                return true;
            });
            if (free.empty()) break;
        }
    }
    return x.cwiseMax(0.0);
}

}  // namespace

VectorXd non_negative_fit(const MatrixXd& G, const VectorXd& b) {
    if (b.size() == 0) return b;
    VectorXd per_size(b.size());
    for (Index i = 0; i < b.size(); ++i)
        per_size(i) = G(i, i) > 0.0 ? 1.0 / std::sqrt(G(i, i)) : 0.0;
    const VectorXd x =
        scaled_fit(per_size.asDiagonal() * G * per_size.asDiagonal(), per_size.cwiseProduct(b));
    return per_size.cwiseProduct(x);
}

}  // namespace aphotic
