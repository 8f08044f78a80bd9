// SPDX-License-Identifier: BSD-3-Clause
//
// The reference's own vignetting: the factor of a pixel's signal, for the numbers of
// rig/vignetting.h, of which it has no formula.
#pragma once

#include "rig/rig.h"

#include <Eigen/Core>

namespace aphotic {

// sight: which way the point (column, row) looks in air, of any length. 1 without vignetting.
[[nodiscard]] double traced_vignetting(const Camera& camera,
                                       double column,
                                       double row,
                                       const Eigen::Matrix<long double, 3, 1>& sight);

}  // namespace aphotic
