// SPDX-License-Identifier: BSD-3-Clause
#include "survey/correct/polynomial_surface.h"

#include "base/error.h"

#include <Eigen/QR>

namespace aphotic {
namespace {

using Samples = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// The powers of x, made orthonormal in their order: column n is a polynomial of degree n.
Eigen::MatrixXd polynomials(int points, int order) {
    const Eigen::ArrayXd x =
        Eigen::ArrayXd::LinSpaced(points, 1.0 / points - 1.0, 1.0 - 1.0 / points);
    Eigen::MatrixXd powers = Eigen::MatrixXd::Ones(points, order + 1);
    for (int n = 1; n <= order; ++n) powers.col(n) = powers.col(n - 1).array() * x;
    return powers.householderQr().householderQ() * Eigen::MatrixXd::Identity(points, order + 1);
}

}  // namespace

PolynomialSurface::PolynomialSurface(int width_px, int height_px, int order)
    : order_(order),
      along_x_(polynomials(width_px, order)),
      along_y_(polynomials(height_px, order)),
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
    return moments_(0, 0) * along_x_(0, 0) * along_y_(0, 0) / static_cast<double>(planes_);
}

std::vector<float> PolynomialSurface::fitted() const {
    Eigen::MatrixXd coefficients = moments_ / static_cast<double>(planes_);
    for (int i = 0; i <= order_; ++i) coefficients.col(i).tail(i).setZero();
    std::vector<float> surface(static_cast<std::size_t>(along_x_.rows() * along_y_.rows()));
    Eigen::Map<Samples>(surface.data(), along_y_.rows(), along_x_.rows()) =
        (along_y_ * coefficients * along_x_.transpose()).cast<float>();
    return surface;
}

}  // namespace aphotic
