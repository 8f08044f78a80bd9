// SPDX-License-Identifier: BSD-3-Clause
#include "survey/gaussian_blur.h"

#include <Eigen/Core>

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
    using Samples = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Eigen::Index height = static_cast<Eigen::Index>(plane.size()) / width_px;
    const BoxFilter box = box_of(sigma_px * sigma_px / kBoxes);
    ImagePlane smooth = Eigen::Map<const Samples>(plane.data(), height, width_px).cast<double>();
    smooth_rows(smooth, box);
    ImagePlane turned = smooth.transpose();
    smooth_rows(turned, box);
    std::vector<float> result(plane.size());
    Eigen::Map<Samples>(result.data(), height, width_px) = turned.transpose().cast<float>();
    return result;
}

}  // namespace aphotic
