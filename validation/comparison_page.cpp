// SPDX-License-Identifier: BSD-3-Clause
#include "validation/comparison_page.h"

#include "image/preview.h"
#include "report/html.h"
#include "report/page_style.h"
#include "report/svg.h"
#include "validation/error_view.h"
#include "validation/report_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace aphotic {
namespace {

// A channel by blocks; NaN where nothing was observed.
struct Blocks {
    int side = 1;
    int across = 0;
    int down = 0;
    std::vector<double> image;
    std::vector<double> reference;
};

// For pictures of half a page's width. Two pixels or more where some were not observed: a block of
// a mosaic holds every colour.
int side_of(const ComparedImages& images) {
    const bool is_whole = std::ranges::all_of(images.channels, [](const ComparedChannel& channel) {
        return channel.comparison.unobserved == 0;
    });
    return std::max(block_side(2 * images.width_px, 2 * images.height_px), is_whole ? 1 : 2);
}

Blocks blocks_of(const ComparedChannel& channel, const ComparedImages& images) {
    const int side = side_of(images);
    Blocks blocks{.side = side,
                  .across = (images.width_px + side - 1) / side,
                  .down = (images.height_px + side - 1) / side,
                  .image = {},
                  .reference = {}};
    const auto width = static_cast<std::size_t>(images.width_px);
    const auto span = static_cast<std::size_t>(side);
    const auto across = static_cast<std::size_t>(blocks.across);
    const std::size_t size = across * static_cast<std::size_t>(blocks.down);
    blocks.image.assign(size, 0.0);
    blocks.reference.assign(size, 0.0);
    std::vector<double> counts(size, 0.0);
    for (std::size_t i = 0; i < channel.image.size(); ++i) {
        if (!channel.marks.empty() && channel.marks[i] == kUnobserved) continue;
        const std::size_t column = i % width;
        const std::size_t row = i / width;
        const std::size_t block = row / span * across + column / span;
        blocks.image[block] += channel.image[i];
        blocks.reference[block] += channel.reference[i];
        counts[block] += 1.0;
    }
    for (std::size_t block = 0; block < size; ++block) {
        blocks.image[block] /= counts[block];
        blocks.reference[block] /= counts[block];
    }
    return blocks;
}

struct Range {
    double least = std::numeric_limits<double>::infinity();
    double most = -std::numeric_limits<double>::infinity();

