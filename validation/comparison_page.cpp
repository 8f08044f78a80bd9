// SPDX-License-Identifier: BSD-3-Clause
#include "validation/comparison_page.h"

#include "image/preview.h"
#include "report/html.h"
#include "report/page.h"
#include "report/svg.h"
#include "validation/error_view.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace aphotic {
namespace {

// A channel by blocks; NaN where no sample was observed.
struct Blocks {
    int side = 1;
    int across = 0;
    int down = 0;
    std::vector<double> image;
    std::vector<double> reference;
};

// For pictures of half a page's width. Two pixels or more if some were not observed, so that a
// block of a mosaic contains every colour.
int side_of(const ComparedImages& images) {
    const bool is_whole = std::ranges::all_of(images.channels, [](const ComparedChannel& channel) {
        return channel.comparison.unobserved == 0;
    });
    return std::max(block_side(2 * images.width_px, 2 * images.height_px), is_whole ? 1 : 2);
}

Blocks blocks_of(const ComparedChannel& channel, const ComparedImages& images) {
    const int side = side_of(images);
    return {.side = side,
            .across = (images.width_px + side - 1) / side,
            .down = (images.height_px + side - 1) / side,
            .image = block_means(channel.image, images.width_px, side, channel.marks),
            .reference = block_means(channel.reference, images.width_px, side, channel.marks)};
}

std::vector<PagePart> patterns(const Blocks& blocks, const ComparedImages& images) {
    ValueRange range;
    range.include(blocks.image);
    range.include(blocks.reference);
    if (range.is_empty()) return {"No sample was observed in both."};
    const auto figure = [&](const std::vector<double>& values,
                            std::string words,
                            std::string caption) {
        std::vector<std::uint32_t> pixels;
        for (const double value : values) {
            const double share = (value - range.least) / std::max(range.most - range.least, 1e-300);
            pixels.push_back(std::isfinite(value) ? false_colour(share) : kNotFiniteColour);
        }
        return PageFigure{.pictures = {{.bytes = png_of(pixels, blocks.across, blocks.down),
                                        .width_px = blocks.across,
                                        .height_px = blocks.down,
                                        .words = std::move(words)}},
                          .caption = std::move(caption)};
    };
    return {PageFigures{.figures = {figure(blocks.image,
                                           "the image in false colours",
                                           named(images.image) +
                                               (images.scaled ? ", divided by its scale" : "")),
                                    figure(blocks.reference,
                                           "the reference in false colours",
                                           named(images.reference))}},
            fmt::format(
                "From {:.4g}, dark blue, to {:.4g}, yellow, in both.", range.least, range.most)};
}

// For each sample, by the rule; samples never observed are marked.
std::vector<PagePart> differences(const ComparedChannel& channel,
                                  const ComparedImages& images,
                                  int side) {
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    std::vector<float> errors;
    std::vector<float> image = channel.image;
    std::vector<float> reference = channel.reference;
    for (std::size_t i = 0; i < image.size(); ++i) {
        if (!channel.marks.empty() && channel.marks[i] == kUnobserved) {
            image[i] = reference[i] = 0.0F;  // neither compared nor a fault
            errors.push_back(kNaN);
        } else {
            errors.push_back(
                static_cast<float>(relative_error(image[i], reference[i], channel.black)));
        }
    }
    const Comparison& c = channel.comparison;
    return error_map_parts(
        {.comparison = &c,
         .errors = errors,
         .image = image,
         .reference = reference,
         .width_px = images.width_px,
         .least_side = side,
         .image_name = "the image",
         .set_apart =
             c.unobserved > 0 ? "not observed: " + grouped_count(c.unobserved, "sample") : ""});
}

PagePlot profile(const Blocks& blocks, const std::string& channel, bool is_row, int pixels) {
    Profile profile{.channel = channel};
    const int count = is_row ? blocks.across : blocks.down;
    for (int i = 0; i < count; ++i) {
        const auto block = static_cast<std::size_t>(is_row ? blocks.down / 2 * blocks.across + i
                                                           : i * blocks.across + blocks.across / 2);
        profile.position_px.push_back((i + 0.5) * blocks.side);
        profile.image.push_back(blocks.image[block]);
        profile.reference.push_back(blocks.reference[block]);
    }
    const std::string id = fmt::format("{}-{}", is_row ? "row" : "column", escaped(channel));
    return profile_plot(id, is_row, pixels, {&profile, 1});
}

PageSection section(const ComparedImages& images, std::size_t number) {
    const ComparedChannel& channel = images.channels[number];
    const std::string& name = channel.comparison.name;
    const Blocks blocks = blocks_of(channel, images);
    PageSection made{.id = fmt::format("channel-{}", number + 1),
                     .heading = name,
                     .parts = patterns(blocks, images)};
    made.parts.emplace_back(PageHeading{"Relative error"});
    std::ranges::move(differences(channel, images, side_of(images)),
                      std::back_inserter(made.parts));
    made.parts.emplace_back(PageHeading{"Profiles through the middle"});
    made.parts.emplace_back(
        PageLegend{stroke_key("reference", "reference"), stroke_key("rendered", "image")});
    made.parts.emplace_back(profile(blocks, name, true, images.width_px));
    made.parts.emplace_back(profile(blocks, name, false, images.height_px));
    return made;
}

PageTable table(const ComparedImages& images) {
    PageTable made{.columns = {"channel",
                               "scale",
                               "black",
                               "largest |e|",
                               "at column, row",
                               "99.9 %",
                               "rms",
                               "mean",
                               "compared",
                               "not observed",
                               "not finite"}};
    for (const ComparedChannel& channel : images.channels) {
        const Comparison& c = channel.comparison;
        made.rows.push_back({.cells = {c.name,
                                       fmt::format("{:.6g}", channel.scale),
                                       scientific(channel.black),
                                       scientific(c.max_error),
                                       fmt::format("{}, {}", c.column, c.row),
                                       scientific(c.percentile_999),
                                       scientific(c.rms_error),
                                       scientific(c.mean_error),
                                       grouped(c.compared),
                                       grouped(c.unobserved),
                                       grouped(c.not_finite)},
                             .tone = c.holds() ? PageTone::Good : PageTone::Bad});
    }
    return made;
}

PageList not_compared(const ComparedImages& images) {
    PageList items;
    const auto add = [&](const std::string& term, const std::vector<std::string>& channels) {
        if (!channels.empty())
            items.emplace_back(term, fmt::format("{}", fmt::join(channels, ", ")));
    };
    add("Only in " + named(images.image), images.only_in_image);
    add("Only in " + named(images.reference), images.only_in_reference);
    add("Not compared", images.left_aside);
    return items;
}

PageSection numbers(const ComparedImages& images) {
    PageSection made{
        .id = "numbers",
        .heading = "Errors",
        .parts = error_rule(images.scaled ? "the image’s sample, divided by its channel’s scale"
                                          : "the image’s sample",
                            "the reference’s sample",
                            fmt::format("what counts as black, {} of the reference’s largest "
                                        "sample: below it, errors are relative to it",
                                        scientific(images.black)))};
    made.parts.emplace_back(table(images));
    if (PageList left = not_compared(images); !left.empty()) {
        made.parts.emplace_back(PageHeading{"Channels not compared"});
        made.parts.emplace_back(std::move(left));
    }
    return made;
}

}  // namespace

