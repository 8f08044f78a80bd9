// SPDX-License-Identifier: BSD-3-Clause
#include "report/plot.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "support/page.h"
#include "support/refusal.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <limits>
#include <regex>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace aphotic::plot_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kDecimals = 0.11;  // coordinates are written to a tenth of a unit

Plot some_plot() {
    return {"Title",
            "wavelength (nm)",
            "value",
            {{"falling", {400.0, 500.0, 600.0}, {1.0, 0.3, 0.001}, 1},
             {"", {400.0, 600.0}, {0.0, kNan}, 0}}};
}

std::vector<Plot> two_panels() {
    return {some_plot(),
            {"Another title",
             "steps",
             "error",
             {{"a line", {1.0, 10.0, 100.0}, {100.0, 41234.0, 0.2}, 2}}}};
}

std::string svg_of(std::span<const Plot> panels) {
    const TempFolder folder;
    write_plots(panels, folder.path() / "a.svg");
    return read_text_file(folder.path() / "a.svg");
}

std::string svg_of(const Plot& plot) {
    return svg_of({&plot, 1});
}

std::size_t files_in(const TempFolder& folder) {
    const std::filesystem::directory_iterator files(folder.path());
    return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

// What the pattern's groups matched, each time.
std::vector<std::vector<double>> numbers_in(const std::string& svg, const std::string& pattern) {
    std::vector<std::vector<double>> all;
    const std::regex regex(pattern);
    for (auto it = std::sregex_iterator(svg.begin(), svg.end(), regex);
         it != std::sregex_iterator();
         ++it) {
        all.emplace_back();
        for (std::size_t i = 1; i < it->size(); ++i) all.back().push_back(std::stod((*it)[i]));
    }
    return all;
}

struct Frame {
    double left, top, right, bottom;
};

std::vector<Frame> frames_in(const std::string& svg) {
    std::vector<Frame> frames;
    for (const auto& f : numbers_in(svg,
                                    "<rect x=\"([0-9.]+)\" y=\"([0-9.]+)\" "
                                    "width=\"([0-9.]+)\" height=\"([0-9.]+)\" class=\"frame\""))
        frames.push_back({f[0], f[1], f[0] + f[2], f[1] + f[3]});
    return frames;
}

// The paths of the curves, without the samples in the legend, which are drawn by h.
std::vector<std::string> curves_in(const std::string& svg) {
    std::vector<std::string> paths;
    const std::regex curve("<path class=\"curve[a-z ]*\" color=\"#[0-9a-f]+\" d=\"([^h\"]*)\"/>");
    for (auto it = std::sregex_iterator(svg.begin(), svg.end(), curve);
         it != std::sregex_iterator();
         ++it)
        paths.push_back((*it)[1]);
    return paths;
}

std::vector<std::vector<double>> points_of(const std::string& path) {
    return numbers_in(path, "[ML]([-0-9.]+) ([-0-9.]+)");
}

TEST(WritePlots, DrawsTheCurveFromCornerToCorner) {
    const std::string svg = svg_of(some_plot());
    const Frame frame = frames_in(svg).at(0);
    const std::vector<std::string> curves = curves_in(svg);
    ASSERT_EQ(curves.size(), 2U);
    const auto points = points_of(curves[0]);
    ASSERT_EQ(points.size(), 3U);
    EXPECT_NEAR(points[0][0], frame.left, kDecimals);
    EXPECT_NEAR(points[0][1], frame.top, kDecimals) << "y from 0 to 1";
    EXPECT_NEAR(points[1][0], (frame.left + frame.right) / 2.0, kDecimals);
    EXPECT_NEAR(points[1][1], std::lerp(frame.bottom, frame.top, 0.3), kDecimals);
    EXPECT_NEAR(points[2][0], frame.right, kDecimals);
    EXPECT_EQ(points_of(curves[1]).size(), 1U) << "a point that is no number";
}

TEST(WritePlots, DrawsALogarithmicAxis) {
    Plot plot = some_plot();
    plot.log_y = true;
    const std::string svg = svg_of(plot);
    const Frame frame = frames_in(svg).at(0);
    const std::vector<std::string> curves = curves_in(svg);
    const auto points = points_of(curves.at(0));
    EXPECT_NEAR(points.at(0)[1], frame.top, kDecimals);
    EXPECT_NEAR(points.at(1)[1],
                std::lerp(frame.top, frame.bottom, std::log10(0.3) / std::log10(0.001)),
                kDecimals);
    EXPECT_NEAR(points.at(2)[1], frame.bottom, kDecimals);
    EXPECT_TRUE(points_of(curves.at(1)).empty()) << "its only point is at 0";
}

// A square stays one, and a tall or flat one is whole.
TEST(WritePlots, EqualAxesKeepShapes) {
    for (const auto& [width, height] : {std::pair{1.0, 1.0}, {0.1, 3.0}, {300.0, 1.0}}) {
        const Plot plot{.title = "shape",
                        .x_label = "x",
                        .y_label = "y",
                        .curves = {{"", {0.0, width, width}, {0.0, 0.0, height}}},
                        .equal_axes = true};
        const std::string svg = svg_of(plot);
        const Frame frame = frames_in(svg).at(0);
        const auto points = points_of(curves_in(svg).at(0));
        ASSERT_EQ(points.size(), 3U);
        const double width_px = points[1][0] - points[0][0];
        const double height_px = points[1][1] - points[2][1];
        EXPECT_NEAR(
            width_px * height, height_px * width, 2.0 * kDecimals * std::max(width, height));
        for (const auto& point : points) {
            EXPECT_GE(point[0], frame.left - kDecimals);
            EXPECT_LE(point[0], frame.right + kDecimals);
            EXPECT_GE(point[1], frame.top - kDecimals);
            EXPECT_LE(point[1], frame.bottom + kDecimals);
        }
    }
}

TEST(WritePlots, DashesTheCurve) {
    Plot plot = some_plot();
    EXPECT_FALSE(contains(svg_of(plot), "class=\"curve dashed\""));
    plot.curves[0].dashed = true;
    EXPECT_TRUE(contains(svg_of(plot), "class=\"curve dashed\""));
}

TEST(WritePlots, IsWellFormedAndShowsEveryTextAsText) {
    Plot plot = some_plot();
    plot.title = plot.x_label = plot.y_label = plot.curves[0].label = "<script>'\"&";
    const std::string svg = svg_of(plot);
    EXPECT_EQ(first_unbalanced(svg), "");
    EXPECT_FALSE(contains(svg, "<script"));
    EXPECT_EQ(numbers_in(svg, "y=\"([0-9.]+)\"[^>]*>&lt;script&gt;&#39;&quot;&amp;</text>").size(),
              3U)
        << "title, legend and x label";
    EXPECT_TRUE(contains(svg, "rotate(-90)\" text-anchor=\"middle\" class=\"axis\">&lt;script"));
}

TEST(WritePlots, IsWrittenForFlatCurvesAndSinglePoints) {
    for (const bool log_y : {false, true}) {
        for (const double y : {0.0, 1.0, -3.0, 1e-300, 1e300}) {
            if (log_y && y <= 0.0) continue;
            Plot plot = some_plot();
            plot.log_y = log_y;
            plot.curves = {{"", {500.0}, {y}}};
            const std::string svg = svg_of(plot);
            const Frame frame = frames_in(svg).at(0);
            const auto point = points_of(curves_in(svg).at(0)).at(0);
            EXPECT_GT(point[0], frame.left) << y;
            EXPECT_LT(point[0], frame.right) << y;
            EXPECT_GE(point[1], frame.top) << y;
            EXPECT_LE(point[1], frame.bottom) << y;
            EXPECT_FALSE(contains(svg, "nan")) << y;
        }
    }
}

TEST(WritePlots, DrawsMarksInsideTheAxisAndBehindTheCurves) {
    Plot plot = some_plot();
    plot.marks_x = {399.0, 601.0, -450.0, kNan, 450.0};
    const std::string svg = svg_of(plot);
    const Frame frame = frames_in(svg).at(0);
    const auto marks = numbers_in(svg,
                                  "<line x1=\"([0-9.]+)\" y1=\"([0-9.]+)\" x2=\"([0-9.]+)\" "
                                  "y2=\"([0-9.]+)\" class=\"guide\"");
    ASSERT_EQ(marks.size(), 1U);
    EXPECT_NEAR(marks[0][0], std::lerp(frame.left, frame.right, 0.25), kDecimals);
    EXPECT_EQ(marks[0][0], marks[0][2]);
    EXPECT_NEAR(marks[0][1], frame.top, kDecimals);
    EXPECT_NEAR(marks[0][3], frame.bottom, kDecimals);
    EXPECT_LT(svg.find("class=\"guide\""), svg.find("d=\"" + curves_in(svg).at(0)));
}

TEST(WritePlots, PutsPanelsOneAboveTheOtherWithAlignedFrames) {
    const std::vector<Plot> panels = two_panels();
    const std::string svg = svg_of(panels);
    const std::vector<Frame> frames = frames_in(svg);
    ASSERT_EQ(frames.size(), 2U);
    EXPECT_EQ(frames[0].left, frames[1].left);
    EXPECT_EQ(frames[0].right, frames[1].right);
    EXPECT_LT(frames[0].bottom, frames[1].top);
    const auto size = numbers_in(svg, "viewBox=\"0 0 ([0-9]+) ([0-9]+)\"").at(0);
    EXPECT_LT(frames[1].right, size[0]);
    EXPECT_LT(frames[1].bottom, size[1]);
    for (const char* text : {">Title<", ">steps<", ">error<", ">a line<", ">falling<"})
        EXPECT_TRUE(contains(svg, text)) << text;
}

// Rows of legends and long titles take room, and no more than there is.
TEST(WritePlots, MakesRoomForItsLegendAndSmallerLettersForLongTexts) {
    Plot plot = some_plot();
    const double top = frames_in(svg_of(plot)).at(0).top;
    plot.curves.resize(10, plot.curves[0]);
    for (PlotCurve& curve : plot.curves) curve.label = "a curve with a name of some length";
    const Frame frame = frames_in(svg_of(plot)).at(0);
    EXPECT_GT(frame.top, top + 40.0);
    EXPECT_GT(frame.bottom, frame.top + 200.0);
    EXPECT_FALSE(contains(svg_of(plot), "font-size: 1.")) << "style attributes begin so";
    plot.title = std::string(300, 'm');
    const auto fitted = numbers_in(svg_of(plot), "style=\"font-size: ([0-9.]+)px\">mmm");
    ASSERT_EQ(fitted.size(), 1U);
    constexpr double kWidestLetter = 1.0;  // of a bold m, in font sizes
    EXPECT_LT(300 * kWidestLetter * fitted[0][0], 1.7 * (frame.right - frame.left));
}

TEST(WritePlots, WritesTheSamePictureTwice) {
    EXPECT_EQ(svg_of(two_panels()), svg_of(two_panels()));
}

TEST(WritePlots, RefusesOtherExtensionsAndNamesItsOwn) {
    const TempFolder folder;
    for (const char* name : {"a.png", "a.jpg", "a", "a.SVG"}) {
        const std::string said =
            refusal_of([&] { write_plots(two_panels(), folder.path() / name); });
        EXPECT_TRUE(contains(said, name)) << said;
        EXPECT_TRUE(contains(said, "allowed: .svg")) << said;
    }
    EXPECT_THROW(write_plots({}, folder.path() / "a.svg"), InputError);
    EXPECT_EQ(files_in(folder), 0U);
}

TEST(WritePlots, RefusesAPanelWithoutPointsAndNamesIt) {
    const TempFolder folder;
    std::vector<Plot> panels = two_panels();
    panels[1].curves[0].y = {kNan, kNan, kNan};
    const std::string said = refusal_of([&] { write_plots(panels, folder.path() / "a.svg"); });
    EXPECT_TRUE(contains(said, "Another title")) << said;
    panels = two_panels();
    panels[0].log_y = true;
    panels[0].curves = {{"", {500.0}, {-1.0}}};
    EXPECT_THROW(write_plots(panels, folder.path() / "a.svg"), InputError);
    EXPECT_EQ(files_in(folder), 0U);
}

TEST(WritePlots, SaysWhenTheFileCannotBeWritten) {
    const TempFolder folder;
    EXPECT_THROW(write_plots(two_panels(), folder.path() / "none" / "a.svg"), RunError);
}

TEST(PagePlot, HasNeitherStyleNorTitleAndDrawsDotsWithoutALine) {
    constexpr double kHeight = 300.0;
    Plot plot = some_plot();
    plot.curves[0].dots = true;
    const std::string svg = page_plot("an-id", {&plot, 1}, kHeight);
    EXPECT_TRUE(contains(svg, "id=\"an-id\"")) << svg;
    EXPECT_TRUE(contains(svg, "class=\"dots\""));
    EXPECT_FALSE(contains(svg, "<style>"));
    EXPECT_FALSE(contains(svg, ">Title<"));
    EXPECT_EQ(curves_in(svg).size(), 1U) << "the other curve";
    EXPECT_LT(frames_in(svg).at(0).bottom, kHeight);
}

TEST(PagePlot, StartsAtZeroWhereAsked) {
    Plot plot{"", "x", "y", {{"", {0.0, 1.0}, {9.0, 10.0}, 0}}};
    plot.from_zero = true;
    const std::string svg = page_plot("p", {&plot, 1}, 300.0);
    const Frame frame = frames_in(svg).at(0);
    const auto points = points_of(curves_in(svg).at(0));
    EXPECT_NEAR(points[0][1], std::lerp(frame.bottom, frame.top, 0.9), kDecimals);
    EXPECT_NEAR(points[1][1], frame.top, kDecimals);
}

}  // namespace
}  // namespace aphotic::plot_test
