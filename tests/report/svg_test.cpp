// SPDX-License-Identifier: BSD-3-Clause
#include "report/svg.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace aphotic::svg_test {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kRounding = 1e-12;

SvgPanel panel_of(SvgAxis x, SvgAxis y) {
    return {.left = 100.0,
            .top = 50.0,
            .width = 200.0,
            .height = 80.0,
            .x = std::move(x),
            .y = std::move(y)};
}

TEST(SvgPanel, PutsTheAxesEndsAtItsCorners) {
    const SvgPanel panel = panel_of(linear_axis(-1.0, 3.0, 4), linear_axis(0.0, 10.0, 5));
    EXPECT_EQ(panel.x_px(-1.0), 100.0);
    EXPECT_EQ(panel.x_px(3.0), 300.0);
    EXPECT_EQ(panel.x_px(0.0), 150.0);
    EXPECT_EQ(panel.y_px(0.0), 130.0) << "upwards";
    EXPECT_EQ(panel.y_px(10.0), 50.0);
}

TEST(SvgPanel, SpacesALogarithmicAxisByFactors) {
    const SvgPanel panel = panel_of(linear_axis(0.0, 1.0, 4), log_axis(1e-4, 1e-2));
    EXPECT_NEAR(panel.y_px(1e-3), 90.0, kRounding * 90.0);
    EXPECT_TRUE(std::isnan(panel.y_px(0.0)));
    EXPECT_TRUE(std::isnan(panel.y_px(-1.0)));
}

TEST(LinearAxis, HasTicksAtRoundNumbersUpToItsEnds) {
    const SvgAxis axis = linear_axis(-4e-4, 4e-4, 4, -4);
    ASSERT_EQ(axis.ticks.size(), 5U);
    const std::array<const char*, 5> labels{"−4", "−2", "0", "2", "4"};
    for (std::size_t i = 0; i < labels.size(); ++i) EXPECT_EQ(axis.ticks[i].label, labels[i]);
    EXPECT_NEAR(axis.ticks[4].value, 4e-4, kRounding);
}

TEST(LogAxis, EndsAtRoundNumbersAroundItsValues) {
    const SvgAxis axis = log_axis(1.3e-4, 6e-4);
    EXPECT_NEAR(axis.first, 1e-4, kRounding);
    EXPECT_NEAR(axis.last, 1e-3, kRounding);
    ASSERT_EQ(axis.ticks.size(), 4U) << "1, 2, 5 and 10 times 1e-4";
    EXPECT_EQ(axis.ticks[0].label, "10⁻⁴");
    EXPECT_EQ(axis.ticks[2].label,
              "5\xC2\xA0×\xC2\xA0"
              "10⁻⁴");
}

TEST(LogAxis, LabelsOnlyPowersOfTenOverManyDecades) {
    const SvgAxis axis = log_axis(1e-5, 0.4);
    EXPECT_NEAR(axis.first, 1e-5, kRounding);
    EXPECT_NEAR(axis.last, 0.5, kRounding);
    EXPECT_EQ(axis.ticks[1].label, "");
    EXPECT_EQ(axis.ticks[3].label, "10⁻⁴");
}

TEST(RoundUp, IsNeverUnderTheValue) {
    EXPECT_NEAR(round_up(3.2e-4), 4e-4, kRounding);
    EXPECT_NEAR(round_up(4e-4), 4e-4, kRounding);
    EXPECT_NEAR(round_up(8.1), 10.0, kRounding);
    EXPECT_NEAR(round_up(1000.0), 1000.0, kRounding);
    for (double value = 1e-6; value < 10.0; value *= 1.01) EXPECT_GE(round_up(value), value);
}

TEST(SvgCurve, IsBrokenWhereThereIsNoNumber) {
    const SvgPanel panel = panel_of(linear_axis(0.0, 4.0, 4), linear_axis(0.0, 1.0, 4));
    const std::array<double, 5> x{0.0, 1.0, 2.0, 3.0, 4.0};
    const std::array<double, 5> y{0.0, 1.0, kNaN, 0.5, 0.0};
    EXPECT_EQ(svg_curve(panel, x, y, R"(class="a")"),
              R"(<path class="a" d="M100.0 130.0L150.0 50.0M250.0 90.0L300.0 130.0"/>)");
    EXPECT_EQ(svg_dots(panel, x, y, R"(class="a")"),
              R"(<path stroke-linecap="round" class="a" )"
              R"(d="M100.0 130.0h0M150.0 50.0h0M250.0 90.0h0M300.0 130.0h0"/>)");
}

TEST(SvgText, IsEscaped) {
    EXPECT_EQ(svg_text(1.0, 2.0, SvgAnchor::End, R"(class="a")", "<b>"),
              R"(<text x="1.0" y="2.0" text-anchor="end" class="a">&lt;b&gt;</text>)");
}

}  // namespace
}  // namespace aphotic::svg_test
