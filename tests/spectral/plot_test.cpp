// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/plot.h"

#include "spectral/error.h"
#include "tests/support/temp_folder.h"

#include <cairo.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <limits>

namespace aphotic {
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

// Pixels of about this colour in the picture; antialiased edges are passed over.
int pixels_of(const std::filesystem::path& file, PlotColour colour) {
    cairo_surface_t* surface = cairo_image_surface_create_from_png(file.c_str());
    const int width = cairo_image_surface_get_width(surface);
    const int height = cairo_image_surface_get_height(surface);
    const int stride = cairo_image_surface_get_stride(surface);
    const unsigned char* data = cairo_image_surface_get_data(surface);
    const auto near = [](unsigned char found, double wanted) {
        return std::abs(found - 255.0 * wanted) <= 1.0;
    };
    int count = 0;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const unsigned char* bgr =
                data + static_cast<std::ptrdiff_t>(y) * stride + static_cast<std::ptrdiff_t>(x) * 4;
            count +=
                near(bgr[0], colour.blue) && near(bgr[1], colour.green) && near(bgr[2], colour.red);
        }
    }
    cairo_surface_destroy(surface);
    return count;
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

TEST(WritePlot, RefusesAPlotWithoutPoints) {
    const TempFolder folder;
    Plot plot = some_plot();
    plot.curves = {{"", {500.0}, {kNan}, kPlotRed}};
    EXPECT_THROW(write_plot(plot, folder.path() / "a.png"), InputError);
    EXPECT_EQ(files_in(folder), 0U);
}

TEST(WritePlot, SaysWhenTheFileCannotBeWritten) {
    const TempFolder folder;
    EXPECT_THROW(write_plot(some_plot(), folder.path() / "none" / "a.png"), RunError);
}

}  // namespace
}  // namespace aphotic
