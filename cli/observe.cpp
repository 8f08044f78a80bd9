// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic observe IMAGES... --nav FILE -o MAP.exr: the images of one altitude averaged into the
// pattern of light that they share.
#include "base/error.h"
#include "base/in_order.h"
#include "base/progress.h"
#include "base/words.h"
#include "cli/command.h"
#include "cli/options.h"
#include "cli/outcome.h"
#include "image/exr.h"
#include "survey/navigation.h"
#include "survey/observation.h"
#include "survey/survey_files.h"
#include "survey/survey_image.h"
#include "survey/survey_look.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <thread>

namespace aphotic::cli {
namespace {

struct ObserveCommandOptions {
    std::vector<std::string> images;
    std::string navigation;
    std::string output;
    double altitude_m = 0.0;
    double within_m = 0.1;
    Average average = Average::Mean;
    double trim = 0.1;
    bool normalise = false;
    bool demosaic = false;
    CameraNumbers camera;
    double memory_mb = 1000.0;
    int jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    bool strict = false;
    bool json = false;
};

const std::map<std::string, Average> kAverages{
    {"mean", Average::Mean}, {"median", Average::Median}, {"trimmed", Average::Trimmed}};

std::string name_of(Average average) {
    return std::ranges::find(kAverages, average, &std::pair<const std::string, Average>::second)
        ->first;
}

// The images at the altitude, and what became of the others.
struct Selection {
    std::vector<std::filesystem::path> images;
    std::vector<Sled> sleds;
    std::size_t outside = 0;
    double nearest_m = std::numeric_limits<double>::infinity();  // from the altitude, of those
    std::vector<Skipped> skipped;
};

// NaN stands for what the navigation does not tell: there is no rig here to take it from.
Sled known_of(Sled sled, const Navigation& navigation) {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    if (!navigation.has_pitch()) sled.pitch_rad = kUnknown;
    if (!navigation.has_roll()) sled.roll_rad = kUnknown;
    return sled;
}

Selection selected(const ObserveCommandOptions& options) {
    constexpr double kRounding_m = 1e-9;  // 2.1 lies within 0.1 of 2
    const Navigation navigation = read_navigation(options.navigation, Sled{});
    Selection selection;
    for (const SurveyFile& file : survey_files(options.images, options.output)) {
        try {
            const Sled& sled = navigation.pose_of(file.source).sled;
            const double off_m = std::abs(sled.altitude_m - options.altitude_m);
            if (off_m > options.within_m + kRounding_m) {
                ++selection.outside;
                selection.nearest_m = std::min(selection.nearest_m, off_m);
                continue;
            }
            selection.images.push_back(file.source);
            selection.sleds.push_back(known_of(sled, navigation));
        } catch (const InputError& error) {
            selection.skipped.push_back({.image = file.source.string(), .why = error.what()});
        }
    }
    return selection;
}

// Goes through the images in their order, and drops from the selection what cannot be used.
class Pass {
  public:
    Pass(const ObserveCommandOptions& options, Selection& selection)
        : options_(options), selection_(selection) {}

    // use(index, image); share: of all passes, where this one begins and ends.
    template <typename Use>
    void run(const Use& use, double from, double to) {
        std::vector<std::size_t> bad;
        const std::size_t count = selection_.images.size();
        in_order(
            count,
            options_.jobs,
            [&](std::size_t i) { return read_image(selection_.images[i]); },
            [&](std::size_t i, const RawImage& image) {
                if (first_.width_px == 0) first_ = like(image);
                require_size(image, first_.width_px, first_.height_px, "as the first image");
                use(i, image);
                line_.show(
                    "averaging",
                    from + (to - from) * static_cast<double>(i + 1) / static_cast<double>(count));
            },
            [&](std::size_t i, const std::string& why) {
                selection_.skipped.push_back({.image = selection_.images[i].string(), .why = why});
                bad.push_back(i);
            });
        for (; !bad.empty(); bad.pop_back()) {
            const auto at = static_cast<std::ptrdiff_t>(bad.back());
            selection_.images.erase(selection_.images.begin() + at);
            selection_.sleds.erase(selection_.sleds.begin() + at);
        }
    }

