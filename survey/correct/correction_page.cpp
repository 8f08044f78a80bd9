// SPDX-License-Identifier: BSD-3-Clause
#include "survey/correct/correction_page.h"

#include "base/upper_median.h"
#include "report/html.h"
#include "report/page.h"
#include "report/plot.h"
#include "report/svg.h"
#include "survey/fixed_pattern_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace aphotic {
namespace {

constexpr std::array kColours{"red", "green", "blue"};

std::string per_channel(const PerChannel& numbers) {
    return fmt::format(
        "{} red, {} green, {} blue", plain(numbers[0]), plain(numbers[1]), plain(numbers[2]));
}

// The results.

std::string headline(const CorrectionReport& report) {
    const RunOutcome& run = *report.run;
    std::string words = grouped_count(run.corrected + run.kept, "image") + " corrected";
    if (!run.skipped.empty()) words += fmt::format(", {} skipped", grouped(run.skipped.size()));
    if (!report.looks_wrong.empty())
        words += ", " + grouped_count(report.looks_wrong.size(), "warning");
    return words;
}

std::vector<std::string> warnings(const CorrectionReport& report) {
    std::vector<std::string> words;
    for (const Suspicion& one : report.looks_wrong)
        words.push_back(fmt::format("{}: {}", one.about, named(one.what)));
    if (!report.not_checked.empty()) words.push_back("Not checked: " + report.not_checked);
    return words;
}

// Before and after.

std::vector<PagePart> before_and_after(PageFigures sheet) {
    if (sheet.figures.empty()) return {};
    return {"Left: as taken. Right: corrected. Each side has one exposure for all images.",
            std::move(sheet)};
}

// Light over altitude.

struct LightSeen {
    std::vector<double> altitude_m;
    std::array<std::vector<double>, kChannels> map;    // mean light of the image's map
    std::array<std::vector<double>, kChannels> image;  // the image's own, by its median quotient
};

// By altitude. The maps are scaled to the images by the median of their ratio.
LightSeen light_seen(std::span<const ImageLook> looks) {
    std::vector<const ImageLook*> seen;
    const auto is_lit = [](double number) { return std::isfinite(number) && number > 0.0; };
    for (const ImageLook& look : looks) {
        if (look.altitude_m && std::ranges::all_of(look.quotient, is_lit)) seen.push_back(&look);
    }
    std::ranges::sort(seen, {}, [](const ImageLook* look) { return *look->altitude_m; });
    LightSeen light;
    if (seen.size() < 2) return light;
    for (const ImageLook* look : seen) light.altitude_m.push_back(*look->altitude_m);
    for (std::size_t c = 0; c < kChannels; ++c) {
        std::vector<double> quotients;
        for (const ImageLook* look : seen) quotients.push_back(look->quotient[c]);
        const double middle = upper_median(quotients);
        for (const ImageLook* look : seen) {
            light.map[c].push_back(middle * look->map_mean[c]);
            light.image[c].push_back(look->quotient[c] * look->map_mean[c]);
        }
    }
    return light;
}

std::vector<PagePart> light_over_altitude(std::span<const ImageLook> looks) {
    constexpr double kHeight = 420.0;
    const LightSeen light = light_seen(looks);
    if (light.altitude_m.empty()) return {};
    Plot plot{.title = "light over altitude",
              .x_label = "altitude (m)",
              .y_label = "light (the camera’s numbers above black)",
              .curves = {},
              .log_y = true};
    for (std::size_t c = 0; c < kChannels; ++c) {
        PlotCurve map{.label = fmt::format("{}: maps", kColours.at(c)),
                      .x = light.altitude_m,
                      .y = light.map[c],
                      .tone = kChannelTones.at(c)};
        PlotCurve images = map;
        images.label = fmt::format("{}: images", kColours.at(c));
        images.y = light.image[c];
        images.dots = true;
        plot.curves.insert(plot.curves.end(), {std::move(map), std::move(images)});
    }
    return {PagePlot{page_plot("light-plot", {&plot, 1}, kHeight)},
            fmt::format("{} examined before the run: the mean light of each one’s map, scaled to "
                        "the images, and the light of the image, by its median pixel. Where the "
                        "rig is right, the images scatter about the lines.",
                        grouped_count(light.altitude_m.size(), "image"))};
}

// Numbers.

PageList gains(const CorrectionReport& report) {
    PageList items{{"gain", per_channel(report.gain.gain)}};
    if (!report.gain.folder.empty()) {
        items.emplace_back("taken from", report.gain.folder);
    } else {
        items.emplace_back("taken from",
                           report.gain.images.empty()
                               ? "the command line"
                               : grouped_count(report.gain.images.size(), "image"));
    }
    items.emplace_back("the survey’s median becomes", per_channel(report.gain.middle));
    if (report.srgb) {
        items.emplace_back("exposure of sRGB", plain(report.srgb->exposure));
        if (const auto& camera = report.srgb->camera) {
            items.emplace_back(
                "colours of sRGB",
                fmt::format("{:.1f} CIELAB units off on average over {}, {:.1f} at most ({})",
                            camera->mean_delta_e(),
                            grouped_count(camera->surfaces.size(), "surface"),
                            camera->worst().delta_e,
                            camera->worst().name));
        }
    }
    return items;
}

PageList doubts(const RunOutcome& run) {
    PageList items;
    for (const auto& [name, bit, words] : kDoubts) {
        // A non-breaking space.
        items.emplace_back(
            name, fmt::format("{:.3g}\xC2\xA0%: {}", 100.0 * run.doubtful_share(name), words));
    }
    return items;
}

std::string why_of(const Skipped& one) {
    return one.why;
}
std::string why_of(const MarkedImage& one) {
    return words_of(one);
}

template <typename Image>
std::vector<PagePart> parts_of_images(const std::vector<Image>& images) {
    constexpr std::size_t kMostRows = 200;
    if (images.empty()) return {};
    PageList items;
    for (std::size_t i = 0; i < std::min(images.size(), kMostRows); ++i)
        items.emplace_back(images[i].image, why_of(images[i]));
    std::vector<PagePart> parts{std::move(items)};
    if (images.size() > kMostRows) {
        parts.emplace_back(fmt::format("The first {} of {}; {} lists all.",
                                       kMostRows,
                                       grouped(images.size()),
                                       kCorrectionNotes));
    }
    return parts;
}

std::vector<PagePart> rig(const LightAt& light) {
    if (light.toml.empty()) return {};
    return {PageSource{light.toml}};
}

std::string title_of(const LightAt& light) {
    return light.title.empty() ? "Corrected survey" : light.title;
}

}  // namespace

