// SPDX-License-Identifier: BSD-3-Clause
//
// The page is well-formed XML too, so that a strict reader finds what a browser would forgive.
#include "base/atomic_file.h"
#include "image/preview.h"
#include "report/html.h"
#include "report/page_style.h"
#include "report/svg.h"
#include "validation/error_view.h"
#include "validation/report.h"
#include "validation/report_pictures.h"
#include "validation/report_plots.h"
#include "validation/report_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace aphotic {
namespace {

// Under this the browser shows a picture's pixels as squares.
constexpr int kSmallPicture_px = 400;

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
                           counted(worst.not_finite, "sample"),
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

std::size_t failures(const ValidationReport& report) {
    const auto fails = [](const Comparison& comparison) { return !comparison.holds(); };
    return static_cast<std::size_t>(std::ranges::count_if(report.wavelengths, fails) +
                                    std::ranges::count_if(report.channels, fails));
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

std::string verdict(const ValidationReport& report) {
    const std::size_t all = report.wavelengths.size() + report.channels.size();
    const std::string summary =
        report.holds() ? fmt::format("POV-Ray’s images agree with the reference in all {}.",
                                     counted(all, "comparison"))
                       : fmt::format("POV-Ray’s images and the reference disagree in {} of {}.",
                                     grouped(failures(report)),
                                     counted(all, "comparison"));
    return fmt::format(
        "<div class=\"verdict {}\" id=\"verdict\">\n<p class=\"word\">{}</p>\n<p>{} "
        "{}</p>\n<p>{}</p>\n</div>\n",
        report.holds() ? "holds" : "fails",
        report.holds() ? "✓ Holds" : "✗ Does not hold",
        summary,
        worst_in_words(report),
        edges_in_words(report));
}

std::string header(const ValidationReport& report) {
    return fmt::format(
        "<header>\n<p class=\"eyebrow\">Aphotic · validation</p>\n<h1>{}</h1>\n{}</header>\n\n",
        user_text(title_of(report)),
        verdict(report));
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
                "<figure><img class=\"{}\" width=\"{}\" height=\"{}\" alt=\"{}\" src=\"{}\"/>"
                "<figcaption>{}</figcaption></figure>\n",
                image.width_px < kSmallPicture_px ? "picture squares" : "picture",
                image.width_px,
                image.height_px,
                alt,
                data_uri(preview_png(image, scale)),
                caption);
        };
    return fmt::format(
        "<div class=\"pair\">\n{}{}</div>\n{}",
        figure(block_means(report.rendered, side),
               "image through POV-Ray",
               fmt::format("<strong>POV-Ray</strong>, integrated from {}",
                           counted(report.wavelengths.size(), "wavelength"))),
        figure(traced,
               "image by the reference tracer",
               fmt::format("<strong>Reference</strong>, over {}",
                           counted(report.grid_size, "wavelength"))),
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
                        .set_apart = "on edges: " + counted(channel.on_edges, "pixel"),
                        .row = profile_index(report, ProfileLine::Row),
                        .column = profile_index(report, ProfileLine::Column),
                        .bar_id = "colour-bar"}));
}

std::string stroke_key(std::string_view style, std::string_view words) {
    return fmt::format(
        "<span class=\"key\"><svg class=\"stroke\" viewBox=\"0 0 34 12\"><path class=\"{}\" "
        "d=\"M2 6L32 6\"/></svg> {}</span>\n",
        style,
        words);
}

std::string profile_legend() {
    return "<p class=\"legend\">" + stroke_key("reference", "reference") +
           stroke_key("rendered", "POV-Ray") + stroke_key("bound", "bound of the error") + "</p>\n";
}

std::string profiles(const ValidationReport& report) {
    std::string content = html_paragraph(
        "Both renderers over each other through the middle of the image; beneath each channel, "
        "its relative error pixel by pixel. The upper scale is the angle off the camera’s axis" +
        std::string(report.rig.camera.port ? ", before the port bends it." : "."));
    for (const ProfileLine line : {ProfileLine::Row, ProfileLine::Column}) {
        content += fmt::format("<figure class=\"plot\"><h3>{} {}</h3>\n{}{}</figure>\n",
                               line == ProfileLine::Row ? "Row" : "Column",
                               profile_index(report, line),
                               profile_legend(),
                               profile_svg(report, line));
    }
    return content;
}

