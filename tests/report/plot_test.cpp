// SPDX-License-Identifier: BSD-3-Clause
#include "report/plot.h"

#include "base/error.h"
#include "tests/support/temp_folder.h"

#include <cairo.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <vector>

namespace aphotic::plot_test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Plot some_plot() {
    return {"Title",
            "wavelength (nm)",
            "value",
            {{"falling", {400.0, 500.0, 600.0}, {1.0, 0.3, 0.001}, kPlotRed},
             {"", {400.0, 600.0}, {0.0, kNan}, kPlotBlue}}};
}

std::string content_of(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::size_t files_in(const TempFolder& folder) {
    const std::filesystem::directory_iterator files(folder.path());
    return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

constexpr int kWidth_px = 1920;
constexpr int kPanelHeight_px = 1200;
constexpr double kHalfPixel = 0.5;  // edges are antialiased

struct Pixel {
    unsigned char blue, green, red, unused;

    bool operator==(const Pixel& other) const {
        return red == other.red && green == other.green && blue == other.blue;
    }
    // Antialiased edges are passed over.
    [[nodiscard]] bool is_about(PlotColour colour) const {
        const auto near = [](unsigned char found, double wanted) {
            return std::abs(found - 255.0 * wanted) <= 1.0;
        };
        return near(red, colour.red) && near(green, colour.green) && near(blue, colour.blue);
    }
    // 0 white, 1 black.
    [[nodiscard]] double darkness() const { return 1.0 - (red + green + blue) / (3.0 * 255.0); }
};

struct Picture {
    int width = 0;
    int height = 0;
    std::vector<Pixel> pixels;

    [[nodiscard]] const Pixel& at(int x, int y) const {
        return pixels.at(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                         static_cast<std::size_t>(x));
    }
    [[nodiscard]] std::vector<Pixel> rows(int first, int count) const {
        return {&at(0, first), &at(width - 1, first + count - 1) + 1};
    }
};

Picture picture_in(const std::filesystem::path& file) {
    cairo_surface_t* surface = cairo_image_surface_create_from_png(file.c_str());
    Picture picture{
        cairo_image_surface_get_width(surface), cairo_image_surface_get_height(surface), {}};
    const int stride = cairo_image_surface_get_stride(surface);
    const unsigned char* data = cairo_image_surface_get_data(surface);
    picture.pixels.reserve(static_cast<std::size_t>(picture.width) *
                           static_cast<std::size_t>(picture.height));
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            const unsigned char* bgr =
                data + static_cast<std::ptrdiff_t>(y) * stride + static_cast<std::ptrdiff_t>(x) * 4;
            picture.pixels.push_back({bgr[0], bgr[1], bgr[2], 0});
        }
    }
    cairo_surface_destroy(surface);
    return picture;
}

Picture picture_of(std::span<const Plot> panels) {
    const TempFolder folder;
    write_plots(panels, folder.path() / "a.png");
    return picture_in(folder.path() / "a.png");
}

Picture picture_of(const Plot& plot) {
    return picture_of({&plot, 1});
}

std::string svg_of(std::span<const Plot> panels) {
    const TempFolder folder;
    write_plots(panels, folder.path() / "a.svg");
    return content_of(folder.path() / "a.svg");
}

// Cairo's SVG says each letter as one reference to its shape. A space is one too.
int letters_in(std::span<const Plot> panels) {
    const std::string svg = svg_of(panels);
    int count = 0;
    for (auto at = svg.find("<use "); at != std::string::npos; at = svg.find("<use ", at + 1)) {
        ++count;
    }
    return count;
}

int letters_in(const Plot& plot) {
    return letters_in({&plot, 1});
}

struct Region {
    double left = 1e9, top = 1e9, right = -1.0, bottom = -1.0;  // outermost pixels; empty at first
    int count = 0;

    void add(int x, int y) {
        left = std::min<double>(left, x);
        top = std::min<double>(top, y);
        right = std::max<double>(right, x);
        bottom = std::max<double>(bottom, y);
        ++count;
    }
    [[nodiscard]] double middle_x() const { return (left + right) / 2.0; }
    [[nodiscard]] double middle_y() const { return (top + bottom) / 2.0; }
};

