// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_page.h"

#include "base/atomic_file.h"
#include "base/degrees.h"
#include "image/preview.h"
#include "report/html.h"
#include "report/page.h"
#include "report/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace aphotic {
namespace {

constexpr double kShownResidual = 0.1;  // at which a residual has its full colour

std::string number_text(double value) {
    return scientific(value);
}

std::string altitudes_of(const FitSamples& samples) {
    const auto by_altitude = [](const FitImage& image) { return image.sled.altitude_m; };
    const auto [lowest, highest] = std::ranges::minmax(samples.images, {}, by_altitude);
    return fmt::format("{:.3g} to {:.3g}", lowest.sled.altitude_m, highest.sled.altitude_m);
}

std::string headline(const FitResult& result) {
    std::string words = words_of(result);
    if (!result.held.empty()) words += ", " + grouped_count(result.held.size(), "number") + " held";
    if (!result.looks_wrong.empty())
        words += ", " + grouped_count(result.looks_wrong.size(), "warning");
    return words;
}

std::vector<std::string> warnings(const FitResult& result) {
    std::vector<std::string> words;
    for (const Suspicion& one : result.looks_wrong)
        words.push_back(fmt::format("{}: {}", one.about, named(one.what)));
    return words;
}

std::vector<PagePart> numbers(const FitResult& result) {
    PageTable table{.columns = {"number", "began at", "fitted", "standard error", ""}};
    for (const FittedNumber& one : result.numbers) {
        table.rows.push_back({.cells = {one.key,
                                        plain(one.start),
                                        plain(one.value),
                                        number_text(one.error),
                                        one.is_at_bound ? "at the end of its range" : ""},
                              .tone = one.is_at_bound ? PageTone::Bad : PageTone::None});
    }
    std::vector<PagePart> parts{std::move(table)};
    for (const NotTold& one : result.held) parts.emplace_back("Held: " + words_of(one) + ".");
    if (!result.fixed.empty())
        parts.emplace_back(
            fmt::format("Not fitted, as the rig has them: {}.", fmt::join(result.fixed, ", ")));
    return parts;
}

std::vector<PagePart> confounded(const FitResult& result) {
    if (result.confounded.empty()) return {};
    PageTable table{.columns = {"number", "with", "correlation"}};
    for (const Confounded& pair : result.confounded) {
        table.rows.push_back(
            {.cells = {pair.one, pair.other, fmt::format("{:+.2f}", pair.correlation)}});
    }
    return {"Pairs that nearly make up for each other.", std::move(table)};
}

// Blue where the image is darker than the fit, red where it is brighter.
std::uint32_t residual_colour(float residual) {
    if (!std::isfinite(residual)) return 0x808080;
    const double share = std::clamp(static_cast<double>(residual) / kShownResidual, -1.0, 1.0);
    const auto level = [](double value) {
        return static_cast<std::uint32_t>(std::lround(255.0 * value));
    };
    const double faded = 1.0 - std::abs(share);
    const std::uint32_t red = level(share > 0.0 ? 1.0 : faded);
    const std::uint32_t green = level(faded);
    const std::uint32_t blue = level(share > 0.0 ? faded : 1.0);
    return red << 16U | green << 8U | blue;
}

std::vector<PagePart> views(const FitSamples& samples, const FitResult& result) {
    const int width_px = samples.places.width_px / samples.places.block_px;
    const int height_px = static_cast<int>(samples.places.size()) / width_px;
    PageFigures figures{.figures = {}, .are_small = true};
    for (const FitView& view : result.left.views) {
        const CameraImage fitted{width_px, height_px, view.fitted};
        const auto scale = preview_scale(fitted, {1.0, 1.0, 1.0}, {.white = PreviewWhite::Image});
        std::vector<std::uint32_t> colours;
        for (const float residual : view.residual) colours.push_back(residual_colour(residual));
        const auto shown = [&](std::string png, std::string words) {
            return PagePicture{.bytes = std::move(png),
                               .width_px = width_px,
                               .height_px = height_px,
                               .words = std::move(words)};
        };
        figures.figures.push_back(
            {.pictures = {shown(preview_png({width_px, height_px, view.observed}, scale),
                                "observed"),
                          shown(preview_png(fitted, scale), "fitted"),
                          shown(png_of(colours, width_px, height_px), "what is left")},
             .caption = fmt::format("{}, {:.2f}\xC2\xA0m",
                                    named(samples.images[view.image].name),
                                    samples.images[view.image].sled.altitude_m)});
    }
    return {fmt::format("Observed, fitted, and what is left: red brighter, blue darker than the "
                        "fit, in full colour from {:.0f} % on. Each block is {} pixels wide.",
                        100.0 * kShownResidual,
                        samples.places.block_px),
            std::move(figures)};
}

constexpr double kWidth = 760.0;
constexpr double kHeight = 300.0;
constexpr double kTop = 12.0;

SvgPanel panel_over(const ValueRange& x, const ValueRange& y) {
    return {.left = kAxisWidth,
            .top = kTop,
            .width = kWidth - kAxisWidth - kTop,
            .height = kHeight - kAxisHeight - kTop,
            .x = linear_axis(x.least, x.most, 8),
            .y = linear_axis_around(y.least, y.most, 6)};
}

PagePlot beam(std::size_t number, const std::vector<BeamPoint>& curve) {
    std::vector<double> theta_deg;
    std::vector<double> middle;
    std::vector<double> low;
    std::vector<double> high;
    ValueRange x;
    ValueRange y;
    for (const BeamPoint& point : curve) {
        theta_deg.push_back(point.theta_rad * kDegreesPerRadian);
        middle.push_back(point.intensity);
        low.push_back(std::max(0.0, point.intensity - 2.0 * point.error));
        high.push_back(point.intensity + 2.0 * point.error);
        x.include(theta_deg.back());
        y.include(high.back());
    }
    y.include(0.0);
    SvgPanel panel = panel_over(x, y);
    panel.x.title = "angle off the axis [degrees]";
    panel.y.title = "intensity [1/sr]";
    const std::string solid = "class=\"curve\" " + svg_tone(0);
    const std::string dashed = "class=\"curve dashed\" " + svg_tone(0);
    const std::string drawing = svg_axes(panel) + svg_curve(panel, theta_deg, low, dashed) +
                                svg_curve(panel, theta_deg, high, dashed) +
                                svg_curve(panel, theta_deg, middle, solid);
    return {svg_drawing(fmt::format("beam-{}", number), "beam", kWidth, kHeight, drawing)};
}

std::vector<PagePart> beams(const FitResult& result) {
    if (result.beam_curves.empty()) return {};
    std::vector<PagePart> parts{"For a flux of 1, within twice its standard error."};
    for (std::size_t b = 0; b < result.beam_curves.size(); ++b)
        parts.emplace_back(beam(b, result.beam_curves[b]));
    return parts;
}

std::vector<PagePart> over_altitude(const FitResult& result) {
    std::vector<double> altitude_m;
    std::vector<double> residual;
    std::vector<double> level;
    ValueRange x;
    ValueRange y;
    for (const ImageOutcome& image : result.left.images) {
        altitude_m.push_back(image.sled.altitude_m);
        residual.push_back(image.residual);
        level.push_back(image.level);
        x.include(altitude_m.back());
        y.include(residual.back());
        y.include(level.back());
    }
    if (!(x.most > x.least)) return {};
    y.include(0.0);
    SvgPanel panel = panel_over(x, y);
    panel.x.title = "altitude [m]";
    panel.y.title = "share of the signal";
    const std::string dots = "class=\"dots\" style=\"stroke-width: 6px\" ";
    const std::string drawing = svg_axes(panel) +
                                svg_dots(panel, altitude_m, residual, dots + svg_tone(0)) +
                                svg_dots(panel, altitude_m, level, dots + svg_tone(1));
    return {
        "Blue: what is left of an image, rms. Red: how much brighter the image is than its pose "
        "explains; that should not go with the altitude.",
        PagePlot{svg_drawing("residuals", "residuals over altitude", kWidth, kHeight, drawing)}};
}

std::vector<PagePart> deviations(const FitResult& result) {
    const auto deviation = [&](std::size_t k) { return std::sqrt(result.effects[k]); };
    PageList items{{"brightness", number_text(deviation(0))},
                   {"red and blue beside green",
                    fmt::format("{}, {}", number_text(deviation(1)), number_text(deviation(2)))},
                   {"altitude", fmt::format("{} m", number_text(deviation(3)))},
                   {"pitch, roll",
                    fmt::format("{}, {} degrees",
                                number_text(deviation(4) * kDegreesPerRadian),
                                number_text(deviation(5) * kDegreesPerRadian))}};
    return {"Standard deviations of what the images are off by, each its own.", std::move(items)};
}

}  // namespace

