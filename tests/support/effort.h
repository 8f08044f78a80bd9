// SPDX-License-Identifier: BSD-3-Clause
//
// How many random cases a test looks at, and how large its images are. In debug builds, which are
// there for the sanitizers and take ten times as long, it is enough that every line runs.
#pragma once

#include <algorithm>

namespace aphotic {

[[nodiscard]] constexpr int cases(int count) {
#ifdef NDEBUG
    return count;
#else
    constexpr int kShare = 30;
    return std::max(std::min(count, 2), count / kShare);
#endif
}

// Along a side.
[[nodiscard]] constexpr int pixels(int count) {
#ifdef NDEBUG
    return count;
#else
    constexpr int kShare = 3;
    constexpr int kLeast = 32;
    return std::max(std::min(count, kLeast), count / kShare);
#endif
}

}  // namespace aphotic