Region region_where(const Picture& picture, auto holds) {
    Region region;
    for (int y = 0; y < picture.height; ++y) {
        for (int x = 0; x < picture.width; ++x) {
            if (holds(x, y)) region.add(x, y);
        }
    }
    return region;
}

Region region_of(const Picture& picture, PlotColour colour) {
    return region_where(picture, [&](int x, int y) { return picture.at(x, y).is_about(colour); });
}

Region difference(const Picture& a, const Picture& b) {
    return region_where(a, [&](int x, int y) { return !(a.at(x, y) == b.at(x, y)); });
}

int pixels_of(const std::filesystem::path& file, PlotColour colour) {
    return region_of(picture_in(file), colour).count;
}

// Where the frame's lines lie: its corners are the points (first_x, 0) and (last_x, 1).
struct Frame {
    double left, top, right, bottom;
};

// Circles stand at both corners. No other curve is needed to see where x = 450 has to be.
Plot corner_plot(double first_x, double last_x) {
    Plot plot{"", "", "", {}};
    plot.curves.push_back({"", {first_x}, {0.0}, kPlotRed, false, true});
    plot.curves.push_back({"", {last_x}, {1.0}, kPlotGreen, false, true});
    return plot;
}

Frame frame_of(const Picture& picture) {
    const Region first = region_of(picture, kPlotRed);
    const Region last = region_of(picture, kPlotGreen);
    return {first.middle_x(), last.middle_y(), last.middle_x(), first.middle_y()};
}

// The middles of the dark places in a row between two columns.
std::vector<double> lines_across(const Picture& picture, int row, int left, int right) {
    constexpr double kSeen = 0.02;  // of the darkness; the finest grid has 0.05
    std::vector<double> middles;
    double weight = 0.0, moment = 0.0;
    for (int x = left; x <= right; ++x) {
        const double darkness = picture.at(x, row).darkness();
        if (darkness > kSeen) {
            weight += darkness;
            moment += darkness * x;
        } else if (weight > 0.0) {
            middles.push_back(moment / weight);
            weight = moment = 0.0;
        }
    }
    return middles;
}

TEST(WritePlot, DrawsTheCurveIntoAPng) {
    const TempFolder folder;
    const auto file = folder.path() / "a.png";
    write_plot(some_plot(), file);
    EXPECT_TRUE(content_of(file).starts_with("\x89PNG\r\n"));
    EXPECT_GT(pixels_of(file, kPlotRed), 1000);  // a line across the picture
    EXPECT_EQ(pixels_of(file, kPlotGreen), 0);
    EXPECT_EQ(files_in(folder), 1U);
}

TEST(WritePlot, DrawsALogarithmicAxis) {
    const TempFolder folder;
    Plot plot = some_plot();
    plot.log_y = true;
    write_plot(plot, folder.path() / "a.png");
    EXPECT_GT(pixels_of(folder.path() / "a.png", kPlotRed), 1000);
    EXPECT_EQ(pixels_of(folder.path() / "a.png", kPlotBlue), 0);  // its only point is at 0
}

TEST(WritePlot, WritesSvg) {
    const TempFolder folder;
    write_plot(some_plot(), folder.path() / "a.svg");
    const std::string svg = content_of(folder.path() / "a.svg");
    EXPECT_NE(svg.find("<svg"), std::string::npos);
    EXPECT_NE(svg.find("</svg>"), std::string::npos);
}

TEST(WritePlot, WritesTheSamePictureTwice) {
    const TempFolder folder;
    write_plot(some_plot(), folder.path() / "a.png");
    write_plot(some_plot(), folder.path() / "b.png");
    EXPECT_EQ(content_of(folder.path() / "a.png"), content_of(folder.path() / "b.png"));
}

