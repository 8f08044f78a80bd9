// SPDX-License-Identifier: BSD-3-Clause
//
// The page is well-formed XML too, so that a strict reader finds what a browser would forgive.
#include "base/atomic_file.h"
#include "image/preview.h"
#include "report/html.h"
#include "rig/lens.h"
#include "spectral/refractive_index.h"
#include "validation/error_view.h"
#include "validation/report.h"
#include "validation/report_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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
    return (is_channel ? "channel " : "") + user_text(comparison.name);
}

std::string worst_in_words(const ValidationReport& report) {
    const Comparison& worst = report.worst();
    const std::string name = name_of(report, worst);
    if (worst.not_finite > 0) {
        return fmt::format("Worst is <strong>{}</strong>: {} {} not finite.",
                           name,
                           grouped_count(worst.not_finite, "sample"),
                           worst.not_finite == 1 ? "is" : "are");
    }
    return fmt::format(
        "{} <strong>{}</strong>: its largest relative error is <strong>{}</strong>, {} times its "
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
    std::string words =
        edges.share == 0.0
            ? "No pixel is on an edge."
            : fmt::format(
                  "On edges, which have no bound, are up to {} % of the pixels; the largest "
                  "relative error there is <strong>{}</strong>.",
                  scientific(kPercent * edges.share),
                  scientific(edges.max_error));
    if (edges.share_in_penumbrae > 0.0) {
        words += fmt::format(
            " In the penumbrae of emitters are {} %: these are compared with the render’s own "
            "lamps. From an emitter of more lamps they differ by up to {}.",
            scientific(kPercent * edges.share_in_penumbrae),
            scientific(edges.max_error_of_penumbrae));
    }
    return words;
}

std::string veil_paragraph(const ValidationReport& report) {
    if (!report.has_veil()) return "";
    std::string words = veil_in_words(report.veil_share);
    words.front() = 'V';
    return html_paragraph(words + ".");
}

std::string verdict(const ValidationReport& report) {
    const std::vector<const Comparison*> all = report.all();
    const auto held = static_cast<std::size_t>(std::ranges::count_if(all, &Comparison::holds));
    const std::string summary =
        report.holds() ? fmt::format("POV-Ray’s images agree with the reference in all {}.",
                                     grouped_count(all.size(), "comparison"))
                       : fmt::format("POV-Ray’s images and the reference disagree in {} of {}.",
                                     grouped(all.size() - held),
                                     grouped_count(all.size(), "comparison"));
    return html_verdict(
        report.holds(),
        report.holds() ? "✓ Holds" : "✗ Does not hold",
        fmt::format(
            "<p>{} {}</p>\n<p>{}</p>\n", summary, worst_in_words(report), edges_in_words(report)) +
            veil_paragraph(report));
}

// That two different scenes were compared has to be known before any number.
std::string other_scene(const ValidationReport& report) {
    if (report.scene_file.empty()) return "";
    return html_paragraph(fmt::format(
        "POV-Ray rendered <code>{}</code>, a scene of the user’s own. The reference does not read "
        "it: it traced the floor and the objects of the rig.",
        escaped(report.scene_file)));
}

// Both under the reference's scale.
std::string images(const ValidationReport& report) {
    const int side = block_side(report.traced.width_px, report.traced.height_px);
    const CameraImage traced = block_means(report.traced, side);
    const auto scale =
        preview_scale(traced, report.lamp_signal, {.white = PreviewWhite::Lamp, .stops = 0.0});
    const auto figure =
        [&](const CameraImage& image, std::string_view alt, std::string_view caption) {
            return fmt::format(
                "<figure>{}<figcaption>{}</figcaption></figure>\n",
                picture_html(preview_png(image, scale), image.width_px, image.height_px, alt),
                caption);
        };
    return fmt::format(
        "<div class=\"pair\">\n{}{}</div>\n{}",
        figure(block_means(report.rendered, side),
               "image through POV-Ray",
               fmt::format("<strong>POV-Ray</strong>, integrated from {}",
                           grouped_count(report.wavelengths.size(), "wavelength"))),
        figure(traced,
               "image by the reference tracer",
               fmt::format("<strong>Reference</strong>, over {}",
                           grouped_count(report.grid_size, "wavelength"))),
        html_paragraph(fmt::format(
            "The camera’s signals at the same exposure and white: the lamps’ "
            "own light is "
            "grey, channels are shown as sRGB. Top is forward, right is starboard.{}",
            side > 1 ? fmt::format(" Shown by means of {0} × {0} pixels.", side) : "")));
}

std::span<const float> plane(const std::vector<float>& samples, std::size_t channel) {
    const std::size_t size = samples.size() / kChannels;
    return std::span(samples).subspan(channel * size, size);
}

std::string map_section(const ValidationReport& report) {
    const std::size_t c = report.worst_channel();
    const Comparison& channel = report.channels[c];
    return html_section(
        "error-map",
        fmt::format("Relative error of channel {}, the worst", escaped(channel.name)),
        error_map_html({.comparison = &channel,
                        .errors = plane(report.channel_errors, c),
                        .image = plane(report.rendered.samples, c),
                        .reference = plane(report.traced.samples, c),
                        .width_px = report.traced.width_px,
                        .image_name = "POV-Ray",
                        .set_apart = "on edges: " + grouped_count(channel.on_edges, "pixel"),
                        .bar_id = "colour-bar"}));
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

std::string profiles(const ValidationReport& report) {
    std::string content =
        html_paragraph(
            "Both renderers over each other through the middle of the image; beneath each channel, "
            "its relative error pixel by pixel.") +
        html_legend(html_stroke_key("reference", "reference") +
                    html_stroke_key("rendered", "POV-Ray") +
                    html_stroke_key("bound", "bound of the error"));
    for (const bool is_row : {true, false}) {
        std::vector<Profile> channels;
        for (std::size_t c = 0; c < kChannels; ++c) {
            channels.push_back(profile_of(report, c, is_row));
        }
        const int width_px = report.traced.width_px;
        const int height_px = report.traced.height_px;
        content += fmt::format("<h3>{} {}</h3>\n{}",
                               is_row ? "Row" : "Column",
                               (is_row ? height_px : width_px) / 2,
                               profile_html(is_row ? "profile-row" : "profile-column",
                                            is_row,
                                            is_row ? width_px : height_px,
                                            channels));
    }
    return content;
}

std::string sample_rule() {
    return error_rule("POV-Ray’s sample",
                      "the reference’s sample",
                      "what counts as black: under it a difference is measured against it") +
           html_paragraph(
               "A comparison holds when the largest |<i>e</i>| off the edges is within its bound "
               "and "
               "every sample, on edges too, is finite. No factor is fitted: the absolute scale is "
               "part of it. On the edge of a cone, of a shadow or of an object’s face, where "
               "rounding or dispersion puts a pixel on both sides, samples are counted and "
               "measured "
               "on their own. In the penumbra of an emitter with a size, <i>b</i> is traced with "
               "the "
               "render’s own lamps. The 99.9 percentile and the root mean square are of "
               "|<i>e</i>|, "
               "the mean is of <i>e</i> with its sign.");
}

std::string table(std::string_view id,
                  std::string_view first_column,
                  const std::vector<Comparison>& comparisons) {
    const std::string columns =
        std::string(first_column) +
        ";largest |e|;at column, row;99.9 %;rms;mean;compared;on edges;largest on edges;not finite;"
        "bound;largest / bound;";
    std::vector<HtmlRow> rows;
    for (const Comparison& c : comparisons) {
        rows.push_back({.style = c.holds() ? "holds" : "fails",
                        .cells = {user_text(c.name),
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
                                  c.holds() ? "✓ holds" : "✗ fails"}});
    }
    return html_table(id, columns, rows);
}

std::string numbers(const ValidationReport& report) {
    return sample_rule() + "<h3>Channels</h3>\n" + table("channels", "channel", report.channels) +
           "<h3>Wavelengths</h3>\n" + table("wavelengths", "wavelength", report.wavelengths);
}

// With the standard error of the truth.
std::string ratio_to(double model, const Estimate& truth) {
    if (!(truth.mean > 0.0)) return "–";
    return fmt::format("{:.4f} ± {:.4f}", model / truth.mean, truth.standard_error / truth.mean);
}

std::string model_check(const ModelCheck& model) {
    std::vector<HtmlRow> rows;
    for (const ModelPlace& place : model.places) {
        rows.push_back({.style = "holds",
                        .cells = {std::string(kChannelNames[place.channel]),
                                  fmt::format("{:.1f}", place.lambda_nm),
                                  fmt::format("{}, {}", place.column, place.row),
                                  fmt::format("{:.3f}", place.veil / (place.floor + place.veil)),
                                  ratio_to(place.floor, place.truth.floor),
                                  ratio_to(place.veil, place.truth.veil),
                                  ratio_to(place.floor + place.veil, place.truth.sum)}});
    }
    return html_paragraph(fmt::format(
               "The reference’s single scattering over light of all orders, by {} random paths "
               "for each place: 1 is a model that leaves nothing out. ± is one standard error.",
               grouped(model.paths))) +
           html_table(
               "all-orders", "channel;nm;column, row;share of the veil;floor;veil;sum", rows);
}

// What no rig file says: how much of the floor is in view, where that is level.
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
           fmt::format(", or some {:.2g} m × {:.2g} m of a level floor",
                       floor_m(across_rad(index)),
                       floor_m(along_rad(index)));
}

std::string rig_as_read(const ValidationReport& report) {
    std::vector<HtmlItem> items{{"Field of view", field_of_view(report.rig)},
                                {"SHA-256, of the rig and its files",
                                 fmt::format("<code>{}</code>", escaped(report.rig.digest))}};
    for (const auto& [name, sha256] : report.rig.files) {
        HtmlItem item{user_text(name), fmt::format("SHA-256 <code>{}</code>", sha256)};
        if (std::ranges::find(items, item) == items.end()) items.push_back(std::move(item));
    }
    return html_list("rig-files", items) + html_source(report.rig.toml);
}

std::string made_with(const ValidationReport& report) {
    const auto seconds = [](double value) { return fmt::format("{:.2f} s", value); };
    const std::array<HtmlItem, 5> items{
        {{"Aphotic", escaped(report.aphotic_version)},
         {"POV-Ray", escaped(report.povray_version)},
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
                      seconds(report.trace_s))}}};
    return html_list("programs", items);
}

}  // namespace

void write_validation_html(const ValidationReport& report, const std::filesystem::path& file) {
    report.check();
    std::string page = html_header(
        "validation", user_text(title_of(report)), verdict(report) + other_scene(report));
    page += html_section("images", "Both images", images(report));
    page += map_section(report);
    page += html_section("profiles", "Profiles", profiles(report));
    page += html_section("numbers", "Errors", numbers(report));
    if (!report.model.places.empty())
        page += html_section("model", "Light of all orders", model_check(report.model));
    page += html_section("rig", "The rig", rig_as_read(report));
    page += html_section("made-with", "Made with", made_with(report));
    const std::string title =
        title_of(report) + (report.holds() ? ": validation holds" : ": validation does not hold");
    write_text_file(file, html_page(title, page));
}

}  // namespace aphotic
