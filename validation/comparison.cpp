// SPDX-License-Identifier: BSD-3-Clause
#include "validation/comparison.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace aphotic {

double relative_error(double a, double b, double floor) {
    if (!std::isfinite(a) || !std::isfinite(b)) return std::numeric_limits<double>::quiet_NaN();
    const double scale = std::max(std::abs(b), floor);
    return a == b ? 0.0 : (a - b) / scale;
}

Comparison compare_planes(std::string name,
                          std::span<const float> a,
                          std::span<const double> b,
                          int width_px,
                          std::span<const unsigned char> marks,
                          double floor,
                          double bound) {
    Comparison found{.name = std::move(name), .bound = bound, .floor = floor};
    std::vector<double> errors;
    errors.reserve(a.size());
    double sum = 0.0;
    double sum_of_squares = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const unsigned char mark = marks.empty() ? 0 : marks[i];
        if (mark == kUnobserved) {
            ++found.unobserved;
            continue;
        }
        const double e = relative_error(a[i], b[i], floor);
        const double size = std::abs(e);
        const bool is_on_edge = mark == kOnEdge;
        if (is_on_edge) ++found.on_edges;
        if (std::isnan(e)) {
            ++found.not_finite;
        } else if (is_on_edge) {
            found.max_error_on_edges = std::max(found.max_error_on_edges, size);
        } else {
            if (size > found.max_error) {
                found.max_error = size;
                found.column = static_cast<int>(i % static_cast<std::size_t>(width_px));
                found.row = static_cast<int>(i / static_cast<std::size_t>(width_px));
            }
            if (std::abs(b[i]) < floor) ++found.under_floor;
            sum += e;
            sum_of_squares += e * e;
            errors.push_back(size);
        }
    }
    found.compared = errors.size();
    if (errors.empty()) return found;
    const auto count = static_cast<double>(errors.size());
    found.mean_error = sum / count;
    found.rms_error = std::sqrt(sum_of_squares / count);
    const auto rank = static_cast<std::ptrdiff_t>(std::ceil(0.999 * count)) - 1;
    std::nth_element(errors.begin(), errors.begin() + rank, errors.end());
    found.percentile_999 = errors[static_cast<std::size_t>(rank)];
    return found;
}

nlohmann::ordered_json comparison_json(const Comparison& comparison) {
    return {{"name", comparison.name},
            {"max_error", comparison.max_error},
            {"column", comparison.column},
            {"row", comparison.row},
            {"percentile_999", comparison.percentile_999},
            {"rms_error", comparison.rms_error},
            {"mean_error", comparison.mean_error},
            {"compared", comparison.compared},
            {"on_edges", comparison.on_edges},
            {"max_error_on_edges", comparison.max_error_on_edges},
            {"not_finite", comparison.not_finite}};
}

}  // namespace aphotic