TEST(WritePlot, DrawsFlatCurvesAndSinglePoints) {
    const TempFolder folder;
    for (const double y : {0.0, 1.0, -3.0, 1e-300, 1e300}) {
        Plot plot = some_plot();
        plot.curves = {{"", {500.0}, {y}, kPlotRed}};
        EXPECT_NO_THROW(write_plot(plot, folder.path() / "a.png")) << y;
        EXPECT_GT(pixels_of(folder.path() / "a.png", kPlotRed), 0) << y;
    }
}

TEST(WritePlot, RefusesOtherExtensions) {
    const TempFolder folder;
    for (const char* name : {"a.jpg", "a", "a.PNG"}) {
        EXPECT_THROW(write_plot(some_plot(), folder.path() / name), InputError) << name;
    }
    EXPECT_EQ(files_in(folder), 0U);
}

TEST(WritePlot, DrawsMarksInsideTheAxisOnly) {
    Plot plot = corner_plot(400.0, 600.0);
    const Picture without = picture_of(plot);
    plot.marks_x = {399.0, 601.0, -450.0, kNan};
    EXPECT_EQ(picture_of(plot).pixels, without.pixels);

    plot.marks_x = {450.0};
    const Picture with = picture_of(plot);
    const Region mark = difference(with, without);
    const Frame frame = frame_of(without);
    constexpr double kWidest = 4.0;  // pixels of a thin line
    EXPECT_NEAR(mark.middle_x(), frame.left + 0.25 * (frame.right - frame.left), 2.0 * kHalfPixel);
    EXPECT_LE(mark.right - mark.left + 1.0, kWidest);
    constexpr double kDash = 10.0;
    EXPECT_NEAR(mark.top, frame.top, kDash);
    EXPECT_NEAR(mark.bottom, frame.bottom, kDash);
}

TEST(WritePlot, DrawsMarksDashedAndGrey) {
    Plot plot = corner_plot(400.0, 600.0);
    const Picture without = picture_of(plot);
    plot.marks_x = {430.0};
    const Picture with = picture_of(plot);
    const Region mark = difference(with, without);
    const int x = static_cast<int>(mark.middle_x());
    int dark = 0;
    for (int y = static_cast<int>(mark.top); y <= static_cast<int>(mark.bottom); ++y) {
        if (with.at(x, y) == without.at(x, y)) continue;
        ++dark;
        const Pixel pixel = with.at(x, y);
        EXPECT_NEAR(pixel.red, pixel.blue, 15);  // of 255
        EXPECT_NEAR(pixel.red, pixel.green, 15);
    }
    const double share = dark / (mark.bottom - mark.top);
    EXPECT_GT(share, 0.3);
    EXPECT_LT(share, 0.7);
}

TEST(WritePlot, DrawsMarksBehindTheCurves) {
    Plot plot = corner_plot(400.0, 600.0);
    plot.curves.push_back({"", {400.0, 600.0}, {0.5, 0.5}, kPlotBlue});
    const int whole = region_of(picture_of(plot), kPlotBlue).count;
    for (double x = 410.0; x < 600.0; x += 10.0) plot.marks_x.push_back(x);
    EXPECT_EQ(region_of(picture_of(plot), kPlotBlue).count, whole);
}

TEST(WritePlot, SpacesDecadesEquallyOnALogarithmicXAxis) {
    Plot plot = corner_plot(1.0, 1000.0);
    plot.log_x = true;
    plot.curves.push_back({"", {10.0}, {0.5}, kPlotBlue, false, true});
    plot.curves.push_back({"", {100.0}, {0.5}, kPlotPalette[3], false, true});
    plot.curves.push_back({"", {0.0, -10.0, kNan}, {0.3, 0.3, 0.3}, kPlotPalette[4], false, true});
    const Picture picture = picture_of(plot);
    const Frame frame = frame_of(picture);
    const double decade = (frame.right - frame.left) / 3.0;
    EXPECT_NEAR(region_of(picture, kPlotBlue).middle_x(), frame.left + decade, 2.0 * kHalfPixel);
    EXPECT_NEAR(region_of(picture, kPlotPalette[3]).middle_x(),
                frame.left + 2.0 * decade,
                2.0 * kHalfPixel);
    EXPECT_EQ(region_of(picture, kPlotPalette[4]).count, 0);  // log of none of them
}

