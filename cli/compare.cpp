// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic compare A B: how far image A is from the reference B, channel by channel.
#include "cli/any_image.h"
#include "cli/command.h"
#include "cli/outcome.h"
#include "spectral/atomic_file.h"
#include "spectral/error.h"
#include "validation/comparison.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace aphotic::cli {
namespace {

struct Options {
    std::string image;
    std::string reference;
    double bound = 6e-4;
    double black = 1e-6;
    std::string output;
    bool json = false;
};

std::vector<std::string> common_channels(const AnyImage& a, const AnyImage& b) {
    std::vector<std::string> common;
    std::ranges::copy_if(a.channels, std::back_inserter(common), [&](const std::string& name) {
        return std::ranges::find(b.channels, name) != b.channels.end();
    });
    return common;
}

std::vector<float> samples_of(const AnyImage& image, const std::string& channel) {
    const auto found = std::ranges::find(image.channels, channel);
    return image.samples(static_cast<std::size_t>(found - image.channels.begin()));
}

std::vector<Comparison> compare_images(const Options& options) {
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
    const std::vector<std::string> channels = common_channels(a, b);
    if (channels.empty()) {
        throw InputError(fmt::format("{} has the channels {}, {} has {}: none in common",
                                     options.image,
                                     fmt::join(a.channels, ", "),
                                     options.reference,
                                     fmt::join(b.channels, ", ")));
    }
    std::vector<Comparison> comparisons;
    for (const std::string& channel : channels) {
        const std::vector<float> found = samples_of(a, channel);
        const std::vector<float> wanted = samples_of(b, channel);
        float brightest = 0.0F;
        for (const float sample : wanted) {
            if (std::isfinite(sample)) brightest = std::max(brightest, std::abs(sample));
        }
        comparisons.push_back(compare_planes(channel,
                                             found,
                                             std::vector<double>(wanted.begin(), wanted.end()),
                                             a.width_px,
                                             {},
                                             options.black * brightest,
                                             options.bound));
    }
    return comparisons;
}

nlohmann::ordered_json json_of(const Options& options,
                               const std::vector<Comparison>& comparisons,
                               bool holds) {
    nlohmann::ordered_json json{{"image", options.image},
                                {"reference", options.reference},
                                {"bound", options.bound},
                                {"black", options.black},
                                {"holds", holds},
                                {"channels", nlohmann::ordered_json::array()}};
    for (const Comparison& c : comparisons) {
        json["channels"].push_back({{"name", c.name},
                                    {"holds", c.holds()},
                                    {"max_error", c.max_error},
                                    {"column", c.column},
                                    {"row", c.row},
                                    {"percentile_99_9", c.percentile_999},
                                    {"rms_error", c.rms_error},
                                    {"mean_error", c.mean_error},
                                    {"compared", c.compared},
                                    {"not_finite", c.not_finite}});
    }
    return json;
}

ExitStatus compare(const Options& options) {
    const std::vector<Comparison> comparisons = compare_images(options);
    const bool holds = std::ranges::all_of(comparisons, &Comparison::holds);
    const std::string json = dumped(json_of(options, comparisons, holds)) + "\n";
    if (!options.output.empty()) write_text_file(options.output, json);
    if (options.json) {
        fmt::print("{}", json);
        return holds ? kDone : kAnswerIsNo;
    }
    fmt::print("{:>18}  {:>9}  {:>9}  {:>9}  {:>9}  worst pixel\n",
               "",
               "max |e|",
               "99.9 %",
               "rms",
               "mean");
    for (const Comparison& c : comparisons) {
        fmt::print("{:>18}  {:9.2e}  {:9.2e}  {:9.2e}  {:9.1e}  {}, {}{}{}\n",
                   c.name,
                   c.max_error,
                   c.percentile_999,
                   c.rms_error,
                   c.mean_error,
                   c.column,
                   c.row,
                   c.not_finite > 0 ? fmt::format("  {} not finite", c.not_finite) : "",
                   c.holds() ? "" : "  <-- out of bounds");
    }
    fmt::print("{} is {} {:.3g} of {}\n",
               options.image,
               holds ? "within" : "NOT within",
               options.bound,
               options.reference);
    return holds ? kDone : kAnswerIsNo;
}

}  // namespace

Action configure_compare(CLI::App& app) {
    const auto options = std::make_shared<Options>();
    app.add_option("IMAGE", options->image, "the image in question, in any format of OpenImageIO")
        ->required();
    app.add_option("REFERENCE", options->reference, "what it should be")->required();
    app.add_option("--bound", options->bound, "the largest |e| that is allowed")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    app.add_option("--black",
                   options->black,
                   "what counts as black, as a share of the reference's largest sample")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    app.add_option("-o,--output", options->output, "write the numbers as JSON to FILE")
        ->type_name("FILE");
    app.add_flag("--json", options->json, "print the numbers as JSON");
    app.footer(
        "For every channel that both have, e = (a - b) / max(|b|, black). Exit status 0 when all\n"
        "|e| are within the bound, 1 when not.");
    return [options] { return compare(*options); };
}

}  // namespace aphotic::cli