void write_fit_page(const std::filesystem::path& file,
                    const RigText& text,
                    const FitSamples& samples,
                    const FitResult& result) {
    const std::string title = text.rig().title.empty() ? "Untitled rig" : text.rig().title;
    const Page page{
        .kind = "fit",
        .title = "Fit: " + title,
        .heading = title,
        .is_good = result.looks_wrong.empty(),
        .headline = headline(result),
        .said = {fmt::format("Of {} at {} m it leaves {} (rms, relative), of which {} stays in "
                             "place from image to image: what the model lacks.",
                             grouped_count(result.blocks, "block"),
                             altitudes_of(samples),
                             number_text(result.left.residual),
                             number_text(result.left.pattern))},
        .warnings = warnings(result),
        .sections = {
            {.id = "numbers", .heading = "What was found", .parts = numbers(result)},
            {.id = "views", .heading = "Observed and fitted", .parts = views(samples, result)},
            {.id = "beams", .heading = "Beam", .parts = beams(result)},
            {.id = "altitude", .heading = "Over altitude", .parts = over_altitude(result)},
            {.id = "deviations", .heading = "From image to image", .parts = deviations(result)},
            {.id = "confounded", .heading = "Confounded", .parts = confounded(result)},
            {.id = "rig",
             .heading = "The rig that it began with",
             .parts = {PageSource{text.text()}}}}};
    write_text_file(file, page_html(page));
}

}  // namespace aphotic