TEST(WritePlot, BreaksTheLineWhereALogarithmicXAxisHasNoPlace) {
    Plot plot = corner_plot(1.0, 100.0);
    plot.log_x = true;
    plot.curves.push_back({"", {1.0, 2.0, -1.0, 50.0, 100.0}, {0.5, 0.5, 0.5, 0.5, 0.5}});
    const Picture picture = picture_of(plot);
    const Frame frame = frame_of(picture);
    const int middle = static_cast<int>((frame.left + frame.right) / 2.0);  // x = 10
    for (int y = 0; y < picture.height; ++y) {
        EXPECT_FALSE(picture.at(middle, y).is_about(kPlotBlue)) << y;
    }
    EXPECT_GT(region_of(picture, kPlotBlue).count, 100);
}

TEST(WritePlot, DividesALogarithmicXAxisAt1And2And5) {
    Plot plot = corner_plot(0.7, 130.0);
    plot.log_x = true;
    const Picture picture = picture_of(plot);
    const Frame frame = frame_of(picture);
    const auto found = lines_across(picture,
                                    static_cast<int>(frame.bottom) - 40,  // between lines of y
                                    static_cast<int>(frame.left) + 4,
                                    static_cast<int>(frame.right) - 4);
    const std::vector<double> wanted{1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0};
    ASSERT_EQ(found.size(), wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const double fraction = std::log(wanted[i] / 0.7) / std::log(130.0 / 0.7);
        EXPECT_NEAR(found[i], frame.left + fraction * (frame.right - frame.left), 2.0 * kHalfPixel)
            << wanted[i];
    }
}

// The strokes below the axis stand where a label does.
TEST(WritePlot, LabelsALogarithmicXAxisOfAnyRange) {
    for (const double last_x : {1.02, 4.0, 1e3, 1e5, 1e30, 1e250}) {
        Plot plot = corner_plot(1.0, last_x);
        plot.log_x = true;
        const Picture picture = picture_of(plot);
        const Frame frame = frame_of(picture);
        const std::size_t labels = lines_across(picture,
                                                static_cast<int>(frame.bottom) + 9,
                                                static_cast<int>(frame.left) - 4,
                                                kWidth_px - 1)
                                       .size();
        EXPECT_GE(labels, 3U) << last_x;
        EXPECT_LE(labels, 12U) << last_x;
    }
}

TEST(WritePlot, DrawsASinglePointOnALogarithmicXAxis) {
    for (const double x : {1e-200, 1.0, 550.0, 1e200}) {
        Plot plot = some_plot();
        plot.log_x = true;
        plot.curves = {{"", {x}, {1.0}, kPlotRed}};
        EXPECT_GT(region_of(picture_of(plot), kPlotRed).count, 0) << x;
    }
}

TEST(WritePlot, DashesTheCurve) {
    Plot plot = corner_plot(400.0, 600.0);
    plot.curves.push_back({"", {400.0, 600.0}, {0.5, 0.5}, kPlotBlue});
    const int solid = region_of(picture_of(plot), kPlotBlue).count;
    plot.curves.back().dashed = true;
    const Region dashed = region_of(picture_of(plot), kPlotBlue);
    EXPECT_GT(dashed.count, 0.3 * solid);
    EXPECT_LT(dashed.count, 0.8 * solid);
    EXPECT_GT(dashed.right - dashed.left, 1500.0);  // from end to end all the same
}

