// SPDX-License-Identifier: BSD-3-Clause
#include "validation/turn_table.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace aphotic {
namespace {

constexpr std::size_t kNodes = 4096;

}  // namespace

TurnTable::TurnTable(const TracedWater& water, double lambda_nm, double least_rad) {
    for (std::size_t i = 0; i < water.phases().size(); ++i) {
        scattering_per_m_ +=
            water.scattering_per_m(i, lambda_nm) * water.phases()[i].share_beyond(least_rad);
    }
    log_step_ = std::log(std::numbers::pi / least_rad) / (kNodes - 1);
    for (std::size_t n = 0; n < kNodes; ++n) {
        const double psi = n + 1 == kNodes
                               ? std::numbers::pi
                               : least_rad * std::exp(static_cast<double>(n) * log_step_);
        double line = 0.0;
        for (std::size_t i = 0; i < water.phases().size(); ++i)
            line += water.scattering_per_m(i, lambda_nm) * water.phases()[i].at(psi);
        angle_rad_.push_back(psi);
        line_.push_back(n + 1 == kNodes ? 0.0 : line * 2.0 * std::numbers::pi * std::sin(psi));
        if (n == 0) {
            share_.push_back(0.0);
        } else {
            share_.push_back(share_[n - 1] +
                             0.5 * (line_[n - 1] + line_[n]) * (angle_rad_[n] - angle_rad_[n - 1]));
        }
    }
    const double whole = share_.back();
    if (!(whole > 0.0)) return;
    for (double& line : line_) line /= whole;
    for (double& share : share_) share /= whole;
}

double TurnTable::density(double psi_rad) const {
    if (psi_rad < angle_rad_.front()) return 0.0;
    const auto at = static_cast<std::size_t>(std::log(psi_rad / angle_rad_.front()) / log_step_);
    const std::size_t n = std::min(at, kNodes - 2);
    const double along = (psi_rad - angle_rad_[n]) / (angle_rad_[n + 1] - angle_rad_[n]);
    // In the last interval the line ends at 0, and so does the sine.
    if (n + 2 == kNodes) return line_[n] / (2.0 * std::numbers::pi * std::sin(angle_rad_[n]));
    return std::lerp(line_[n], line_[n + 1], along) / (2.0 * std::numbers::pi * std::sin(psi_rad));
}

double TurnTable::quantile(double uniform) const {
    const auto above = std::ranges::upper_bound(share_, uniform);
    const auto n = std::min(static_cast<std::size_t>(above - share_.begin()), kNodes - 1) - 1;
    const double width = angle_rad_[n + 1] - angle_rad_[n];
    const double rest = uniform - share_[n];
    // rest = line x + (change / width) x^2 / 2, solved without cancellation.
    const double line = line_[n];
    const double bend = (line_[n + 1] - line) / width;
    const double root = std::sqrt(std::max(0.0, line * line + 2.0 * bend * rest));
    return line + root > 0.0 ? angle_rad_[n] + std::min(2.0 * rest / (line + root), width)
                             : angle_rad_[n];
}

}  // namespace aphotic