    void include(const std::vector<double>& values) {
        for (const double value : values) {
            if (!std::isfinite(value)) continue;
            least = std::min(least, value);
            most = std::max(most, value);
        }
    }
};

template <typename Colour>
std::string picture(const Blocks& blocks, const std::string& words, const Colour& colour) {
    std::vector<std::uint32_t> pixels;
    for (std::size_t block = 0; block < blocks.image.size(); ++block)
        pixels.push_back(colour(block));
    return fmt::format(
        R"(<img class="picture squares" alt="{0}" width="{1}" height="{2}" src="{3}"/>)",
        words,
        blocks.across,
        blocks.down,
        data_uri(png_of(pixels, blocks.across, blocks.down)));
}

std::string figure(const std::string& content, const std::string& caption) {
    return fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n", content, caption);
}

std::string patterns(const Blocks& blocks, const ComparedImages& images) {
    Range range;
    range.include(blocks.image);
    range.include(blocks.reference);
    const auto shown = [&](const std::vector<double>& values) {
        return [&](std::size_t block) {
            if (!std::isfinite(values[block])) return kNotFiniteColour;
            return false_colour((values[block] - range.least) /
                                std::max(range.most - range.least, 1e-300));
        };
    };
    if (range.least > range.most) return html_paragraph("No sample of both was observed.");
    return fmt::format(
        "<div class=\"pair\">\n{}{}</div>\n{}",
        figure(picture(blocks, "the image in false colours", shown(blocks.image)),
               user_text(images.image) + (images.scaled ? ", divided by its scale" : "")),
        figure(picture(blocks, "the reference in false colours", shown(blocks.reference)),
               user_text(images.reference)),
        html_paragraph(fmt::format(
            "From {:.4g}, dark blue, to {:.4g}, yellow, in both.", range.least, range.most)));
}

// Of each sample, by the rule; what was never observed is set apart.
std::string differences(const ComparedChannel& channel, const ComparedImages& images, int side) {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    std::vector<float> errors;
    std::vector<float> image = channel.image;
    std::vector<float> reference = channel.reference;
    for (std::size_t i = 0; i < image.size(); ++i) {
        if (!channel.marks.empty() && channel.marks[i] == kUnobserved) {
            image[i] = reference[i] = 0.0F;  // neither here nor there, and no fault
            errors.push_back(kNaN);
        } else {
            errors.push_back(
                static_cast<float>(relative_error(image[i], reference[i], channel.black)));
        }
    }
    const Comparison& c = channel.comparison;
    return error_map_html(
        {.comparison = &c,
         .errors = errors,
         .image = image,
         .reference = reference,
         .width_px = images.width_px,
         .least_side = side,
         .image_name = "the image",
         .set_apart = c.unobserved > 0 ? "not observed: " + counted(c.unobserved, "sample") : "",
         .row = images.height_px / 2,
         .column = images.width_px / 2,
         .bar_id = "colour-bar-" + escaped(c.name)});
}

struct Line {
    std::vector<double> position_px;
    std::vector<double> image;
    std::vector<double> reference;
};

Line middle(const Blocks& blocks, bool is_row) {
    Line line;
    const int count = is_row ? blocks.across : blocks.down;
    for (int i = 0; i < count; ++i) {
        const int block =
            is_row ? blocks.down / 2 * blocks.across + i : i * blocks.across + blocks.across / 2;
        line.position_px.push_back((i + 0.5) * blocks.side);
        line.image.push_back(blocks.image[static_cast<std::size_t>(block)]);
        line.reference.push_back(blocks.reference[static_cast<std::size_t>(block)]);
    }
    return line;
}

std::string tone_of(const std::string& channel) {
    constexpr std::array<std::string_view, kChannels> kTones{"red", "green", "blue"};
    const auto found = std::ranges::find(kChannelNames, channel);
    if (found == kChannelNames.end()) return "";
    return std::string(kTones[static_cast<std::size_t>(found - kChannelNames.begin())]);
}

std::string profile(const Blocks& blocks, const std::string& name, bool is_row, int pixels) {
    const Line line = middle(blocks, is_row);
    Range range{.least = 0.0, .most = 0.0};
    range.include(line.image);
    range.include(line.reference);
    if (range.most == range.least) range.most = range.least + 1.0;
    const SvgPanel panel{.left = 92.0,
                         .top = 12.0,
                         .width = 974.0,
                         .height = 200.0,
                         .x = linear_axis(0.0, pixels, 10),
                         .y = linear_axis(range.least, range.most, 5)};
    const std::string tone = tone_of(name);
    std::string svg = svg_grid(panel) + svg_x_labels(panel) + svg_y_labels(panel);
    svg += svg_curve(
        panel, line.position_px, line.reference, fmt::format(R"(class="reference {}")", tone));
    svg +=
        svg_curve(panel, line.position_px, line.image, fmt::format(R"(class="rendered {}")", tone));
    svg +=
        svg_text(panel.left + panel.width / 2.0,
                 panel.bottom() + 36.0,
                 SvgAnchor::Middle,
                 R"(class="axis")",
                 is_row ? "column [px], along the middle row" : "row [px], down the middle column");
    return "<figure class=\"plot\">" +
           svg_drawing(fmt::format("{}-{}", is_row ? "row" : "column", escaped(name)),
                       1080.0,
                       panel.bottom() + 44.0,
                       svg) +
           "</figure>\n";
}

std::string section(const ComparedChannel& channel, const ComparedImages& images) {
    const Blocks blocks = blocks_of(channel, images);
    std::string content = patterns(blocks, images);
    content += "<h3>Relative error</h3>\n" + differences(channel, images, side_of(images));
    content += html_paragraph(
        "Profiles through the middle: the broad pale line is the reference, the dashed one the "
        "image.");
    content += profile(blocks, channel.comparison.name, true, images.width_px);
    content += profile(blocks, channel.comparison.name, false, images.height_px);
    return html_section(
        "channel-" + escaped(channel.comparison.name), escaped(channel.comparison.name), content);
}

std::string table(const ComparedImages& images) {
    std::string rows;
    for (const ComparedChannel& channel : images.channels) {
        const Comparison& c = channel.comparison;
        rows += fmt::format(
            "<tr class=\"{}\"><th>{}</th><td>{:.6g}</td><td>{}</td><td>{}</td><td>{}, {}</td>"
            "<td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
            c.holds() ? "holds" : "fails",
            escaped(c.name),
            channel.scale,
            scientific(channel.black),
            scientific(c.max_error),
            c.column,
            c.row,
            scientific(c.percentile_999),
            scientific(c.rms_error),
            scientific(c.mean_error),
            grouped(c.compared),
            grouped(c.unobserved),
            grouped(c.not_finite));
    }
    return fmt::format(
        "<div class=\"wide\"><table>\n<thead><tr><th>channel</th><th>scale</th>"
        "<th>black</th><th>largest |<i>e</i>|</th><th class=\"at\">at column, row</th>"
        "<th>99.9 %</th><th>rms</th><th>mean</th><th>compared</th>"
        "<th>not observed</th><th>not finite</th></tr></thead>\n<tbody>\n{}</tbody></table></div>"
        "\n",
        rows);
}

std::string verdict(const ComparedImages& images) {
    std::string partners;
    if (images.unpaired() > 0) {
        partners = fmt::format("<p>But {} without a partner in the other image.</p>\n",
                               counted(images.unpaired(), "channel"));
    }
    return fmt::format(
        "<div class=\"verdict {}\" id=\"verdict\">\n<p class=\"word\">{} is {} {} of {}{}.</p>\n"
        "{}</div>\n",
        images.holds() ? "holds" : "fails",
        user_text(images.image),
        images.are_within() ? "within" : "not within",
        scientific(images.channels.front().comparison.bound),
        user_text(images.reference),
        images.scaled ? ", but for its scale" : "",
        partners);
}

std::string not_compared(const ComparedImages& images) {
    std::string list;
    const auto add = [&](const std::string& term, const std::vector<std::string>& channels) {
        std::string names;
        for (const std::string& name : channels)
            names += (names.empty() ? "" : ", ") + escaped(name);
        if (!names.empty()) list += fmt::format("<dt>{}</dt><dd>{}</dd>\n", term, names);
    };
    add("Only in " + user_text(images.image), images.only_in_image);
    add("Only in " + user_text(images.reference), images.only_in_reference);
    add("Left aside", images.left_aside);
    return list.empty()
               ? ""
               : "<h3>Channels not compared</h3>\n<dl id=\"not-compared\">\n" + list + "</dl>\n";
}

std::string image_rule(const ComparedImages& images) {
    return error_rule(
        images.scaled ? "the image’s sample, divided by its channel’s scale" : "the image’s sample",
        "the reference’s sample",
        fmt::format("what counts as black, {} of the reference’s largest sample: under it a "
                    "difference is measured against it",
                    scientific(images.black)));
}

}  // namespace