TEST(WritePlot, DrawsPointsAsCirclesWithoutALine) {
    Plot plot = corner_plot(400.0, 600.0);
    plot.curves.push_back({"", {450.0, 500.0, 550.0}, {0.5, 0.5, 0.5}, kPlotBlue, false, true});
    const Region three = region_of(picture_of(plot), kPlotBlue);
    plot.curves.back().x = {500.0};
    const Region one = region_of(picture_of(plot), kPlotBlue);
    EXPECT_NEAR(three.count, 3 * one.count, 0.1 * three.count);  // edges fall differently
    const double diameter = one.right - one.left + 1.0;
    EXPECT_NEAR(diameter, one.bottom - one.top + 1.0, 1.0);
    EXPECT_NEAR(one.count, std::numbers::pi / 4.0 * diameter * diameter, 0.1 * one.count);
}

// Everything in the corners, where labels have the least room, and one that is far too long.
TEST(WritePlot, KeepsPointLabelsWithinThePanel) {
    Plot plot = corner_plot(400.0, 600.0);
    plot.curves.push_back({"",
                           {400.0, 600.0, 400.0, 600.0, 599.0, 500.0},
                           {0.0, 0.0, 1.0, 1.0, 0.5, 0.0},
                           kPlotBlue,
                           false,
                           true});
    const Picture without = picture_of(plot);
    const Frame frame = frame_of(picture_of(corner_plot(400.0, 600.0)));
    plot.curves.back().point_labels = {
        "lower left", "lower right", "upper left", "upper right", std::string(300, 'm'), "gjpq"};
    const Region labels = difference(picture_of(plot), without);
    EXPECT_GT(labels.count, 1000);
    EXPECT_GT(labels.left, frame.left);
    EXPECT_LT(labels.right, frame.right);
    EXPECT_GT(labels.top, frame.top);
    EXPECT_LT(labels.bottom, frame.bottom);
}

TEST(WritePlot, LabelsThePointsThatAreDrawn) {
    Plot plot = corner_plot(400.0, 600.0);
    plot.curves.push_back(
        {"", {450.0, 500.0, 520.0, 550.0}, {0.5, kNan, 0.5, 0.5}, kPlotBlue, false, true});
    const int without = letters_in(plot);
    plot.curves.back().point_labels = {"first", "not drawn", "", "fourth", "beyond the points"};
    EXPECT_EQ(letters_in(plot), without + 5 + 6);
    plot.curves.back().point_labels = {"first"};  // and none for the others
    EXPECT_EQ(letters_in(plot), without + 5);
}

TEST(WritePlot, DrawsPointLabelsBesideTheirPoints) {
    Plot plot = corner_plot(400.0, 600.0);
    plot.curves.push_back({"", {450.0}, {0.35}, kPlotBlue, false, true});
    const Picture without = picture_of(plot);
    plot.curves.back().point_labels = {"label"};
    const Picture with = picture_of(plot);
    const Region point = region_of(without, kPlotBlue);
    const Region label = difference(with, without);
    EXPECT_EQ(region_of(with, kPlotBlue).count, point.count);  // it hides none of it
    constexpr double kNear = 20.0;                             // pixels
    EXPECT_GT(label.left, point.right - 1.0);
    EXPECT_LT(label.left, point.right + kNear);
    EXPECT_NEAR(label.middle_y(), point.middle_y(), kNear);
}

TEST(WritePlot, HidesNeitherPointsNorLinesUnderLabels) {
    Plot plot = corner_plot(400.0, 600.0);
    // Where the label of the first point would stand: a point on its right, a line on its left.
    plot.curves.push_back({"", {450.0, 454.0}, {0.35, 0.35}, kPlotBlue, false, true});
    plot.curves.push_back({"", {444.0, 444.0}, {0.0, 1.0}, kPlotPalette[3]});
    const Picture without = picture_of(plot);
    plot.curves[2].point_labels = {"label", "label"};
    const Picture with = picture_of(plot);
    EXPECT_GT(difference(with, without).count, 100);
    for (const PlotColour colour : {kPlotBlue, kPlotPalette[3]}) {
        EXPECT_EQ(region_of(with, colour).count, region_of(without, colour).count);
    }
}

