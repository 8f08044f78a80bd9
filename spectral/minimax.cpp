// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/minimax.h"

#include <Eigen/Cholesky>
#include <Eigen/QR>

#include <cmath>

namespace aphotic {

using Eigen::ArrayXd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {
constexpr int kCorrections = 1;
}

MinimaxFit minimax_fit(const MatrixXd& a, const VectorXd& b, const MinimaxOptions& options) {
    const Eigen::Index rows = a.rows();
    const Eigen::Index columns = a.cols();
    ArrayXd scale = a.cwiseAbs().colwise().maxCoeff().transpose().array();
    scale = (scale > 0.0).select(scale, 1.0);

    MinimaxFit best{.x = VectorXd::Zero(columns),
                    .error = std::numeric_limits<double>::infinity(),
                    .weights = options.weights};
    ArrayXd& u = best.weights;
    const double even = 1.0 / static_cast<double>(rows);
    // A weight of zero would stay zero.
    constexpr double kEvenShare = 0.1;
    u = u.size() == rows ? ArrayXd((1.0 - kEvenShare) * u + kEvenShare * even)
                         : ArrayXd::Constant(rows, even);
    const MatrixXd scaled = a.array().rowwise() / scale.transpose();
    MatrixXd weighted(rows, columns);
    MatrixXd gram(columns, columns);
    for (int i = 0; i < options.iterations; ++i) {
        weighted = scaled.array().colwise() * u;
        gram.setZero();
        gram.diagonal().setConstant(options.ridge * options.ridge);
        gram.triangularView<Eigen::Lower>() += scaled.transpose() * weighted;
        const Eigen::LLT<Eigen::Ref<MatrixXd>> cholesky(gram);  // in place
        VectorXd y = cholesky.solve(weighted.transpose() * b);
        for (int k = 0; k < kCorrections; ++k) {
            y += cholesky.solve(weighted.transpose() * (b - scaled * y) -
                                options.ridge * options.ridge * y);
        }
        const VectorXd x = y.array() / scale;
        const ArrayXd residual = (a * x - b).array().abs();
        const double error = residual.maxCoeff();
        if (error < best.error) {
            best.error = error;
            best.x = x;
        }
        if (std::sqrt((u * residual.square()).sum()) > options.give_up) break;
        const ArrayXd next = u * residual;
        const double sum = next.sum();
        if (!(sum > 0.0)) break;  // exact, or NaN: no residual to weight
        u = next / sum;
    }
    return best;
}

ArrayXd minimax_lower_bounds(const MatrixXd& a,
                             const VectorXd& b,
                             const MatrixXd& candidates,
                             const ArrayXd& weights) {
    const ArrayXd root = weights.sqrt();
    VectorXd left = b.array() * root;
    MatrixXd apart = candidates.array().colwise() * root;
    if (a.cols() > 0) {
        MatrixXd weighted = a.array().colwise() * root;
        const Eigen::HouseholderQR<Eigen::Ref<MatrixXd>> qr(weighted);
        const MatrixXd q = qr.householderQ() * MatrixXd::Identity(a.rows(), a.cols());
        left -= q * (q.transpose() * left);
        apart -= q * (q.transpose() * apart);
    }
    // How much a candidate reduces the residual of the others.
    const ArrayXd gain = (apart.transpose() * left).array().square() /
                         apart.colwise().squaredNorm().transpose().array();
    return (left.squaredNorm() - gain.isFinite().select(gain, 0.0)).max(0.0).sqrt();
}

}  // namespace aphotic