std::uint32_t false_colour(double share) {
    // Even steps of Matplotlib's viridis, S. van der Walt and N. Smith, 2015, CC0.
    constexpr std::array<std::uint32_t, 9> kStops{
        0x440154, 0x472D7B, 0x3B528B, 0x2C728E, 0x21918C, 0x28AE80, 0x5EC962, 0xADDC30, 0xFDE725};
    return colour_between(kStops, share);
}

std::string comparison_html(const ComparedImages& images) {
    Page page{.kind = "comparison",
              .title = "Comparison of " + images.image,
              .heading = named(images.image) + " and " + named(images.reference),
              .is_good = images.holds(),
              .headline = fmt::format("{} is {} {} of {}{}.",
                                      named(images.image),
                                      images.are_within() ? "within" : "not within",
                                      scientific(images.channels.front().comparison.bound),
                                      named(images.reference),
                                      images.scaled ? ", apart from its scale" : ""),
              .sections = {numbers(images)}};
    if (images.unpaired() > 0) {
        page.said.push_back(fmt::format("But {} without a partner in the other image.",
                                        grouped_count(images.unpaired(), "channel")));
    }
    for (std::size_t i = 0; i < images.channels.size(); ++i)
        page.sections.push_back(section(images, i));
    return page_html(page);
}

}  // namespace aphotic
