// SPDX-License-Identifier: BSD-3-Clause
#include "survey/slow_light.h"

#include "survey/gaussian_blur.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace aphotic {
namespace {

double mean_of(std::span<const float> plane) {
    return std::accumulate(plane.begin(), plane.end(), 0.0) / static_cast<double>(plane.size());
}

}  // namespace

std::vector<float> divided_by_pattern(std::span<const float> plane,
                                      std::span<const float> pattern) {
    assert(plane.size() == pattern.size());
    const double mean = mean_of(pattern);
    std::vector<float> result(plane.begin(), plane.end());
    if (!(mean > 0.0)) return result;  // no light, no pattern
    for (std::size_t i = 0; i < plane.size(); ++i) {
        const double light = std::max<double>(pattern[i], kLeastShare * mean);
        result[i] = static_cast<float>(plane[i] / light * mean);
    }
    return result;
}

std::vector<float> illumination_reflectance(std::span<const float> plane,
                                            int width_px,
                                            double sigma_px) {
    return divided_by_pattern(plane, gaussian_blur(plane, width_px, sigma_px));
}

std::vector<float> homomorphic(std::span<const float> plane,
                               int width_px,
                               const Homomorphic& filter) {
    std::vector<float> result = logarithms(plane);
    const double mean = mean_of(result);
    const std::vector<float> slow = gaussian_blur(result, width_px, filter.sigma_px);
    for (std::size_t i = 0; i < plane.size(); ++i) {
        const double log_out =
            mean + filter.low * (slow[i] - mean) + filter.high * (result[i] - slow[i]);
        result[i] = static_cast<float>(std::exp(log_out));
    }
    return result;
}

std::vector<float> logarithms(std::span<const float> plane) {
    const double black = kBlackShare * mean_of(plane);
    std::vector<float> logs(plane.size(), 0.0F);
    if (!(black > 0.0)) return logs;
    std::ranges::transform(plane, logs.begin(), [&](float sample) {
        return static_cast<float>(std::log(std::max<double>(sample, black)));
    });
    return logs;
}

std::vector<float> exponentials(std::span<const float> plane) {
    std::vector<float> result(plane.size());
    std::ranges::transform(plane, result.begin(), [](float log) { return std::exp(log); });
    return result;
}

}  // namespace aphotic