std::uint32_t false_colour(double share) {
    // Even steps of Matplotlib's viridis, S. van der Walt and N. Smith, 2015, CC0.
    constexpr std::array<std::uint32_t, 9> kStops{
        0x440154, 0x472D7B, 0x3B528B, 0x2C728E, 0x21918C, 0x28AE80, 0x5EC962, 0xADDC30, 0xFDE725};
    const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(kStops.size() - 1);
    const auto stop = std::min(static_cast<std::size_t>(place), kStops.size() - 2);
    const double beyond = place - static_cast<double>(stop);
    std::uint32_t colour = 0;
    for (const unsigned shift : {16U, 8U, 0U}) {
        const double from = kStops.at(stop) >> shift & 0xFFU;
        const double to = kStops.at(stop + 1) >> shift & 0xFFU;
        colour |= static_cast<std::uint32_t>(std::lround(std::lerp(from, to, beyond))) << shift;
    }
    return colour;
}

std::string comparison_html(const ComparedImages& images) {
    std::string content = fmt::format(
        "<header>\n<p class=\"eyebrow\">Aphotic · comparison</p>\n<h1>{} and {}</h1>\n{}"
        "</header>\n{}",
        user_text(images.image),
        user_text(images.reference),
        verdict(images),
        image_rule(images));
    content += table(images) + not_compared(images);
    for (const ComparedChannel& channel : images.channels) content += section(channel, images);
    return html_page("Comparison of " + images.image, kReportStyle, content);
}

}  // namespace aphotic