std::string correction_html(const Survey& survey,
                            const CorrectionReport& report,
                            PageFigures sheet) {
    const RunOutcome& run = *report.run;
    const std::string title = title_of(survey.light);
    return page_html(
        {.kind = "corrected survey",
         .title = "Correction: " + title,
         .heading = title,
         .is_good = run.skipped.empty() && report.looks_wrong.empty(),
         .headline = headline(report),
         .said = {fmt::format("{} in this run, which took {} s; {} kept from earlier runs.",
                              grouped(run.corrected),
                              plain(std::round(10.0 * report.seconds) / 10.0),
                              grouped(run.kept))},
         .warnings = warnings(report),
         .sections = {
             {.id = "images",
              .heading = "Before and after",
              .parts = before_and_after(std::move(sheet))},
             {.id = "light",
              .heading = "Light over altitude",
              .parts = light_over_altitude(report.looks)},
             {.id = "pattern",
              .heading = "What stays in place",
              .parts = parts_of(report.pattern,
                                static_cast<std::size_t>(cells_across(survey.light.size.width_px,
                                                                      survey.light.size.height_px)),
                                survey.light.size)},
             {.id = "gain", .heading = "Gain", .parts = {gains(report)}},
             {.id = "doubts", .heading = "Doubtful pixels", .parts = {doubts(run)}},
             {.id = "skipped", .heading = "Skipped images", .parts = parts_of_images(run.skipped)},
             {.id = "dropouts",
              .heading = "Not lit by all strobes",
              .parts = parts_of_images(run.marked)},
             {.id = "rig", .heading = "Rig", .parts = rig(survey.light)}}});
}

}  // namespace aphotic
