// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic compare A B: how far image A is from the reference B, channel by channel.
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/words.h"
#include "cli/channel_pairs.h"
#include "cli/command.h"
#include "cli/option_checks.h"
#include "cli/outcome.h"
#include "image/any_image.h"
#include "validation/comparison_page.h"
#include "validation/scaling.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

namespace aphotic::cli {
namespace {

struct CompareCommandOptions {
    std::string image;
    std::string reference;
    double bound = 6e-4;
    double black = 1e-6;
    std::optional<std::string> channels;  // that the user names
    std::string scale;                    // "image", "per-channel", or none
    std::string output;
    std::string report;
    bool json = false;
};

bool has_channel(const AnyImage& image, const std::string& channel) {
    return std::ranges::find(image.channels, channel) != image.channels.end();
}

ChannelPairs channels_of(const AnyImage& a,
                         const AnyImage& b,
                         const CompareCommandOptions& options) {
    ChannelPairs pairs = options.channels
                             ? named_channels(*options.channels, a.channels, b.channels)
                             : pair_channels(a.channels, b.channels, !options.scale.empty());
    if (!pairs.compared.empty()) return pairs;
    throw InputError(fmt::format("{} has the channels {}, {} has {}: none in common",
                                 options.image,
                                 fmt::join(a.channels, ", "),
                                 options.reference,
                                 fmt::join(b.channels, ", ")));
}

std::vector<float> samples_of(const AnyImage& image, const std::string& channel) {
    const auto found = std::ranges::find(image.channels, channel);
    return image.samples(static_cast<std::size_t>(found - image.channels.begin()));
}

// Marks what either image says that it never observed.
std::vector<unsigned char> unobserved_in(const AnyImage& a,
                                         const AnyImage& b,
                                         const ChannelPair& channel) {
    std::vector<unsigned char> marks;
    for (const auto& [image, name] :
         {std::pair(&a, channel.image), std::pair(&b, channel.reference)}) {
        const std::string count = "count." + name;
        if (!has_channel(*image, count)) continue;
        const std::vector<float> counts = samples_of(*image, count);
        marks.resize(counts.size(), 0);
        for (std::size_t i = 0; i < counts.size(); ++i) {
            if (counts[i] == 0.0F) marks[i] = kUnobserved;
        }
    }
    return marks;
}

// Of every channel, the same or each its own.
std::vector<double> scales_of(const AnyImage& a,
                              const AnyImage& b,
                              const std::vector<ChannelPair>& channels,
                              const CompareCommandOptions& options) {
    if (options.scale.empty()) return std::vector<double>(channels.size(), 1.0);
    std::vector<Scaling> scalings(options.scale == "image" ? 1 : channels.size());
    for (std::size_t c = 0; c < channels.size(); ++c) {
        scalings[std::min(c, scalings.size() - 1)].add(samples_of(a, channels[c].image),
                                                       samples_of(b, channels[c].reference),
                                                       unobserved_in(a, b, channels[c]));
    }
    std::vector<double> scales;
    for (std::size_t c = 0; c < channels.size(); ++c) {
        scales.push_back(scalings[std::min(c, scalings.size() - 1)].scale());
        if (!(scales.back() > 0.0)) {
            throw InputError(
                fmt::format("{}: channel {} is {:.3g} times that of {}; --scale "
                            "needs a positive factor",
                            options.image,
                            channels[c].image,
                            scales.back(),
                            options.reference));
        }
    }
    return scales;
}

ComparedChannel compare_channel(const AnyImage& a,
                                const AnyImage& b,
                                const ChannelPair& pair,
                                double scale,
                                const CompareCommandOptions& options) {
    ComparedChannel channel{.comparison = {},
                            .scale = scale,
                            .image = samples_of(a, pair.image),
                            .reference = samples_of(b, pair.reference),
                            .marks = unobserved_in(a, b, pair)};
    if (scale != 1.0) {
        for (float& sample : channel.image) sample = static_cast<float>(sample / scale);
    }
    float brightest = 0.0F;
    for (const float sample : channel.reference) {
        if (std::isfinite(sample)) brightest = std::max(brightest, std::abs(sample));
    }
    channel.black = options.black * brightest;
    channel.comparison =
        compare_planes(pair.image,
                       channel.image,
                       std::vector<double>(channel.reference.begin(), channel.reference.end()),
                       a.width_px,
                       channel.marks,
                       channel.black,
                       options.bound);
    return channel;
}

// Without a report the samples of a channel are let go before the next is read.
ComparedImages compare_images(const CompareCommandOptions& options) {
    const AnyImage a = open_any_image(options.image);
    const AnyImage b = open_any_image(options.reference);
    if (a.width_px != b.width_px || a.height_px != b.height_px) {
        throw InputError(fmt::format("{}: found {} x {} pixels; allowed: {} x {}, as in {}",
                                     options.image,
                                     a.width_px,
                                     a.height_px,
                                     b.width_px,
                                     b.height_px,
                                     options.reference));
    }
    const ChannelPairs pairs = channels_of(a, b, options);
    const std::vector<ChannelPair>& channels = pairs.compared;
    const std::vector<double> scales = scales_of(a, b, channels, options);
    ComparedImages images{.image = options.image,
                          .reference = options.reference,
                          .width_px = a.width_px,
                          .height_px = a.height_px,
                          .black = options.black,
                          .scaled = !options.scale.empty(),
                          .channels = {},
                          .only_in_image = pairs.only_in_image,
                          .only_in_reference = pairs.only_in_reference,
                          .left_aside = pairs.left_aside};
    for (std::size_t c = 0; c < channels.size(); ++c) {
        ComparedChannel channel = compare_channel(a, b, channels[c], scales[c], options);
        if (options.report.empty()) {
            channel.image = {};
            channel.reference = {};
            channel.marks = {};
        }
        images.channels.push_back(std::move(channel));
    }
    return images;
}

nlohmann::ordered_json json_of(const CompareCommandOptions& options, const ComparedImages& images) {
    nlohmann::ordered_json json{{"image", options.image},
                                {"reference", options.reference},
                                {"bound", options.bound},
                                {"black", options.black},
                                {"holds", images.holds()},
                                {"only_in_image", images.only_in_image},
                                {"only_in_reference", images.only_in_reference},
                                {"left_aside", images.left_aside},
                                {"channels", nlohmann::ordered_json::array()}};
    if (images.scaled) json["scaled"] = options.scale;
    for (const ComparedChannel& channel : images.channels) {
        const Comparison& c = channel.comparison;
        json["channels"].push_back({{"name", c.name},
                                    {"holds", c.holds()},
                                    {"floor", channel.black},
                                    {"max_error", c.max_error},
                                    {"column", c.column},
                                    {"row", c.row},
                                    {"percentile_999", c.percentile_999},
                                    {"rms_error", c.rms_error},
                                    {"mean_error", c.mean_error},
                                    {"compared", c.compared},
                                    {"unobserved", c.unobserved},
                                    {"not_finite", c.not_finite}});
        if (images.scaled) json["channels"].back()["scale"] = channel.scale;
    }
    return json;
}

void print_channel(const ComparedChannel& channel, bool scaled) {
    const Comparison& c = channel.comparison;
    std::string notes;
    if (scaled) notes += fmt::format("  / {:.6g}", channel.scale);
    if (c.unobserved > 0) notes += fmt::format("  {} not observed", c.unobserved);
    if (c.not_finite > 0) notes += fmt::format("  {} not finite", c.not_finite);
    if (!c.holds()) notes += "  <-- out of bounds";
    fmt::print("{:>18}  {:9.2e}  {:9.2e}  {:9.2e}  {:9.1e}  {}, {}{}\n",
               c.name,
               c.max_error,
               c.percentile_999,
               c.rms_error,
               c.mean_error,
               c.column,
               c.row,
               notes);
}

void print_unpaired(const CompareCommandOptions& options, const ComparedImages& images) {
    const auto print = [](const std::vector<std::string>& channels, const std::string& words) {
        if (!channels.empty()) fmt::print("{}: {}\n", words, fmt::join(channels, " "));
    };
    print(images.only_in_image, "only in " + options.image);
    print(images.only_in_reference, "only in " + options.reference);
    print(images.left_aside, "left aside");
}

void print_verdict(const CompareCommandOptions& options, const ComparedImages& images) {
    fmt::print("{} is {} {:.3g} of {}{}\n",
               options.image,
               images.are_within() ? "within" : "NOT within",
               options.bound,
               options.reference,
               images.scaled ? ", but for its scale" : "");
    if (images.unpaired() > 0) {
        fmt::print(
            "but {} WITHOUT a partner in the other image; --channels names those to compare\n",
            counted(images.unpaired(), "channel"));
    }
}

ExitStatus compare(const CompareCommandOptions& options) {
    const ComparedImages images = compare_images(options);
    const ExitStatus status = images.holds() ? kDone : kAnswerIsNo;
    const std::string json = dumped(json_of(options, images)) + "\n";
    if (!options.output.empty()) write_text_file(options.output, json);
    if (!options.report.empty()) write_text_file(options.report, comparison_html(images));
    if (options.json) {
        fmt::print("{}", json);
        return status;
    }
    fmt::print("{:>18}  {:>9}  {:>9}  {:>9}  {:>9}  worst pixel{}\n",
               "",
               "max |e|",
               "99.9 %",
               "rms",
               "mean",
               images.scaled ? "  / scale" : "");
    for (const ComparedChannel& channel : images.channels) print_channel(channel, images.scaled);
    print_unpaired(options, images);
    print_verdict(options, images);
    return status;
}

}  // namespace

Action configure_compare(CLI::App& app) {
    const auto options = std::make_shared<CompareCommandOptions>();
    app.add_option(
           "IMAGE", options->image, "the image in question: EXR, TIFF, PNG, JPEG and others")
        ->required();
    app.add_option("REFERENCE", options->reference, "what it should be")->required();
    app.add_option("--bound", options->bound, "the largest |e| that is allowed")
        ->check(not_negative())
        ->capture_default_str();
    app.add_option("--black",
                   options->black,
                   "what counts as black, as a share of the reference's largest sample")
        ->check(in_range(0.0, 1.0))
        ->capture_default_str();
    app.add_option("--channels",
                   options->channels,
                   "compare these alone, such as R,G,B; by default all, and each is to be in\n"
                   "both images")
        ->type_name("NAMES");
    app.add_flag(
           "--scale{image}",
           options->scale,
           "first divide the image by the factor that fits it to the reference best, one for\n"
           "all channels; --scale=per-channel: each by its own")
        ->check(CLI::IsMember({"image", "per-channel"}));
    app.add_option("-o,--output", options->output, "write the numbers as JSON to FILE")
        ->type_name("FILE");
    app.add_option("--report",
                   options->report,
                   "write a page to FILE: both images in false colours, the errors, profiles")
        ->type_name("FILE.html");
    app.add_flag("--json", options->json, "print the numbers as JSON");
    app.footer(
        "Spectral channels are paired by wavelength, whatever the spelling.\n"
        "For every channel, e = (a - b) / max(|b|, black). Exit status 0 when all |e| are within\n"
        "the bound and every channel is in both images, 1 when not. Opacity and what aphotic "
        "observe\n"
        "says of its averages (count.NAME, stderr.NAME) need no partner. Samples of a count of 0 "
        "were\n"
        "never observed: they are told and not compared.");
    return [options] { return compare(*options); };
}

}  // namespace aphotic::cli
