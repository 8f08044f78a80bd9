// SPDX-License-Identifier: BSD-3-Clause
//
// How many random cases a test looks at, and how large its images are. In debug builds, which are
// there for the sanitizers and take ten times as long, it is enough that every line runs.
#pragma once

#include <algorithm>
#include <cstdlib>

namespace aphotic {

[[nodiscard]] constexpr int cases(int count) {
#ifdef NDEBUG
    return count;
#else
    constexpr int kShare = 30;
    return std::max(std::min(count, 2), count / kShare);
#endif
}

// Whether this is scripts/night, which has the hours that CI has not.
[[nodiscard]] inline bool is_night() {
    return std::getenv("APHOTIC_NIGHT") != nullptr;  // NOLINT(concurrency-mt-unsafe)
}

// The cases of a campaign: few in CI, all of them in the night, and as many as APHOTIC_CASES says
// where it is set.
[[nodiscard]] inline int campaign(int few, int all) {
    const char* asked = std::getenv("APHOTIC_CASES");  // NOLINT(concurrency-mt-unsafe)
    if (asked != nullptr) return std::atoi(asked);     // NOLINT(cert-err34-c)
    return is_night() ? all : cases(few);
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
