// SPDX-License-Identifier: BSD-3-Clause
#include "survey/correct/polynomial_surface.h"

#include "base/error.h"

#include <Eigen/Cholesky>

#include <utility>

namespace aphotic {
namespace {

using Samples = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// By Bonnet's recursion, n P_n = (2n - 1) x P_(n-1) - (n - 1) P_(n-2).
Eigen::MatrixXd legendre(int points, int order) {
    const Eigen::ArrayXd x =
        Eigen::ArrayXd::LinSpaced(points, 1.0 / points - 1.0, 1.0 - 1.0 / points);
    Eigen::MatrixXd values = Eigen::MatrixXd::Ones(points, order + 1);
    if (order > 0) values.col(1) = x;
    for (int n = 2; n <= order; ++n) {
        values.col(n) =
            ((2 * n - 1) * x * values.col(n - 1).array() - (n - 1) * values.col(n - 2).array()) / n;
    }
    return values;
}

// The exponents (of x, of y) of the terms.
std::vector<std::pair<int, int>> terms_of(int order) {
    std::vector<std::pair<int, int>> terms;
    for (int i = 0; i <= order; ++i) {
        for (int j = 0; i + j <= order; ++j) terms.emplace_back(i, j);
    }
    return terms;
}

}  // namespace

PolynomialSurface::PolynomialSurface(int width_px, int height_px, int order)
    : order_(order),
      along_x_(legendre(width_px, order)),
      along_y_(legendre(height_px, order)),
      moments_(Eigen::MatrixXd::Zero(order + 1, order + 1)) {
    if (width_px <= order || height_px <= order) {
        throw InputError(
            "a polynomial of order {}: found an image of {} x {} pixels; allowed: {} or more each "
            "way",
            order,
            width_px,
            height_px,
            order + 1);
    }
}

void PolynomialSurface::add(std::span<const float> plane) {
    const Eigen::Map<const Samples> samples(plane.data(), along_y_.rows(), along_x_.rows());
    // Row by row: no copy of the whole plane in double.
    for (Eigen::Index row = 0; row < samples.rows(); ++row) {
        const Eigen::RowVectorXd of_row = samples.row(row).cast<double>() * along_x_;
        moments_ += along_y_.row(row).transpose() * of_row;
    }
    ++planes_;
}

double PolynomialSurface::mean() const {
    const auto pixels = static_cast<double>(along_x_.rows() * along_y_.rows());
    return moments_(0, 0) / (pixels * static_cast<double>(planes_));
}

// The normal equations: on a full grid their matrix is a product of sums over x and over y.
std::vector<float> PolynomialSurface::fitted() const {
    const std::vector<std::pair<int, int>> terms = terms_of(order_);
    const auto size = static_cast<Eigen::Index>(terms.size());
    const Eigen::MatrixXd over_x = along_x_.transpose() * along_x_;
    const Eigen::MatrixXd over_y = along_y_.transpose() * along_y_;
    Eigen::MatrixXd normal(size, size);
    Eigen::VectorXd wanted(size);
    for (Eigen::Index a = 0; a < size; ++a) {
        const auto [i, j] = terms[static_cast<std::size_t>(a)];
        wanted(a) = moments_(j, i) / static_cast<double>(planes_);
        for (Eigen::Index b = 0; b < size; ++b) {
            const auto [k, l] = terms[static_cast<std::size_t>(b)];
            normal(a, b) = over_x(i, k) * over_y(j, l);
        }
    }
    const Eigen::VectorXd solution = normal.ldlt().solve(wanted);
    Eigen::MatrixXd coefficients = Eigen::MatrixXd::Zero(order_ + 1, order_ + 1);
    for (Eigen::Index a = 0; a < size; ++a) {
        const auto [i, j] = terms[static_cast<std::size_t>(a)];
        coefficients(j, i) = solution(a);
    }
    std::vector<float> surface(static_cast<std::size_t>(along_x_.rows() * along_y_.rows()));
    Eigen::Map<Samples>(surface.data(), along_y_.rows(), along_x_.rows()) =
        (along_y_ * coefficients * along_x_.transpose()).cast<float>();
    return surface;
}

}  // namespace aphotic
