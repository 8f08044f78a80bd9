// SPDX-License-Identifier: BSD-3-Clause
#include "base/offered.h"

#include "base/number.h"

#include <cmath>

namespace aphotic {

double at_least(double value, int digits) {
    if (!std::isfinite(value) || value == 0.0) return value;
    const double nearest = rounded_to_digits(value, digits);
    if (nearest >= value) return nearest;
    // It was rounded down by less than a step, so adding one step is enough.
    const double step = std::pow(10.0, std::floor(std::log10(std::abs(nearest))) - digits + 1);
    return rounded_to_digits(nearest + step, digits);
}

double at_most(double value, int digits) {
    return -at_least(-value, digits);
}

}  // namespace aphotic
