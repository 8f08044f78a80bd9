// SPDX-License-Identifier: BSD-3-Clause
#include "survey/slow_light.h"

#include <Eigen/Core>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace aphotic {

namespace {

constexpr int kBoxes = 5;

using ImagePlane = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// 2 radius + 1 samples of weight 1, and one of weight `end` on either side of them.
struct BoxFilter {
    int radius = 0;
    double end = 0.0;

    [[nodiscard]] double weight() const { return 2.0 * radius + 1.0 + 2.0 * end; }
};

// The longest box of whole samples whose variance is not above the wanted one, (L^2 - 1) / 12; its
// ends make up what is missing.
BoxFilter box_of(double variance) {
    BoxFilter box{.radius = static_cast<int>((std::sqrt(12.0 * variance + 1.0) - 1.0) / 2.0)};
    const double r = box.radius;
    box.end = (2.0 * r + 1.0) * (r * (r + 1.0) - 3.0 * variance) /
              (6.0 * (variance - (r + 1.0) * (r + 1.0)));
    return box;
}

// Where the sample `at` of the mirrored line stands in the line itself.
std::ptrdiff_t mirrored(std::ptrdiff_t at, std::ptrdiff_t length) {
    const std::ptrdiff_t in_period = ((at % (2 * length)) + 2 * length) % (2 * length);
    return in_period < length ? in_period : 2 * length - 1 - in_period;
}

void smooth_line(std::span<double> line, const BoxFilter& box, std::vector<double>& padded) {
    const auto length = static_cast<std::ptrdiff_t>(line.size());
    const std::ptrdiff_t pad = box.radius + 1;
    padded.resize(static_cast<std::size_t>(length + 2 * pad));
    for (std::ptrdiff_t i = -pad; i < length + pad; ++i)
        padded[static_cast<std::size_t>(i + pad)] =
            line[static_cast<std::size_t>(mirrored(i, length))];
    const auto width = static_cast<std::size_t>(2 * pad);
    double sum = std::accumulate(padded.begin() + 1, padded.begin() + 2 * pad, 0.0);
    for (std::size_t i = 0; i < line.size(); ++i) {
        line[i] = (sum + box.end * (padded[i] + padded[i + width])) / box.weight();
        sum += padded[i + width] - padded[i + 1];
    }
}

void smooth_rows(ImagePlane& plane, const BoxFilter& box) {
    std::vector<double> padded;
    for (Eigen::Index row = 0; row < plane.rows(); ++row) {
        const std::span line(plane.row(row).data(), static_cast<std::size_t>(plane.cols()));
        for (int pass = 0; pass < kBoxes; ++pass) smooth_line(line, box, padded);
    }
}

}  // namespace

std::vector<float> gaussian_blur(std::span<const float> plane, int width_px, double sigma_px) {
    using FloatPlane = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Eigen::Index height = static_cast<Eigen::Index>(plane.size()) / width_px;
    const BoxFilter box = box_of(sigma_px * sigma_px / kBoxes);
    ImagePlane smooth = Eigen::Map<const FloatPlane>(plane.data(), height, width_px).cast<double>();
    smooth_rows(smooth, box);
    ImagePlane turned = smooth.transpose();
    smooth_rows(turned, box);
    std::vector<float> result(plane.size());
    Eigen::Map<FloatPlane>(result.data(), height, width_px) = turned.transpose().cast<float>();
    return result;
}

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