    // The first image's size and mosaic, without its samples.
    [[nodiscard]] const RawImage& first() const { return first_; }

  private:
    [[nodiscard]] RawImage read_image(const std::filesystem::path& file) const {
        RawImage image = without_black(read_survey_image(file, options_.camera));
        if (std::ranges::any_of(image.samples, [](float s) { return std::isinf(s); }))
            throw InputError("a sample is infinite");
        if (options_.normalise) divide_by_own_mean(image);
        return image;
    }

    static RawImage like(const RawImage& image) {
        return {.width_px = image.width_px,
                .height_px = image.height_px,
                .mosaic = image.mosaic,
                .samples = {}};
    }

    const ObserveCommandOptions& options_;
    Selection& selection_;
    RawImage first_;
    ProgressLine line_;
};

Observed mean_of(Pass& pass) {
    std::optional<RunningMean> mean;
    pass.run(
        [&](std::size_t, const RawImage& image) {
            if (!mean) mean.emplace(image.samples.size());
            mean->add(image.samples);
        },
        0.0,
        1.0);
    return mean ? mean->observed() : Observed{};
}

void append(std::vector<float>& to, const std::vector<float>& from) {
    to.insert(to.end(), from.begin(), from.end());
}

// Every image is read once for each band of samples, as many as fit in memory of all images. A
// first pass finds which images can be used at all.
Observed ranked_by_bands(Pass& pass, Selection& selection, const ObserveCommandOptions& options) {
    std::size_t samples = 0;
    pass.run([&](std::size_t, const RawImage& image) { samples = image.samples.size(); }, 0.0, 0.1);
    const std::size_t band = samples_in_memory(selection.images.size(), options.memory_mb);
    Observed observed;
    for (std::size_t first = 0; first < samples; first += band) {
        const std::size_t many = std::min(band, samples - first);
        std::vector<std::vector<float>> images;
        const std::size_t skipped = selection.skipped.size();
        const auto share = [&](std::size_t at) {
            return 0.1 + 0.9 * static_cast<double>(at) / static_cast<double>(samples);
        };
        pass.run(
            [&](std::size_t, const RawImage& image) {
                const auto from = image.samples.begin() + static_cast<std::ptrdiff_t>(first);
                images.emplace_back(from, from + static_cast<std::ptrdiff_t>(many));
            },
            share(first),
            share(first + many));
        if (selection.skipped.size() > skipped) {
            throw RunError(fmt::format("{}: changed while it was read: {}",
                                       selection.skipped.back().image,
                                       selection.skipped.back().why));
        }
        const Observed part = average_of(images, options.average, options.trim, options.jobs);
        append(observed.average, part.average);
        append(observed.standard_error, part.standard_error);
        append(observed.count, part.count);
    }
    return observed;
}

Sled mean_of(const std::vector<Sled>& sleds) {
    Sled mean;
    const auto count = static_cast<double>(sleds.size());
    for (const Sled& sled : sleds) {
        mean.altitude_m += sled.altitude_m / count;
        mean.pitch_rad += sled.pitch_rad / count;
        mean.roll_rad += sled.roll_rad / count;
    }
    return mean;
}

double degrees(double radians) {
    return radians * 180.0 / std::numbers::pi;
}

void write_map(const ObserveCommandOptions& options,
               const Observed& observed,
               const RawImage& like,
               std::size_t images,
               const Sled& sled) {
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    std::vector<float> planes =
        options.demosaic && like.mosaic != Mosaic::None
            ? demosaiced(observed.average, like.width_px, like.height_px, like.mosaic)
            : by_channel(observed.average, like, kNone);
    append(planes, by_channel(observed.count, like, 0.0F));
    append(planes, by_channel(observed.standard_error, like, kNone));
    std::vector<std::string> channels;
    for (const std::string_view prefix : {"", "count.", "stderr."}) {
        for (const std::string_view name : kChannelNames)
            channels.push_back(fmt::format("{}{}", prefix, name));
    }
    ExrWriter exr(options.output,
                  like.width_px,
                  like.height_px,
                  channels,
                  {{"aphotic:version", APHOTIC_VERSION},
                   {"aphotic:average", name_of(options.average)},
                   {"aphotic:images", fmt::format("{}", images)},
                   {"aphotic:altitude_m", fmt::format("{}", sled.altitude_m)},
                   {"aphotic:pitch_deg", fmt::format("{}", degrees(sled.pitch_rad))},
                   {"aphotic:roll_deg", fmt::format("{}", degrees(sled.roll_rad))}});
    exr.write_rows(like.height_px, planes);
    exr.finish();
}

// The root mean square of the standard errors over the mean of the map: what noise is left.
double noise_of(const Observed& observed) {
    double squares = 0.0;
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < observed.average.size(); ++i) {
        if (std::isnan(observed.standard_error[i])) continue;
        squares += std::pow(observed.standard_error[i], 2.0);
        sum += observed.average[i];
        count += 1.0;
    }
    return count > 0.0 ? std::sqrt(squares / count) / (sum / count)
                       : std::numeric_limits<double>::quiet_NaN();
}

nlohmann::ordered_json json_of(const ObserveCommandOptions& options,
                               const Selection& selection,
                               const Sled& sled,
                               const Observed& observed) {
    nlohmann::ordered_json json{{"map", options.output},
                                {"average", name_of(options.average)},
                                {"images", selection.images.size()},
                                {"outside", selection.outside},
                                {"altitude_m", sled.altitude_m},
                                {"pitch_deg", degrees(sled.pitch_rad)},
                                {"roll_deg", degrees(sled.roll_rad)},
                                {"relative_error", noise_of(observed)},
                                {"skipped", nlohmann::ordered_json::array()}};
    for (const Skipped& skipped : selection.skipped)
        json["skipped"].push_back({{"image", skipped.image}, {"why", skipped.why}});
    return json;
}

void print_summary(const ObserveCommandOptions& options,
                   const Selection& selection,
                   const nlohmann::ordered_json& json) {
    const auto angle = [&](const char* key) {
        const auto degrees = json[key].get<double>();
        return std::isnan(degrees) ? "unknown" : fmt::format("{:.2f} deg", degrees);
    };
    fmt::print("{}: the {} of {} at {:.3f} m, pitch {}, roll {} on average\n",
               options.output,
               options.average == Average::Trimmed ? "trimmed mean" : name_of(options.average),
               counted(selection.images.size(), "image"),
               json["altitude_m"].get<double>(),
               angle("pitch_deg"),
               angle("roll_deg"));
    if (json["relative_error"].is_number() && std::isfinite(json["relative_error"].get<double>())) {
        fmt::print("standard error: {:.2g} of the map's mean (rms)\n",
                   json["relative_error"].get<double>());
    }
    fmt::print("{} at other altitudes, {} skipped\n",
               counted(selection.outside, "image"),
               selection.skipped.size());
}

std::vector<Suspicion> looked_at(const Selection& selection, const ObserveCommandOptions& options) {
    std::vector<SurveyFile> files;
    for (const std::filesystem::path& image : selection.images) {
        files.push_back({.source = image, .name = image.filename()});
    }
    return suspicions_of(files, options.camera, static_cast<std::size_t>(options.jobs));
}

ExitStatus observe(const ObserveCommandOptions& options) {
    Selection selection = selected(options);
    const std::vector<Suspicion> looks_wrong = looked_at(selection, options);
    tell(looks_wrong, options.strict);
    Observed observed;
    RawImage like;
    {
        Pass pass(options, selection);
        observed = options.average == Average::Mean ? mean_of(pass)
                                                    : ranked_by_bands(pass, selection, options);
        like = pass.first();
    }
    for (const Skipped& skipped : selection.skipped) print_skipped(skipped.image, skipped.why);
    if (selection.images.empty()) {
        const std::string others =
            selection.outside > 0
                ? fmt::format("; the nearest is {:.3g} m off", selection.nearest_m)
                : "";
        const std::string first = selection.skipped.empty()
                                      ? ""
                                      : fmt::format("; skipped: {}, the first: {}: {}",
                                                    selection.skipped.size(),
                                                    selection.skipped.front().image,
                                                    selection.skipped.front().why);
        throw InputError(fmt::format("no image to be used within {} m of {} m{}{}",
                                     options.within_m,
                                     options.altitude_m,
                                     others,
                                     first));
    }
    const Sled sled = mean_of(selection.sleds);
    write_map(options, observed, like, selection.images.size(), sled);
    nlohmann::ordered_json json = json_of(options, selection, sled, observed);
    json["looks_wrong"] = suspicions_json(looks_wrong);
    if (options.json) {
        fmt::print("{}\n", dumped(json));
    } else {
        print_summary(options, selection, json);
    }
    return selection.skipped.empty() ? kDone : kAnswerIsNo;
}

void add_average_options(CLI::App& app, ObserveCommandOptions& options) {
    app.add_option("--method", options.average, "Average by mean, median or trimmed mean")
        ->transform(CLI::CheckedTransformer(kAverages).description(""))
        ->type_name("mean|median|trimmed")
        ->default_str("mean");
    app.add_option(
           "--trim", options.trim, "Trimmed mean: leave out this share of samples at either end")
        ->check(in_range(0.0, 0.49))
        ->capture_default_str();
    app.add_flag("--normalise",
                 options.normalise,
                 "First divide each image by its mean, to average patterns alone");
    app.add_flag("--demosaic",
                 options.demosaic,
                 "Fill in the other channels of each pixel of a mosaic's map");
}

Action configure_observe(CLI::App& app) {
    const auto options = std::make_shared<ObserveCommandOptions>();
    app.add_option(
           "IMAGES", options->images, "Raw images, or folders of them: TIFF, PNG, EXR, JPEG")
        ->required();
    app.add_option("--nav",
                   options->navigation,
                   "Where the sled was: CSV with the columns image and altitude_m, or HabCam's "
                   "lines of name, altitude, pitch and roll")
        ->type_name("FILE")
        ->required();
    app.add_option("-o,--output", options->output, "Write the map to this file")
        ->type_name("MAP.exr")
        ->required();
    app.add_option(kAltitudeNames, options->altitude_m, "Altitude to observe, in metres")
        ->check(positive())
        ->option_text("M")
        ->required();
    app.add_option("--within", options->within_m, "Accept images up to this far from it, in metres")
        ->check(not_negative())
        ->capture_default_str();
    add_average_options(app, *options);
    add_camera_options(app, options->camera);
    app.add_option("--memory",
                   options->memory_mb,
                   "Hold up to N MB of images at a time, for a median or trimmed mean")
        ->check(positive())
        ->capture_default_str();
    add_jobs(app, options->jobs, "Read N images at a time");
    add_strict_option(app, options->strict);
    add_json(app, options->json);
    app.footer(
        "MAP.exr holds the average in R, G, B, the number of images in count.R ..., the standard "
        "error in stderr.R ...; what was never observed is NaN. Images that cannot be used are "
        "reported and skipped; the exit status is then 1.");
    return [options] { return observe(*options); };
}

}  // namespace

const Command kObserve{"observe",
                       kSurveyCommands,
                       "Average images of one altitude into their shared light",
                       configure_observe};

}  // namespace aphotic::cli
