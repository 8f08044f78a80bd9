// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_page.h"

#include "base/atomic_file.h"
#include "base/degrees.h"
#include "image/preview.h"
#include "report/html.h"
#include "report/page.h"
#include "report/plot.h"
#include "survey/fixed_pattern_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace aphotic {
namespace {

std::string percent(double share) {
    return fmt::format("{:.2g}\xC2\xA0%", 100.0 * share);
}

std::string headline(const FitResult& result) {
    std::string words = words_of(result);
    const auto open = std::ranges::count(result.numbers, false, &FittedNumber::is_determined);
    if (open > 0)
        words += fmt::format(", {} not determined",
                             grouped_count(static_cast<std::size_t>(open), "number"));
    if (!result.looks_wrong.empty())
        words += ", " + grouped_count(result.looks_wrong.size(), "warning");
    return words;
}

// No evenness is promised of a rig that leaves a pattern.
std::vector<std::string> verdict(const FitResult& result) {
    const std::string pattern = "The residuals have " + words_of(result.pattern) + ".";
    if (result.pattern.is_too_large())
        return {
            pattern,
            fmt::format("So no evenness is promised: without the pattern, correction by this rig "
                        "would be expected to be even to {}. The rig as it was may correct more "
                        "evenly.",
                        percent(result.unevenness))};
    return {fmt::format("Correction by this rig is expected to be even to {}: the error of its "
                        "light over this flight, apart from the floor's mean level. It does not "
                        "include what the rig does not model, such as a veil that its water lacks, "
                        "or another lens. {} of the signal is veil.",
                        percent(result.unevenness),
                        percent(result.veil_share)),
            is_rig_as_good(result)
                ? fmt::format("The rig as it was is expected to do as well: the fitted light "
                              "differs from its light by {}, which the fit's error explains.",
                              percent(result.moved))
                : fmt::format("The rig as it was is expected to leave {}.",
                              percent(rig_unevenness(result))),
            pattern};
}

std::vector<std::string> warnings(const FitResult& result) {
    std::vector<std::string> words;
    for (const Suspicion& one : result.looks_wrong)
        words.push_back(fmt::format("{}: {}", one.about, named(one.what)));
    return words;
}

std::vector<PagePart> numbers(const FitResult& result) {
    PageTable table{.columns = {"number", "the rig had", "expected within", "fitted", ""}};
    std::vector<PagePart> open;
    for (const FittedNumber& one : result.numbers) {
        if (is_curve(one)) continue;
        table.rows.push_back({.cells = {one.key,
                                        plain(one.start),
                                        fmt::format("\xC2\xB1 {:.2g}", one.spread),
                                        with_error(one, "\xC2\xB1"),
                                        one.is_determined ? "" : "not determined"}});
        if (!one.is_determined) open.emplace_back(words_of(one) + ".");
    }
    std::vector<PagePart> parts{std::move(table)};
    parts.insert(parts.end(), open.begin(), open.end());
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
    return {"Pairs that nearly compensate for each other.", std::move(table)};
}

std::vector<PagePart> views(const FitSamples& samples, const FitResult& result) {
    const int width_px = static_cast<int>(samples.places.across());
    const int height_px = static_cast<int>(samples.places.down());
    const auto shown = [&](std::string png, std::string words) {
        return PagePicture{.bytes = std::move(png),
                           .width_px = width_px,
                           .height_px = height_px,
                           .words = std::move(words)};
    };
    PageFigures figures{.figures = {}, .are_small = true};
    for (const FitView& view : result.views) {
        const CameraImage fitted{width_px, height_px, view.fitted};
        const auto scale = preview_scale(fitted, {1.0, 1.0, 1.0}, {.white = PreviewWhite::Image});
        figures.figures.push_back(
            {.pictures = {shown(preview_png({width_px, height_px, view.observed}, scale),
                                "observed"),
                          shown(preview_png(fitted, scale), "fitted")},
             .caption = fmt::format("{}, {:.2f}\xC2\xA0m",
                                    named(samples.images[view.image].name),
                                    samples.images[view.image].sled.altitude_m)});
    }
    return {fmt::format("Images as observed, in blocks of {} pixels, and as the fitted rig "
                        "predicts them for an even floor.",
                        samples.places.block_px),
            std::move(figures)};
}

std::vector<PagePart> pattern(const FitSamples& samples, const FitResult& result) {
    return parts_of(result.pattern,
                    samples.places.across(),
                    {samples.places.width_px, samples.places.height_px});
}

constexpr double kPlotHeight = 380.0;

PagePlot beam(std::size_t number, const std::vector<BeamPoint>& curve) {
    PlotCurve middle{.label = "fitted", .x = {}, .y = {}};
    PlotCurve low{.label = "within twice its error", .x = {}, .y = {}, .dashed = true};
    PlotCurve high{.label = "", .x = {}, .y = {}, .dashed = true};
    for (const BeamPoint& point : curve) {
        for (PlotCurve* one : {&middle, &low, &high})
            one->x.push_back(point.theta_rad * kDegreesPerRadian);
        middle.y.push_back(point.intensity);
        low.y.push_back(std::max(0.0, point.intensity - 2.0 * point.error));
        high.y.push_back(point.intensity + 2.0 * point.error);
    }
    const Plot plot{.title = "beam",
                    .x_label = "angle off the axis [degrees]",
                    .y_label = "intensity [1/sr]",
                    .curves = {low, high, middle},
                    .from_zero = true};
    return {page_plot(fmt::format("beam-{}", number), {&plot, 1}, kPlotHeight)};
}

std::vector<PagePart> beams(const FitResult& result) {
    if (result.beam_curves.empty()) return {};
    std::vector<PagePart> parts{"For a flux of 1, within twice its standard error."};
    for (std::size_t b = 0; b < result.beam_curves.size(); ++b)
        parts.emplace_back(beam(b, result.beam_curves[b]));
    return parts;
}

std::vector<PagePart> over_altitude(const FitResult& result) {
    PlotCurve images{.label = "", .x = {}, .y = {}, .dots = true};
    for (const ImageOutcome& image : result.images) {
        images.x.push_back(image.sled.altitude_m);
        images.y.push_back(std::exp(image.brightness));
    }
    const bool is_one =
        std::ranges::adjacent_find(images.x, std::ranges::not_equal_to{}) == images.x.end();
    if (is_one) return {};
    const Plot plot{.title = "the floor's brightness over altitude",
                    .x_label = "altitude [m]",
                    .y_label = "the floor's brightness, 1 on average",
                    .curves = {images},
                    .from_zero = true};
    return {fmt::format("The floor's brightness in each image, by the fitted light. Floors vary: "
                        "these by {}, and neighbouring blocks by {}.",
                        percent(result.level_spread),
                        percent(result.texture)),
            PagePlot{page_plot("brightness", {&plot, 1}, kPlotHeight)}};
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
        .said = verdict(result),
        .warnings = warnings(result),
        .sections = {
            {.id = "numbers", .heading = "What was found", .parts = numbers(result)},
            {.id = "views", .heading = "Observed and fitted", .parts = views(samples, result)},
            {.id = "pattern", .heading = "What stays in place", .parts = pattern(samples, result)},
            {.id = "beams", .heading = "Beam", .parts = beams(result)},
            {.id = "altitude",
             .heading = "The floor over altitude",
             .parts = over_altitude(result)},
            {.id = "confounded", .heading = "Confounded", .parts = confounded(result)},
            {.id = "rig", .heading = "The starting rig", .parts = {PageSource{text.text()}}}}};
    write_text_file(file, page_html(page));
}

}  // namespace aphotic
