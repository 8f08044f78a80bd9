// SPDX-License-Identifier: BSD-3-Clause
#include "validation/scaling.h"

#include <cmath>
#include <cstddef>

namespace aphotic {

void Scaling::add(std::span<const float> a,
                  std::span<const float> b,
                  std::span<const unsigned char> marks) {
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (!marks.empty() && marks[i] != 0) continue;
        if (!std::isfinite(a[i]) || !std::isfinite(b[i])) continue;
        products_ += static_cast<double>(a[i]) * b[i];
        squares_ += static_cast<double>(b[i]) * b[i];
    }
}

}  // namespace aphotic
