// SPDX-License-Identifier: BSD-3-Clause
//
// report.html: the results of a validation, as a page.
#include "base/atomic_file.h"
#include "image/preview.h"
#include "report/html.h"
#include "report/page.h"
#include "rig/camera/lens.h"
#include "spectral/refractive_index.h"
#include "validation/error_view.h"
#include "validation/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace aphotic {
namespace {

std::string title_of(const ValidationReport& report) {
    return report.rig.title.empty() ? "Untitled rig" : report.rig.title;
}

// "550 nm" or "channel R"
std::string name_of(const ValidationReport& report, const Comparison& comparison) {
    const bool is_channel = std::ranges::any_of(
        report.channels, [&](const Comparison& channel) { return &channel == &comparison; });
    return (is_channel ? "channel " : "") + comparison.name;
}

std::string worst_in_words(const ValidationReport& report) {
    const Comparison& worst = report.worst();
    const std::string name = name_of(report, worst);
    if (worst.not_finite > 0) {
        return fmt::format("Worst is {}: {} {} not finite.",
                           name,
                           grouped_count(worst.not_finite, "sample"),
                           worst.not_finite == 1 ? "is" : "are");
    }
    return fmt::format(
        "{} {}: its largest relative error is {}, {} times its "
        "bound of {}, at column {}, row {}.",
        report.holds() ? "Closest to its bound is" : "Worst is",
        name,
        scientific(worst.max_error),
        scientific(share_of_bound(worst)),
        scientific(worst.bound),
        worst.column,
        worst.row);
}

std::string edges_in_words(const ValidationReport& report) {
    constexpr double kPercent = 100.0;
    const EdgeSummary edges = report.edges();
    std::string words = edges.share == 0.0
                            ? "No pixel is on an edge."
                            : fmt::format(
                                  "Up to {} % of the pixels are on edges, which have no bound; the "
                                  "largest relative error there is {}.",
                                  scientific(kPercent * edges.share),
                                  scientific(edges.max_error));
    if (edges.share_in_penumbrae > 0.0) {
        words += fmt::format(
            " {} % are in the penumbrae of emitters, where the reference uses the render’s own "
            "lamps; an emitter of more lamps differs by up to {}.",
            scientific(kPercent * edges.share_in_penumbrae),
            scientific(edges.max_error_of_penumbrae));
    }
    return words;
}

// States, before any number, that two different scenes were compared.
std::vector<std::string> other_scene(const ValidationReport& report) {
    if (report.scene_file.empty()) return {};
    return {fmt::format(
        "POV-Ray rendered {}, a scene of the user’s own. The reference does not read it: it traced "
        "the floor and the objects of the rig.",
        named(report.scene_file))};
}

std::vector<std::string> verdict(const ValidationReport& report) {
    const std::vector<const Comparison*> all = report.all();
    const auto held = static_cast<std::size_t>(std::ranges::count_if(all, &Comparison::holds));
    const std::string summary =
        report.holds() ? fmt::format("POV-Ray’s images agree with the reference in all {}.",
                                     grouped_count(all.size(), "comparison"))
                       : fmt::format("POV-Ray’s images and the reference disagree in {} of {}.",
                                     grouped(all.size() - held),
                                     grouped_count(all.size(), "comparison"));
    std::vector<std::string> said{summary + " " + worst_in_words(report), edges_in_words(report)};
    if (report.has_veil()) {
        said.push_back(veil_in_words(report.veil_share) + ".");
        said.back().front() = 'V';
    }
    return said;
}

// Both images on the reference's scale.
std::vector<PagePart> images(const ValidationReport& report) {
    const int side = block_side(report.traced.width_px, report.traced.height_px);
    const CameraImage traced = block_means(report.traced, side);
    const auto scale =
        preview_scale(traced, report.lamp_signal, {.white = PreviewWhite::Lamp, .stops = 0.0});
    const auto figure = [&](const CameraImage& image, std::string words, std::string caption) {
        return PageFigure{.pictures = {{.bytes = preview_png(image, scale),
                                        .width_px = image.width_px,
                                        .height_px = image.height_px,
                                        .words = std::move(words)}},
                          .caption = std::move(caption)};
    };
    return {
        PageFigures{
            .figures = {figure(block_means(report.rendered, side),
                               "image through POV-Ray",
                               fmt::format("POV-Ray, integrated from {}",
                                           grouped_count(report.wavelengths.size(), "wavelength"))),
                        figure(traced,
                               "image by the reference tracer",
                               fmt::format("Reference, over {}",
                                           grouped_count(report.grid_size, "wavelength")))}},
        fmt::format("The camera’s signals at the same exposure and white: the lamps’ own light "
                    "is grey, channels are shown as sRGB. Top is forward, right is starboard.{}",
                    side > 1
                        ? fmt::format(" Each point shown is the mean of {0} × {0} pixels.", side)
                        : "")};
}

std::span<const float> plane(const std::vector<float>& samples, std::size_t channel) {
    const std::size_t size = samples.size() / kChannels;
    return std::span(samples).subspan(channel * size, size);
}

PageSection map_section(const ValidationReport& report) {
    const std::size_t c = report.worst_channel();
    const Comparison& channel = report.channels[c];
    return {.id = "error-map",
            .heading = fmt::format("Relative error of channel {}, the worst", channel.name),
            .parts = error_map_parts(
                {.comparison = &channel,
                 .errors = plane(report.channel_errors, c),
                 .image = plane(report.rendered.samples, c),
                 .reference = plane(report.traced.samples, c),
                 .width_px = report.traced.width_px,
                 .image_name = "POV-Ray",
                 .set_apart = "on edges: " + grouped_count(channel.on_edges, "pixel")})};
}

Profile profile_of(const ValidationReport& report, std::size_t c, bool is_row) {
    const auto width = static_cast<std::size_t>(report.traced.width_px);
    const auto height = static_cast<std::size_t>(report.traced.height_px);
    Profile profile{.channel = std::string(kChannelNames[c]), .bound = report.channels[c].bound};
    for (std::size_t i = 0; i < (is_row ? width : height); ++i) {
        const std::size_t pixel = is_row ? height / 2 * width + i : i * width + width / 2;
        const std::size_t at = c * width * height + pixel;
        profile.position_px.push_back(static_cast<double>(i) + 0.5);
        profile.image.push_back(report.rendered.samples[at]);
        profile.reference.push_back(report.traced.samples[at]);
        profile.errors.push_back(report.channel_errors[at]);
    }
    return profile;
}

std::vector<PagePart> profiles(const ValidationReport& report) {
    std::vector<PagePart> parts{
        "Profiles of both renderers through the middle of the image; below each channel, its "
        "relative error at each pixel.",
        PageLegend{stroke_key("reference", "reference"),
                   stroke_key("rendered", "POV-Ray"),
                   stroke_key("bound", "bound of the error")}};
    for (const bool is_row : {true, false}) {
        std::vector<Profile> channels;
        for (std::size_t c = 0; c < kChannels; ++c) {
            channels.push_back(profile_of(report, c, is_row));
        }
        const int width_px = report.traced.width_px;
        const int height_px = report.traced.height_px;
        parts.emplace_back(PageHeading{
            fmt::format("{} {}", is_row ? "Row" : "Column", (is_row ? height_px : width_px) / 2)});
        parts.emplace_back(profile_plot(is_row ? "profile-row" : "profile-column",
                                        is_row,
                                        is_row ? width_px : height_px,
                                        channels));
    }
    return parts;
}

PageTable table(std::string first_column, const std::vector<Comparison>& comparisons) {
    PageTable made{.columns = {std::move(first_column),
                               "largest |e|",
                               "at column, row",
                               "99.9 %",
                               "rms",
                               "mean",
                               "compared",
                               "on edges",
                               "largest on edges",
                               "not finite",
                               "bound",
                               "largest / bound",
                               ""}};
    for (const Comparison& c : comparisons) {
        made.rows.push_back({.cells = {c.name,
                                       scientific(c.max_error),
                                       fmt::format("{}, {}", c.column, c.row),
                                       scientific(c.percentile_999),
                                       scientific(c.rms_error),
                                       scientific(c.mean_error),
                                       grouped(c.compared),
                                       grouped(c.on_edges),
                                       c.on_edges == 0 ? "–" : scientific(c.max_error_on_edges),
                                       grouped(c.not_finite),
                                       scientific(c.bound),
                                       scientific(share_of_bound(c)),
                                       c.holds() ? "✓ holds" : "✗ fails"},
                             .tone = c.holds() ? PageTone::Good : PageTone::Bad});
    }
    return made;
}

std::vector<PagePart> numbers(const ValidationReport& report) {
    std::vector<PagePart> parts =
        error_rule("POV-Ray’s sample",
                   "the reference’s sample",
                   "what counts as black: below it, errors are relative to it");
    parts.emplace_back(
        "A comparison holds when the largest |e| off the edges is within its bound and every "
        "sample, on edges too, is finite. No factor is fitted: the absolute scale is part of it. "
        "On the edge of a cone, of a shadow or of an object’s face, where rounding or dispersion "
        "puts a pixel on both sides, samples are counted and measured on their own. In the "
        "penumbra of an emitter with a size, b is traced with the render’s own lamps. The 99.9 "
        "percentile and the root mean square are of |e|, the mean is of e with its sign.");
    parts.emplace_back(PageHeading{"Channels"});
    parts.emplace_back(table("channel", report.channels));
    parts.emplace_back(PageHeading{"Wavelengths"});
    parts.emplace_back(table("wavelength", report.wavelengths));
    return parts;
}

// The ratio, with the standard error of the truth.
std::string ratio_to(double model, const Estimate& truth) {
    if (!(truth.mean > 0.0)) return "–";
    return fmt::format("{:.4f} ± {:.4f}", model / truth.mean, truth.standard_error / truth.mean);
}

std::vector<PagePart> model_check(const ModelCheck& model) {
    if (model.places.empty()) return {};
    PageTable made{
        .columns = {"channel", "nm", "column, row", "share of the veil", "floor", "veil", "sum"}};
    for (const ModelPlace& place : model.places) {
        made.rows.push_back(
            {.cells = {std::string(kChannelNames[place.channel]),
                       fmt::format("{:.1f}", place.lambda_nm),
                       fmt::format("{}, {}", place.column, place.row),
                       fmt::format("{:.3f}", place.veil / (place.floor + place.veil)),
                       ratio_to(place.floor, place.truth.floor),
                       ratio_to(place.veil, place.truth.veil),
                       ratio_to(place.floor + place.veil, place.truth.sum)}});
    }
    return {
        fmt::format(
            "The reference’s single scattering over light of all orders, by {} random paths for "
            "each place: 1 means that the model leaves nothing out. ± is one standard error.",
            grouped(model.paths)),
        std::move(made)};
}

// The part of the floor in view if it is level, which is not in the rig file.
std::string field_of_view(const Rig& rig) {
    const Camera& camera = rig.camera;
    const double middle_nm = (camera.range.first_nm + camera.range.last_nm) / 2.0;
    const double index =
        camera.port ? seawater_index(middle_nm, rig.water.salinity_psu, rig.water.temperature_c)
                    : 1.0;
    const double width = camera.width_px;
    const double height = camera.height_px;
    // Between opposite edges' middles.
    const auto half_rad =
        [&](const Eigen::Vector2d& from_px, const Eigen::Vector2d& to_px, double in_index) {
            const double cosine = direction_in_air(camera, from_px.x(), from_px.y())
                                      .dot(direction_in_air(camera, to_px.x(), to_px.y()));
            return std::asin(std::sin(std::acos(std::min(1.0, cosine)) / 2.0) / in_index);
        };
    const auto across_rad = [&](double in_index) {
        return half_rad({0.0, height / 2.0}, {width, height / 2.0}, in_index);
    };
    const auto along_rad = [&](double in_index) {
        return half_rad({width / 2.0, 0.0}, {width / 2.0, height}, in_index);
    };
    const auto field = [&](double in_index) {
        constexpr double kFullDegrees = 360.0 / std::numbers::pi;
        return fmt::format("{:.1f}° × {:.1f}°",
                           kFullDegrees * across_rad(in_index),
                           kFullDegrees * along_rad(in_index));
    };
    const auto floor_m = [&](double half_view_rad) {
        return 2.0 * rig.sled.altitude_m * std::tan(half_view_rad);
    };
    return (camera.port ? fmt::format("{} in air, {} in the water (at {} nm)",
                                      field(1.0),
                                      field(index),
                                      plain(middle_nm))
                        : field(1.0)) +
           fmt::format(", or about {:.2g} m × {:.2g} m of a level floor",
                       floor_m(across_rad(index)),
                       floor_m(along_rad(index)));
}

std::vector<PagePart> rig_as_read(const ValidationReport& report) {
    PageList items{{"Field of view", field_of_view(report.rig)},
                   {"SHA-256, of the rig and its files", report.rig.digest}};
    for (const auto& [name, sha256] : report.rig.files) {
        std::pair<std::string, std::string> item{name, "SHA-256 " + sha256};
        if (std::ranges::find(items, item) == items.end()) items.push_back(std::move(item));
    }
    return {std::move(items), PageSource{report.rig.toml}};
}

PageList made_with(const ValidationReport& report) {
    const auto seconds = [](double value) { return fmt::format("{:.2f} s", value); };
    return {{"Aphotic", report.aphotic_version},
            {"POV-Ray", report.povray_version},
            {"Rendering",
             fmt::format("{} for {}, {} at once: {}",
                         grouped_count(report.frames, "frame"),
                         grouped_count(report.wavelengths.size(), "wavelength"),
                         report.jobs,
                         seconds(report.render_s))},
            {"Integrating", seconds(report.integrate_s)},
            {"Tracing",
             fmt::format("the reference, over {}: {}",
                         grouped_count(report.grid_size, "wavelength"),
                         seconds(report.trace_s))}};
}

}  // namespace

void write_validation_html(const ValidationReport& report, const std::filesystem::path& file) {
    const Page page{
        .kind = "validation",
        .title = title_of(report) +
                 (report.holds() ? ": validation holds" : ": validation does not hold"),
        .heading = title_of(report),
        .is_good = report.holds(),
        .headline = report.holds() ? "✓ Holds" : "✗ Does not hold",
        .said = verdict(report),
        .warnings = other_scene(report),
        .sections = {
            {.id = "images", .heading = "Both images", .parts = images(report)},
            map_section(report),
            {.id = "profiles", .heading = "Profiles", .parts = profiles(report)},
            {.id = "numbers", .heading = "Errors", .parts = numbers(report)},
            {.id = "model", .heading = "Light of all orders", .parts = model_check(report.model)},
            {.id = "rig", .heading = "The rig", .parts = rig_as_read(report)},
            {.id = "made-with", .heading = "Made with", .parts = {made_with(report)}}}};
    write_text_file(file, page_html(page));
}

}  // namespace aphotic
