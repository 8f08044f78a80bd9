// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic compare A B: the difference of image A from the reference B, channel by channel; and the
// accuracy of patches of known colour in A.
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/words.h"
#include "cli/command.h"
#include "cli/options.h"
#include "cli/outcome.h"
#include "cli/terminal.h"
#include "validation/image_comparison.h"
#include "validation/patch_score.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <memory>
#include <optional>

namespace aphotic::cli {
namespace {

struct CompareCommandOptions {
    ComparisonRequest request;
    std::string scale;    // as entered by the user
    std::string patches;  // a file
    std::string encoding = "linear";
    std::string output;
    std::string report;
    bool json = false;
};

struct Compared {
    std::string image;
    std::optional<ComparedImages> images{};  // empty without a reference
    std::optional<PatchScores> patches{};
    double bound = 0.0;
    std::string scale;  // "image", "per-channel", or empty
};

nlohmann::ordered_json images_json(const Compared& compared) {
    const ComparedImages& images = *compared.images;
    nlohmann::ordered_json json{{"image", images.image},
                                {"reference", images.reference},
                                {"bound", compared.bound},
                                {"black", images.black},
                                {"holds", images.holds()},
                                {"only_in_image", images.only_in_image},
                                {"only_in_reference", images.only_in_reference},
                                {"left_aside", images.left_aside},
                                {"channels", nlohmann::ordered_json::array()}};
    if (images.scaled) json["scaled"] = compared.scale;
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

nlohmann::ordered_json to_json(const Compared& compared) {
    nlohmann::ordered_json json{{"image", compared.image}};
    if (compared.images) json = images_json(compared);
    if (compared.patches) json["patches"] = to_json(*compared.patches);
    return json;
}

void print_channel(const ComparedChannel& channel, bool scaled) {
    const Comparison& c = channel.comparison;
    std::string notes;
    if (scaled) notes += fmt::format("  / {:.6g}", channel.scale);
    if (c.unobserved > 0) notes += fmt::format("  {} not observed", c.unobserved);
    if (c.not_finite > 0) notes += fmt::format("  {} not finite", c.not_finite);
    if (!c.holds()) notes += "  <-- out of bounds";
    say("{:>18}  {:9.2e}  {:9.2e}  {:9.2e}  {:9.1e}  {}, {}{}\n",
        c.name,
        c.max_error,
        c.percentile_999,
        c.rms_error,
        c.mean_error,
        c.column,
        c.row,
        notes);
}

void print_unpaired(const ComparedImages& images) {
    const auto print = [](const std::vector<std::string>& channels, const std::string& words) {
        if (!channels.empty()) say("{}: {}\n", words, fmt::join(channels, " "));
    };
    print(images.only_in_image, "only in " + images.image);
    print(images.only_in_reference, "only in " + images.reference);
    print(images.left_aside, "not compared");
}

std::string figure(const std::optional<double>& value) {
    return value ? fmt::format("{:.3f}", *value) : "-";
}

void print_patches(const PatchScores& scores) {
    say("{:>18}  {:>9}  {:>9}  {:>9}  {:>9}  {:>9}\n",
        "patch",
        "R",
        "G",
        "B",
        "deg grey",
        "dE 2000");
    for (const PatchScore& patch : scores.patches) {
        say("{:>18}  {:>9.4g}  {:>9.4g}  {:>9.4g}  {:>9}  {:>9}\n",
            patch.name,
            patch.signal[0],
            patch.signal[1],
            patch.signal[2],
            figure(patch.degrees),
            figure(patch.difference));
    }
    const auto print_both = [](const char* what,
                               const std::optional<double>& mean,
                               const std::optional<double>& median) {
        if (mean) say("{}: mean {:.3f}, median {:.3f}\n", what, *mean, *median);
    };
    print_both("degrees from grey", scores.mean_degrees, scores.median_degrees);
    print_both("CIEDE2000", scores.mean_difference, scores.median_difference);
    say("unevenness: {:.3f} % rms\n", 100.0 * scores.unevenness);
}

void print_images(const Compared& compared) {
    const ComparedImages& images = *compared.images;
    say("{:>18}  {:>9}  {:>9}  {:>9}  {:>9}  worst pixel{}\n",
        "",
        "max |e|",
        "99.9 %",
        "rms",
        "mean",
        images.scaled ? "  / scale" : "");
    for (const ComparedChannel& channel : images.channels) print_channel(channel, images.scaled);
    print_unpaired(images);
    say("{} is {} {:.3g} of {}{}\n",
        images.image,
        images.are_within() ? "within" : "NOT within",
        compared.bound,
        images.reference,
        images.scaled ? ", apart from its scale" : "");
    if (images.unpaired() > 0) {
        say("but {} WITHOUT a partner in the other image; --channels names those to compare\n",
            counted(images.unpaired(), "channel"));
    }
}

void print(const Compared& compared) {
    if (compared.images) print_images(compared);
    if (compared.patches) print_patches(*compared.patches);
}

ExitStatus compare(const CompareCommandOptions& options) {
    const std::map<std::string, ComparedScale> scales{
        {"", ComparedScale::None},
        {"image", ComparedScale::OfImage},
        {"per-channel", ComparedScale::OfEachChannel}};
    ComparisonRequest request = options.request;
    request.scale = scales.at(options.scale);
    request.keep_samples = !options.report.empty();
    if (request.reference.empty() && options.patches.empty()) {
        throw InputError("found no REFERENCE; allowed: an image to judge IMAGE by, or --patches");
    }
    if (request.reference.empty() && !options.report.empty()) {
        throw InputError("--report: found no REFERENCE; allowed: with an image to judge IMAGE by");
    }
    Compared compared{.image = request.image, .bound = request.bound, .scale = options.scale};
    if (!request.reference.empty()) compared.images = compare_images(request);
    if (!options.patches.empty()) {
        compared.patches = score_patches({.image = request.image,
                                          .patches = options.patches,
                                          .scale = request.scale,
                                          .is_srgb = options.encoding == "srgb"});
    }
    if (!options.output.empty()) write_text_file(options.output, json_text(to_json(compared)));
    if (!options.report.empty()) write_text_file(options.report, comparison_html(*compared.images));
    show(compared, options.json);
    return !compared.images || compared.images->holds() ? kDone : kAnswerIsNo;
}

}  // namespace

Action configure_compare(CLI::App& app) {
    const auto options = std::make_shared<CompareCommandOptions>();
    ComparisonRequest& request = options->request;
    add_option(app, "IMAGE", request.image)->required();
    add_option(app, "REFERENCE", request.reference);
    add_option(app, "--bound", request.bound)->check(not_negative());
    add_option(app, "--black", request.black)->check(in_range(0.0, 1.0));
    add_option(app, "--channels", request.channels);
    add_flag(app, "--scale", options->scale)->check(CLI::IsMember({"image", "per-channel"}));
    CLI::Option* patches = add_option(app, "--patches", options->patches);
    add_option(app, "--encoding", options->encoding)
        ->check(CLI::IsMember({"linear", "srgb"}))
        ->needs(patches);
    add_option(app, "--output", options->output);
    add_option(app, "--report", options->report);
    add_json(app, options->json);
    return [options] { return compare(*options); };
}

}  // namespace aphotic::cli
