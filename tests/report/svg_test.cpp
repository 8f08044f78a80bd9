// SPDX-License-Identifier: BSD-3-Clause
#include "report/svg.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>

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
    const SvgAxis axis = linear_axis(-4e-4, 4e-4, 4);
    ASSERT_EQ(axis.ticks.size(), 5U);
    const std::array<const char*, 5> labels{"−4", "−2", "0", "2", "4"};
    for (std::size_t i = 0; i < labels.size(); ++i) EXPECT_EQ(axis.ticks[i].label, labels[i]);
    EXPECT_NEAR(axis.ticks[4].value, 4e-4, kRounding);
    EXPECT_EQ(axis.in_unit("e"), "e / 10⁻⁴");
}

TEST(LinearAxis, WritesOutNumbersOfOrdinarySize) {
    for (const double last : {0.02, 1.0, 5000.0, 60000.0}) {
        const SvgAxis axis = linear_axis(0.0, last, 5);
        EXPECT_EQ(axis.in_unit("x"), "x");
        EXPECT_EQ(axis.ticks.at(1).value, std::stod(axis.ticks.at(1).label)) << last;
    }
}

TEST(LinearAxisAround, EndsAtTicks) {
    for (const auto& [least, most, first, last] :
         {std::array{0.05, 1.15, 0.0, 1.2}, std::array{1.32, 1.349, 1.32, 1.35}}) {
        const SvgAxis axis = linear_axis_around(least, most, 6);
        EXPECT_NEAR(axis.first, first, kRounding);
        EXPECT_NEAR(axis.last, last, kRounding);
        EXPECT_NEAR(axis.ticks.front().value, first, kRounding);
        EXPECT_NEAR(axis.ticks.back().value, last, kRounding);
    }
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

TEST(LogAxis, HasARangeOfItsOwnForOneValue) {
    for (const double value : {1e-300, 1.0, 3.0, 1e300}) {
        const SvgAxis axis = log_axis(value, value);
        EXPECT_LE(axis.first, value);
        EXPECT_GE(axis.last, value);
        EXPECT_LT(axis.first, axis.last);
    }
}

TEST(LogAxis, HasNoMoreLabelsThanAsked) {
    for (const double most : {1.5, 40.0, 1e5, 1e30, 1e250}) {
        std::size_t labels = 0;
        for (const SvgTick& tick : log_axis(1.0, most, 7).ticks)
            labels += tick.label.empty() ? 0 : 1;
        EXPECT_GE(labels, 1U) << most;
        EXPECT_LE(labels, 7U) << most;
    }
    EXPECT_EQ(log_axis(0.02, 50.0, 12).ticks.at(1).label, "0.05")
        << "no power where none is needed";
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

TEST(SvgFit, MakesLongTextsSmaller) {
    EXPECT_EQ(svg_fit("short", 12.0, 100.0), "");
    EXPECT_EQ(svg_fit(std::string(100, 'a'), 12.0, text_width(std::string(100, 'a'), 6.0)),
              " style=\"font-size: 6.00px\"");
    EXPECT_GT(text_width("深海", 12.0), text_width("ab", 12.0));
    EXPECT_EQ(text_width("ö", 12.0), text_width("o", 12.0));
}

double linear(double srgb) {
    return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

// CIE XYZ under D65 (IEC 61966-2-1).
std::array<double, 3> xyz_of(std::string_view tone) {
    const long rgb = std::stol(std::string(tone.substr(1)), nullptr, 16);
    const auto channel = [&](unsigned shift) {
        return linear(static_cast<double>(rgb >> shift & 0xFF) / 255.0);
    };
    const double r = channel(16), g = channel(8), b = channel(0);
    return {0.4124 * r + 0.3576 * g + 0.1805 * b,
            0.2126 * r + 0.7152 * g + 0.0722 * b,
            0.0193 * r + 0.1192 * g + 0.9505 * b};
}

// CIE 1976 colour difference.
double colour_difference(std::string_view a, std::string_view b) {
    const auto lab_of = [](std::string_view colour) -> std::array<double, 3> {
        const auto xyz = xyz_of(colour);
        const auto white = xyz_of("#ffffff");
        std::array<double, 3> f{};
        for (std::size_t i = 0; i < 3; ++i) {
            const double t = xyz[i] / white[i];
            f[i] = t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116.0;
        }
        return {116.0 * f[1] - 16.0, 500.0 * (f[0] - f[1]), 200.0 * (f[1] - f[2])};
    };
    const auto m = lab_of(a), n = lab_of(b);
    return std::hypot(m[0] - n[0], m[1] - n[1], m[2] - n[2]);
}

TEST(Tones, IsLegibleOnWhite) {
    constexpr double kLeastContrast = 3.0;  // WCAG 2.1, 1.4.11: graphics
    for (std::size_t i = 0; i < kTones.size(); ++i) {
        EXPECT_GE(1.05 / (xyz_of(kTones[i])[1] + 0.05), kLeastContrast) << i;
    }
}

TEST(Tones, KeepsItsColoursApart) {
    constexpr double kPlainlyDifferent = 25.0;  // ten times what is just seen, about 2.3
    for (std::size_t i = 0; i < kTones.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            EXPECT_GE(colour_difference(kTones[i], kTones[j]), kPlainlyDifferent)
                << i << " and " << j;
        }
    }
}

}  // namespace
}  // namespace aphotic::svg_test
