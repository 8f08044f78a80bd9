// SPDX-License-Identifier: BSD-3-Clause
//
// The reference's own lens: the direction of an image point's ray, for a calibration's numbers
// (rig/camera/lens_model.h has the formula, but shares no code). The distance from the axis is
// found by bracketing, the decentring by iteration: its correction depends on the previous result,
// and converges.
#pragma once

#include "rig/camera/lens_model.h"
#include "rig/rig.h"

#include <Eigen/Core>

#include <optional>

namespace aphotic {

class TracedLens {
  public:
    using Direction = Eigen::Matrix<long double, 3, 1>;

    explicit TracedLens(const LensModel& lens);

    // In the sled's frame (x forward, y starboard, z down), with z = 1; empty outside the lens's
    // range.
    [[nodiscard]] std::optional<Direction> direction(double column, double row) const;

  private:
    [[nodiscard]] long double image_radius(long double r) const;  // s r

    LensModel lens_;
    long double most_r_;  // up to which s r grows
    long double most_image_r_;
};

// The reference's own vignetting: the factor of a pixel's signal, for the numbers of
// rig/camera/vignetting.h, whose formula it does not use. sight: the direction in air of the point
// (column, row), of any length. 1 without vignetting.
[[nodiscard]] double traced_vignetting(const Camera& camera,
                                       double column,
                                       double row,
                                       const Eigen::Matrix<long double, 3, 1>& sight);

}  // namespace aphotic
