// SPDX-License-Identifier: BSD-3-Clause
#include "base/offered.h"

#include "base/number.h"

#include <fmt/format.h>

#include <cmath>

namespace aphotic {
namespace {

double rounded(double value, int digits) {
    return read_number<double>(fmt::format("{:.{}e}", value, digits - 1)).value();
}

}  // namespace

double at_least(double value, int digits) {
    if (!std::isfinite(value) || value == 0.0) return value;
    const double nearest = rounded(value, digits);
    if (nearest >= value) return nearest;
    // It was rounded down by less than a step, so adding one step is enough.
    const double step = std::pow(10.0, std::floor(std::log10(std::abs(nearest))) - digits + 1);
    return rounded(nearest + step, digits);
}

double at_most(double value, int digits) {
    return -at_least(-value, digits);
}

std::string at_least_text(double value, int digits) {
    return fmt::format("{}", at_least(value, digits));
}

std::string at_most_text(double value, int digits) {
    return fmt::format("{}", at_most(value, digits));
}

}  // namespace aphotic
