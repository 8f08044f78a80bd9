// SPDX-License-Identifier: BSD-3-Clause
#include "base/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace aphotic {

ProgressLine::ProgressLine()
    : start_(std::chrono::steady_clock::now()), is_terminal_(::isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
    wipe();
}

void ProgressLine::wipe() {
    if (shown_) fmt::print(stderr, "\r\033[K");
    shown_ = false;
}

void ProgressLine::show(std::string_view what, double share) {
    constexpr double kPatienceS = 1.0;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    if (!is_terminal_ || elapsed.count() < kPatienceS) return;
    shown_ = true;
    std::string left;
    if (share > 0.0) {
        const auto seconds = std::lround(elapsed.count() * (1.0 - share) / share);
        left = fmt::format(", {}:{:02} left", seconds / 60, seconds % 60);
    }
    fmt::print(stderr, "\r\033[K{}  {:.0f} %{}", what, 100.0 * share, left);
    std::fflush(stderr);
}

}  // namespace aphotic
