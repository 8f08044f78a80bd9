// SPDX-License-Identifier: BSD-3-Clause
#include "base/offered.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace aphotic {
namespace {

// Whatever the locale.
double read_back(const std::string& text) {
    double value = 0.0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

}  // namespace

double at_least(double value, int digits) {
    if (!std::isfinite(value) || value == 0.0) return value;
    const double nearest = read_back(fmt::format("{:.{}e}", value, digits - 1));
    if (nearest >= value) return nearest;
    // It was rounded down: by less than a step, so a step more is enough.
    const double step = std::pow(10.0, std::floor(std::log10(std::abs(nearest))) - digits + 1);
    return read_back(fmt::format("{:.{}e}", nearest + step, digits - 1));
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
