// SPDX-License-Identifier: BSD-3-Clause
#include "light/path_table.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aphotic {
namespace {

using Eigen::Array3d;
using Eigen::ArrayXd;

// sum_j w_cj K_j^power exp(-(K_j - K_0) l). Eigen's exponential never goes below e^-709.8.
Array3d moment(const SpectralSum& sum, double path_m, int power, double K_0_per_m) {
    constexpr double kBlackDepth = 700.0;
    const ArrayXd depth = (sum.K_per_m - K_0_per_m) * path_m;
    const ArrayXd left = (depth < kBlackDepth).select((-depth).exp(), 0.0);
    // Eigen's powers of 0 and 1 are as slow as any, and the table needs only these.
    ArrayXd scaled = left;
    if (power == 1) scaled *= sum.K_per_m;
    if (power > 1) scaled *= sum.K_per_m.pow(power);
    return (sum.weights.transpose().matrix() * scaled.matrix()).array();
}

// The longest step whose bound meets the error, for one channel.
double longest_step_m(double m_1, double m_4, double error) {
    constexpr double kHermite = 384.0;
    double step_m = std::pow(kHermite * error / m_4, 0.25);
    while (std::pow(step_m, 4) / kHermite * m_4 * std::exp(step_m * m_1) > error) {
        constexpr double kShorter = 0.98;
        step_m *= kShorter;
    }
    return step_m;
}

}  // namespace

SpectralSum spectral_sum(const Water& water,
                         std::span<const WeightedWavelength> grid,
                         const LightOf& light) {
    const auto count = static_cast<Eigen::Index>(grid.size());
    SpectralSum sum{.K_per_m = Eigen::ArrayXd(count), .weights = Eigen::ArrayXXd(count, kChannels)};
    for (Eigen::Index i = 0; i < count; ++i) {
        const WeightedWavelength& node = grid[static_cast<std::size_t>(i)];
        sum.K_per_m(i) = water.attenuation_per_m(node.lambda_nm);
        const double value = light(node.lambda_nm);
        for (Eigen::Index c = 0; c < kChannels; ++c)
            sum.weights(i, c) = node.weight[static_cast<std::size_t>(c)] * value;
    }
    return sum;
}

PathSteps path_steps(const SpectralSum& sum, const PathRange& paths, double error) {
    // Scaled by the least loss, since long paths would otherwise underflow.
    const double K_0_per_m = sum.K_per_m.minCoeff();
    const Array3d total = moment(sum, paths.shortest_m, 0, K_0_per_m);
    const Array3d first = moment(sum, paths.shortest_m, 1, K_0_per_m);
    const Array3d fourth = moment(sum, paths.shortest_m, 4, K_0_per_m);
    double step_m = std::numeric_limits<double>::infinity();
    for (Eigen::Index c = 0; c < kChannels; ++c) {
        if (fourth(c) <= 0.0) continue;  // clear water, or a channel that sees nothing
        step_m = std::min(step_m, longest_step_m(first(c) / total(c), fourth(c) / total(c), error));
    }
    const double length_m = std::max(paths.longest_m - paths.shortest_m,
                                     paths.shortest_m * std::numeric_limits<float>::epsilon());
    const int count = std::max(1, static_cast<int>(std::ceil(length_m / step_m)));
    return {.first_m = paths.shortest_m, .steps_per_m = count / length_m, .count = count};
}

std::vector<float> path_table(const SpectralSum& sum, const PathSteps& steps) {
    std::vector<float> table(static_cast<std::size_t>(steps.count) * kTableStride, 0.0F);
    const double step_m = 1.0 / steps.steps_per_m;
    Array3d value = moment(sum, steps.first_m, 0, 0.0);
    Array3d slope = -step_m * moment(sum, steps.first_m, 1, 0.0);
    auto at = table.begin();
    for (int i = 1; i <= steps.count; ++i) {
        const double path_m = steps.first_m + i * step_m;
        const Array3d next = moment(sum, path_m, 0, 0.0);
        const Array3d next_slope = -step_m * moment(sum, path_m, 1, 0.0);
        const Array3d rise = next - value;
        for (const Array3d& coefficient : {value,
                                           slope,
                                           Array3d(3.0 * rise - 2.0 * slope - next_slope),
                                           Array3d(slope + next_slope - 2.0 * rise)}) {
            std::copy(coefficient.begin(), coefficient.end(), at);
            at += kTableLanes;
        }
        value = next;
        slope = next_slope;
    }
    return table;
}

PathSignal signal_at(const std::vector<float>& table, const PathSteps& steps, double path_m) {
    const double place = (path_m - steps.first_m) * steps.steps_per_m;
    const int step = std::clamp(static_cast<int>(place), 0, steps.count - 1);
    const double t = place - step;
    const float* const cubic = &table[static_cast<std::size_t>(step) * kTableStride];
    PathSignal signal;
    for (std::size_t c = 0; c < kChannels; ++c) {
        const std::array<double, kTableOrder> a{cubic[c],
                                                cubic[c + kTableLanes],
                                                cubic[c + 2 * kTableLanes],
                                                cubic[c + 3 * kTableLanes]};
        signal.value[c] = a[0] + t * (a[1] + t * (a[2] + t * a[3]));
        signal.slope[c] = steps.steps_per_m * (a[1] + t * (2.0 * a[2] + t * 3.0 * a[3]));
    }
    return signal;
}

}  // namespace aphotic