std::string errors_plot(const ValidationReport& report) {
    return fmt::format("<figure class=\"plot\"><p class=\"legend\">{}{}{}{}</p>\n{}</figure>\n",
                       stroke_key("error largest", "largest"),
                       stroke_key("error percentile", "99.9 percentile"),
                       stroke_key("error rms", "root mean square"),
                       stroke_key("bound", "bound"),
                       errors_svg(report));
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
               "render’s own lamps. The 99.9 percentile and the root mean square "
               "are of |<i>e</i>|, the mean is "
               "of <i>e</i> with its sign.");
}

std::string table_row(const Comparison& comparison) {
    const double share = share_of_bound(comparison);
    return fmt::format(
        "<tr class=\"{}\"><th scope=\"row\">{}</th><td>{}</td><td>{}, {}</td><td>{}</td><td>{}</td>"
        "<td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>"
        "<td class=\"mark\">{}</td></tr>\n",
        comparison.holds() ? "holds" : "fails",
        user_text(comparison.name),
        scientific(comparison.max_error),
        comparison.column,
        comparison.row,
        scientific(comparison.percentile_999),
        scientific(comparison.rms_error),
        scientific(comparison.mean_error),
        grouped(comparison.compared),
        grouped(comparison.on_edges),
        comparison.on_edges == 0 ? "–" : scientific(comparison.max_error_on_edges),
        grouped(comparison.not_finite),
        scientific(comparison.bound),
        scientific(share),
        comparison.holds() ? "✓ holds" : "✗ fails");
}

std::string table(std::string_view id,
                  std::string_view first_column,
                  const std::vector<Comparison>& comparisons) {
    std::string rows;
    for (const Comparison& comparison : comparisons) rows += table_row(comparison);
    return fmt::format(
        "<div class=\"wide\"><table id=\"{}\">\n<thead><tr><th>{}</th><th>largest |<i>e</i>|</th>"
        "<th class=\"at\">at column, row</th><th>99.9 "
        "%</th><th>rms</th><th>mean</th><th>compared</th>"
        "<th>on edges</th><th>largest on edges</th><th>not finite</th><th>bound</th>"
        "<th>largest / bound</th><th "
        "class=\"mark\">verdict</th></tr></thead>\n<tbody>\n{}</tbody>\n"
        "</table></div>\n",
        id,
        first_column,
        rows);
}

std::string numbers(const ValidationReport& report) {
    return sample_rule() + errors_plot(report) + "<h3>Channels</h3>\n" +
           table("channels", "channel", report.channels) + "<h3>Wavelengths</h3>\n" +
           table("wavelengths", "wavelength", report.wavelengths);
}

std::string made_with(const ValidationReport& report) {
    const auto item = [](std::string_view term, const std::string& words) {
        return fmt::format("<dt>{}</dt><dd>{}</dd>\n", term, words);
    };
    const auto seconds = [](double value) { return fmt::format("{:.2f} s", value); };
    return "<dl class=\"rig\">\n" + item("Aphotic", escaped(report.aphotic_version)) +
           item("POV-Ray", escaped(report.povray_version)) +
           item("Rendering",
                fmt::format("{} for {}, {} at once: {}",
                            counted(report.frames, "frame"),
                            counted(report.wavelengths.size(), "wavelength"),
                            report.jobs,
                            seconds(report.render_s))) +
           item("Integrating", seconds(report.integrate_s)) +
           item("Tracing",
                fmt::format("the reference, over {}: {}",
                            counted(report.grid_size, "wavelength"),
                            seconds(report.trace_s))) +
           item("Rig", fmt::format("SHA-256 <code>{}</code>", escaped(report.rig.digest))) +
           "</dl>\n";
}

}  // namespace

void write_validation_html(const ValidationReport& report, const std::filesystem::path& file) {
    report.check();
    std::string page = header(report);
    page += html_section("rig", "The rig", rig_in_words(report.rig, report.scene_file));
    page += html_section("images", "Both images", images(report));
    page += map_section(report);
    page += html_section("profiles", "Profiles", profiles(report));
    page += html_section("numbers", "Errors", numbers(report));
    page += html_section("made-with", "Made with", made_with(report));
    const std::string title =
        title_of(report) + (report.holds() ? ": validation holds" : ": validation does not hold");
    write_text_file(file, html_page(title, kReportStyle, page));
}

}  // namespace aphotic