// Labels on one another would leave the dark pixels of one.
TEST(WritePlot, MovesPointLabelsAside) {
    const auto dark_pixels = [](std::size_t labels) {
        Plot plot = corner_plot(400.0, 600.0);
        plot.curves.push_back({"",
                               std::vector<double>(labels, 450.0),
                               std::vector<double>(labels, 0.35),
                               kPlotBlue,
                               false,
                               true,
                               std::vector<std::string>(labels, "label")});
        const Picture with = picture_of(plot);
        plot.curves.back().point_labels.clear();
        const Picture without = picture_of(plot);
        return region_where(with,
                            [&](int x, int y) {
                                constexpr double kDark =
                                    0.7;  // darker than the lines that lead to a label
                                return with.at(x, y).darkness() > kDark &&
                                       !(with.at(x, y) == without.at(x, y));
                            })
            .count;
    };
    const int one = dark_pixels(1);
    EXPECT_GT(one, 50);
    for (const std::size_t labels : {2U, 6U}) {
        EXPECT_NEAR(dark_pixels(labels), static_cast<double>(labels) * one, 0.1 * one) << labels;
    }
}

TEST(WritePlot, RefusesAPlotWithoutPoints) {
    const TempFolder folder;
    Plot plot = some_plot();
    plot.curves = {{"", {500.0}, {kNan}, kPlotRed}};
    EXPECT_THROW(write_plot(plot, folder.path() / "a.png"), InputError);
    EXPECT_EQ(files_in(folder), 0U);
}

TEST(WritePlot, RefusesALogarithmicXAxisWithoutPoints) {
    const TempFolder folder;
    Plot plot = some_plot();
    plot.log_x = true;
    plot.curves = {{"", {0.0, -500.0}, {1.0, 1.0}, kPlotRed}};
    EXPECT_THROW(write_plot(plot, folder.path() / "a.png"), InputError);
    EXPECT_EQ(files_in(folder), 0U);
}

TEST(WritePlot, SaysWhenTheFileCannotBeWritten) {
    const TempFolder folder;
    EXPECT_THROW(write_plot(some_plot(), folder.path() / "none" / "a.png"), RunError);
}

std::vector<Plot> two_panels() {
    Plot other{"Another title",
               "steps",
               "error",
               {{"points", {1.0, 10.0, 100.0}, {1.0, 0.4, 0.2}, kPlotGreen, false, true}}};
    other.log_x = true;
    other.marks_x = {20.0};
    return {some_plot(), other};  // both with y from 0.0 to 1.0: as much room beside the frame
}

TEST(WritePlots, DrawsThePanelsOneAboveTheOther) {
    const std::vector<Plot> panels = two_panels();
    const Picture both = picture_of(panels);
    ASSERT_EQ(both.width, kWidth_px);
    ASSERT_EQ(both.height, 2 * kPanelHeight_px);
    const auto same = [](const std::vector<Pixel>& a, const std::vector<Pixel>& b) {
        return a == b;
    };
    EXPECT_TRUE(same(both.rows(0, kPanelHeight_px), picture_of(panels[0]).pixels));
    EXPECT_TRUE(same(both.rows(kPanelHeight_px, kPanelHeight_px), picture_of(panels[1]).pixels));
}

TEST(WritePlots, WritesEachTitleAxisLabelAndLegendIntoTheSvg) {
    const std::vector<Plot> panels = two_panels();
    const int all = letters_in(panels);
    EXPECT_EQ(all, letters_in(panels[0]) + letters_in(panels[1]));
    for (std::size_t i = 0; i < panels.size(); ++i) {
        for (std::string Plot::*text : {&Plot::title, &Plot::x_label, &Plot::y_label}) {
            auto without = panels;
            (without[i].*text).clear();
            EXPECT_EQ(letters_in(without), all - static_cast<int>((panels[i].*text).size()));
        }
        auto without = panels;
        without[i].curves[0].label.clear();
        EXPECT_EQ(letters_in(without), all - static_cast<int>(panels[i].curves[0].label.size()));
    }
}

