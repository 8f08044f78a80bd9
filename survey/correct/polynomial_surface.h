// SPDX-License-Identifier: BSD-3-Clause
//
// One polynomial of low order over the image, fitted by least squares to many images at once.
//
//   p(x, y) = sum over i + j <= order of  c_ij P_i(x) P_j(y)
//
// P_i   polynomials of degree i, orthonormal over the columns, P_j over the rows: c_ij is the sum
//       of P_i(x) P_j(y) times the mean image over the pixels
// x, y  a pixel's centre, -1 to 1 from border to border
//
// The fit to many images on one grid is the fit to their mean, so an image adds (order + 1)^2
// moments and is discarded. A plane that is itself such a polynomial is reproduced to the rounding
// of floats.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

namespace aphotic {

class PolynomialSurface {
  public:
    // An InputError if the image has fewer rows or columns than the order needs, order + 1.
    PolynomialSurface(int width_px, int height_px, int order);

    void add(std::span<const float> plane);  // width_px x height_px samples, all finite
    [[nodiscard]] std::size_t planes() const { return planes_; }

    // Once a plane has been added: the mean of all samples of all planes, and p at every pixel, row
    // by row.
    [[nodiscard]] double mean() const;
    [[nodiscard]] std::vector<float> fitted() const;

  private:
    int order_;
    Eigen::MatrixXd along_x_;  // P_i at every column
    Eigen::MatrixXd along_y_;  // P_j at every row
    Eigen::MatrixXd moments_;  // of the sum of the planes, with P_j P_i
    std::size_t planes_ = 0;
};

}  // namespace aphotic
