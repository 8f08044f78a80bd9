// SPDX-License-Identifier: BSD-3-Clause
//
// The single factor between an image and its reference, for images of unknown exposure.
//
//   scale = sum a b / sum b^2       the least squares of  a = scale b
//
// a, b  samples of image and reference, of one channel or of all
//
// The image may be noisy, and the reference is taken as exact: noise of mean 0 in a does not bias
// the scale. Bright samples have the most weight. An image that is k times its reference has scale
// k.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

namespace aphotic {

class Scaling {
  public:
    // marks: as for compare_planes(). Samples that are marked or not finite are ignored.
    void add(std::span<const float> a,
             std::span<const float> b,
             std::span<const unsigned char> marks) {
        for (std::size_t i = 0; i < a.size(); ++i) {
            const bool is_marked = !marks.empty() && marks[i] != 0;
            if (is_marked || !std::isfinite(a[i]) || !std::isfinite(b[i])) continue;
            products_ += static_cast<double>(a[i]) * b[i];
            squares_ += static_cast<double>(b[i]) * b[i];
        }
    }

    // 0 if no usable sample was added.
    [[nodiscard]] double scale() const { return squares_ > 0.0 ? products_ / squares_ : 0.0; }

  private:
    double products_ = 0.0;
    double squares_ = 0.0;
};

}  // namespace aphotic