TEST(WritePlots, GrowsWithTheNumberOfPanels) {
    for (const int count : {1, 3}) {
        const std::vector<Plot> panels(static_cast<std::size_t>(count), some_plot());
        EXPECT_EQ(picture_of(panels).height, count * kPanelHeight_px);
        const std::string height = "viewBox=\"0 0 960 " + std::to_string(count * 600) + "\"";
        EXPECT_NE(svg_of(panels).find(height), std::string::npos) << count;
    }
}

TEST(WritePlots, AlignsTheFrames) {
    std::vector<Plot> panels{corner_plot(1.0, 2.0), corner_plot(400.0, 600.0)};
    panels[1].curves[0].colour = kPlotBlue;
    panels[1].curves[1] = {"", {600.0}, {123456.0}, kPlotPalette[3], false, true};  // wide labels
    const Picture picture = picture_of(panels);
    EXPECT_EQ(region_of(picture, kPlotRed).middle_x(), region_of(picture, kPlotBlue).middle_x());
    EXPECT_EQ(region_of(picture, kPlotGreen).middle_x(),
              region_of(picture, kPlotPalette[3]).middle_x());
}

TEST(WritePlots, IsWritePlotForOnePanel) {
    const TempFolder folder;
    const Plot plot = some_plot();
    write_plot(plot, folder.path() / "a.png");
    write_plots({&plot, 1}, folder.path() / "b.png");
    EXPECT_TRUE(content_of(folder.path() / "a.png") == content_of(folder.path() / "b.png"));
}

TEST(WritePlots, RefusesAPanelWithoutPointsAndNamesIt) {
    const TempFolder folder;
    std::vector<Plot> panels = two_panels();
    panels[1].curves[0].y = {kNan, kNan, kNan};
    for (const char* name : {"a.png", "a.svg"}) {
        try {
            write_plots(panels, folder.path() / name);
            ADD_FAILURE() << name << " was drawn";
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find("Another title"), std::string::npos);
        }
    }
    EXPECT_EQ(files_in(folder), 0U);
}

TEST(WritePlots, RefusesNoPanelsAndOtherExtensions) {
    const TempFolder folder;
    EXPECT_THROW(write_plots({}, folder.path() / "a.png"), InputError);
    EXPECT_THROW(write_plots(two_panels(), folder.path() / "a.jpg"), InputError);
    EXPECT_EQ(files_in(folder), 0U);
}

TEST(WritePlots, SaysWhenTheFileCannotBeWritten) {
    const TempFolder folder;
    EXPECT_THROW(write_plots(two_panels(), folder.path() / "none" / "a.svg"), RunError);
}

double linear(double srgb) {
    return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

// CIE XYZ under D65 (IEC 61966-2-1).
std::array<double, 3> xyz_of(PlotColour colour) {
    const double r = linear(colour.red), g = linear(colour.green), b = linear(colour.blue);
    return {0.4124 * r + 0.3576 * g + 0.1805 * b,
            0.2126 * r + 0.7152 * g + 0.0722 * b,
            0.0193 * r + 0.1192 * g + 0.9505 * b};
}

// CIE 1976 colour difference.
double colour_difference(PlotColour a, PlotColour b) {
    const auto lab_of = [](PlotColour colour) -> std::array<double, 3> {
        const auto xyz = xyz_of(colour);
        const auto white = xyz_of({1.0, 1.0, 1.0});
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

TEST(PlotPalette, IsLegibleOnWhite) {
    constexpr double kLeastContrast = 3.0;  // WCAG 2.1, 1.4.11: graphics
    for (std::size_t i = 0; i < kPlotPalette.size(); ++i) {
        EXPECT_GE(1.05 / (xyz_of(kPlotPalette[i])[1] + 0.05), kLeastContrast) << i;
    }
}

TEST(PlotPalette, KeepsItsColoursApart) {
    constexpr double kPlainlyDifferent = 25.0;  // ten times what is just seen, about 2.3
    for (std::size_t i = 0; i < kPlotPalette.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            EXPECT_GE(colour_difference(kPlotPalette[i], kPlotPalette[j]), kPlainlyDifferent)
                << i << " and " << j;
        }
    }
}

}  // namespace
}  // namespace aphotic::plot_test
