// SPDX-License-Identifier: BSD-3-Clause
#include "light/path_table.h"

#include <gtest/gtest.h>

#include <cmath>

namespace aphotic::path_table_test {
namespace {

// A float's rounding, a few times over.
constexpr double kFloatRounding = 4.0 * 0x1p-24;

// Red falls fast, green is two exponentials, blue sees nothing.
SpectralSum two_losses() {
    SpectralSum sum{.K_per_m = Eigen::ArrayXd(2), .weights = Eigen::ArrayXXd::Zero(2, kChannels)};
    sum.K_per_m << 0.05, 1.1;
    sum.weights << 0.0, 2.0, 0.0,  //
        3.0, 5.0, 0.0;
    return sum;
}

// The sum as pen and paper have it.
std::array<double, kChannels> by_hand(double path_m) {
    const double slow = std::exp(-0.05 * path_m);
    const double fast = std::exp(-1.1 * path_m);
    return {3.0 * fast, 2.0 * slow + 5.0 * fast, 0.0};
}

double looked_up(const std::vector<float>& table, const PathSteps& steps, double path_m, int c) {
    const double place = (path_m - steps.first_m) * steps.steps_per_m;
    const int step = std::min(static_cast<int>(place), steps.count - 1);
    const auto at = static_cast<std::size_t>(step) * kTableStride + static_cast<std::size_t>(c);
    const double t = place - step;
    return table[at] + t * (table[at + kTableLanes] +
                            t * (table[at + 2 * kTableLanes] + t * table[at + 3 * kTableLanes]));
}

double worst_error(const PathRange& paths, double error) {
    const SpectralSum sum = two_losses();
    const PathSteps steps = path_steps(sum, paths, error);
    const std::vector<float> table = path_table(sum, steps);
    constexpr int kPoints = 5000;
    double worst = 0.0;
    for (int i = 0; i <= kPoints; ++i) {
        const double path_m =
            std::lerp(paths.shortest_m, paths.longest_m, static_cast<double>(i) / kPoints);
        for (const int c : {0, 1}) {
            const double wanted = by_hand(path_m)[static_cast<std::size_t>(c)];
            worst = std::max(worst, std::abs(looked_up(table, steps, path_m, c) / wanted - 1.0));
        }
    }
    return worst;
}

TEST(PathTable, HoldsItsStatedError) {
    for (const double error : {1e-3, 1e-4, 1e-5, 1e-6}) {
        for (const PathRange paths : {PathRange{0.3, 40.0}, PathRange{2.0, 6.0}}) {
            const double worst = worst_error(paths, error);
            EXPECT_LE(worst, error + kFloatRounding) << error;
            // Nor is the bound so wide that the table is finer than it must be.
            EXPECT_GE(worst, 0.1 * error) << error;
        }
    }
}

TEST(PathTable, IsOneStepInClearWater) {
    SpectralSum sum = two_losses();
    sum.K_per_m.setZero();
    const PathSteps steps = path_steps(sum, {.shortest_m = 1.0, .longest_m = 9000.0}, 1e-6);
    EXPECT_EQ(steps.count, 1);
    const std::vector<float> table = path_table(sum, steps);
    EXPECT_FLOAT_EQ(static_cast<float>(looked_up(table, steps, 4321.0, 1)), 7.0F);
}

TEST(PathTable, ServesOnePathAlone) {
    const PathSteps steps = path_steps(two_losses(), {.shortest_m = 4.0, .longest_m = 4.0}, 1e-6);
    const std::vector<float> table = path_table(two_losses(), steps);
    EXPECT_NEAR(looked_up(table, steps, 4.0, 1) / by_hand(4.0)[1], 1.0, kFloatRounding);
}

TEST(PathTable, HoldsAChannelThatSeesNothingAtNothing) {
    const PathSteps steps = path_steps(two_losses(), {.shortest_m = 1.0, .longest_m = 2.0}, 1e-6);
    const std::vector<float> table = path_table(two_losses(), steps);
    EXPECT_EQ(looked_up(table, steps, 1.5, 2), 0.0);
}

}  // namespace
}  // namespace aphotic::path_table_test
