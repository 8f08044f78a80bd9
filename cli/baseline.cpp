// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic baseline NAME IMAGES... -o DIR: images corrected without a model of the lamps.
#include "survey/baseline.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/in_order.h"
#include "base/progress.h"
#include "base/words.h"
#include "cli/command.h"
#include "cli/options.h"
#include "cli/outcome.h"
#include "cli/output_folder.h"
#include "image/exr.h"
#include "survey/navigation.h"
#include "survey/survey_files.h"
#include "survey/survey_image.h"
#include "survey/survey_look.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <thread>

namespace aphotic::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct BaselineCommandOptions {
    std::string name;
    std::vector<std::string> images;
    std::string navigation;
    std::string folder;
    BaselineOptions baseline;
    CameraNumbers camera;
    int jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    bool strict = false;
    bool json = false;
};

Baseline baseline_named(const std::string& name) {
    const auto found = std::ranges::find(kBaselineNames, name);
    return static_cast<Baseline>(found - kBaselineNames.begin());
}

// The survey, and what has been found of it so far.
struct BaselineSurvey {
    std::vector<SurveyFile> files;
    std::optional<Navigation> navigation;
    std::map<fs::path, std::string> skipped;      // an image, and why
    std::map<fs::path, std::string> found_later;  // the same, while others still ask for `skipped`

    [[nodiscard]] double altitude_m(const SurveyFile& file) const {
        return navigation ? navigation->pose_of(file.source).sled.altitude_m : 0.0;
    }
};

RawImage read_finite(const SurveyFile& file, const BaselineCommandOptions& options) {
    RawImage image = without_black(read_survey_image(file.source, options.camera));
    if (!std::ranges::all_of(image.samples, [](float sample) { return std::isfinite(sample); })) {
        throw InputError("a sample is infinite or not a number");
    }
    return image;
}

void learn_survey(BaselineCorrector& corrector,
                  BaselineSurvey& survey,
                  const BaselineCommandOptions& options) {
    ProgressLine line;
    std::optional<RawImage> first;
    in_order(
        survey.files.size(),
        options.jobs,
        [&](std::size_t i) { return read_finite(survey.files[i], options); },
        [&](std::size_t i, const RawImage& image) {
            if (!first) first = image;
            require_size(image, first->width_px, first->height_px, "as the first image");
            corrector.learn(image, survey.altitude_m(survey.files[i]));
            line.show("learning",
                      static_cast<double>(i + 1) / static_cast<double>(survey.files.size()));
        },
        [&](std::size_t i, const std::string& why) {
            survey.skipped.emplace(survey.files[i].source, why);
        });
}

fs::path result_of(const SurveyFile& file, const BaselineCommandOptions& options) {
    return fs::path(options.folder) / (file.name.string() + ".exr");
}

// A mosaic's other channels are filled in after the correction, never before.
void write_image(const fs::path& file, const RawImage& image, const std::string& name) {
    make_folder(file.parent_path());
    const std::vector<std::string> channels(kChannelNames.begin(), kChannelNames.end());
    ExrWriter exr(file,
                  image.width_px,
                  image.height_px,
                  channels,
                  {{"aphotic:version", APHOTIC_VERSION}, {"aphotic:baseline", name}});
    exr.write_rows(image.height_px,
                   image.mosaic == Mosaic::None
                       ? image.samples
                       : demosaiced(image.samples, image.width_px, image.height_px, image.mosaic));
    exr.finish();
}

std::size_t correct_survey(const BaselineCorrector& corrector,
                           BaselineSurvey& survey,
                           const BaselineCommandOptions& options) {
    ProgressLine line;
    std::size_t corrected = 0;
    in_order(
        survey.files.size(),
        options.jobs,
        [&](std::size_t i) {
            const SurveyFile& file = survey.files[i];
            // What could not be learned has its reason already.
            if (survey.skipped.contains(file.source)) return false;
            const RawImage image = read_finite(file, options);
            write_image(result_of(file, options),
                        corrector.corrected(image, survey.altitude_m(file)),
                        options.name);
            return true;
        },
        [&](std::size_t i, bool is_done) {
            if (is_done) ++corrected;
            line.show("correcting",
                      static_cast<double>(i + 1) / static_cast<double>(survey.files.size()));
        },
        [&](std::size_t i, const std::string& why) {
            survey.found_later.emplace(survey.files[i].source, why);
        });
    return corrected;
}

// Of all corrections, also what this one does not use.
Json settings_of(const BaselineCommandOptions& options) {
    const BaselineOptions& baseline = options.baseline;
    return {{"aphotic", APHOTIC_VERSION},
            {"bayer", mosaic_name(options.camera.mosaic)},
            {"black_level", options.camera.black_level},
            {"sigma", baseline.sigma},
            {"low", baseline.low},
            {"high", baseline.high},
            {"tiles", baseline.tiles},
            {"clip", baseline.clip},
            {"order", baseline.order},
            {"bin_m", baseline.bin_m}};
}

BaselineSurvey baseline_survey(const BaselineCommandOptions& options) {
    BaselineSurvey survey{.files = survey_files(options.images, options.folder),
                          .navigation = {},
                          .skipped = {},
                          .found_later = {}};
    require_sources_stay(survey.files, [&](const SurveyFile& file) {
        return std::vector<fs::path>{result_of(file, options)};
    });
    return survey;
}

ExitStatus correct_by_baseline(const BaselineCommandOptions& options) {
    BaselineCorrector corrector(baseline_named(options.name), options.baseline);
    if (corrector.needs_altitude() && options.navigation.empty())
        throw InputError(
            fmt::format("{}: needs --nav, for the altitude of each image", options.name));
    BaselineSurvey survey = baseline_survey(options);
    if (corrector.needs_altitude()) survey.navigation = read_navigation(options.navigation, Sled{});
    const std::vector<Suspicion> looks_wrong =
        suspicions_of(survey.files, options.camera, static_cast<std::size_t>(options.jobs));
    tell(looks_wrong, options.strict);
    const FolderLock lock = claim_tree(options.folder);
    // Before the first image: also what an interrupted run leaves is no survey.
    const fs::path notes_file = fs::path(options.folder) / kBaselineNotes;
    Json notes{{"baseline", options.name},
               {"settings", settings_of(options)},
               {"folder", options.folder},
               {"looks_wrong", suspicions_json(looks_wrong)}};
    write_text_file(notes_file, dumped(notes) + "\n");
    if (corrector.learns()) learn_survey(corrector, survey, options);
    const std::size_t corrected = correct_survey(corrector, survey, options);
    survey.skipped.merge(survey.found_later);

    notes["corrected"] = corrected;
    notes["skipped"] = Json::array();
    for (const auto& [image, why] : survey.skipped) {
        print_skipped(image, why);
        notes["skipped"].push_back({{"image", image.string()}, {"why", why}});
    }
    write_text_file(notes_file, dumped(notes) + "\n");
    if (options.json) {
        fmt::print("{}\n", dumped(notes));
    } else {
        fmt::print("{}: {} corrected by {}, {} skipped\n",
                   options.folder,
                   counted(corrected, "image"),
                   options.name,
                   survey.skipped.size());
    }
    return survey.skipped.empty() ? kDone : kAnswerIsNo;
}

void add_baseline_options(CLI::App& app, BaselineOptions& options) {
    app.add_option("--sigma",
                   options.sigma,
                   "illumination-reflectance, homomorphic: width of the blur as a share of the "
                   "image's")
        ->check(in_range(1e-4, 10.0))
        ->capture_default_str();
    app.add_option("--low", options.low, "homomorphic: gain of low frequencies")
        ->check(in_range(0.0, 10.0))
        ->capture_default_str();
    app.add_option("--high", options.high, "homomorphic: gain of high frequencies")
        ->check(in_range(0.0, 10.0))
        ->capture_default_str();
    app.add_option("--tiles", options.tiles, "local-equalisation: tiles across and down")
        ->check(in_range(1, 256))
        ->capture_default_str();
    app.add_option("--clip",
                   options.clip,
                   "local-equalisation: clip histograms at N mean bins; 1 changes nothing")
        ->check(in_range(1.0, 1e6))
        ->capture_default_str();
    app.add_option(
           "--order", options.order, "log-polynomial, binned-polynomial: order of the polynomials")
        ->check(in_range(0, 12))
        ->capture_default_str();
    app.add_option("--bin", options.bin_m, "binned-polynomial: width of an altitude bin, in metres")
        ->check(in_range(1e-3, 1e4))
        ->capture_default_str();
}

Action configure_baseline(CLI::App& app) {
    const auto options = std::make_shared<BaselineCommandOptions>();
    app.add_option("NAME", options->name, fmt::format("{}", fmt::join(kBaselineNames, ", ")))
        ->check(CLI::IsMember(std::set<std::string>(kBaselineNames.begin(), kBaselineNames.end())))
        ->required();
    app.add_option(
           "IMAGES", options->images, "Raw images, or folders of them: TIFF, PNG, EXR, JPEG")
        ->required();
    add_output_folder(app, options->folder)->required();
    app.add_option("--nav",
                   options->navigation,
                   "Altitude of each image, for binned-polynomial; as for observe")
        ->type_name("FILE");
    add_baseline_options(app, options->baseline);
    add_camera_options(app, options->camera);
    add_jobs(app, options->jobs, "Correct N images at a time");
    add_strict_option(app, options->strict);
    add_json(app, options->json, "Print DIR/baseline.json");
    app.footer(
        "Writes float EXR. The polynomials learn from all images given; the others correct each "
        "image by itself. Images that cannot be used are reported and skipped; the exit status is "
        "then 1.");
    return [options] { return correct_by_baseline(*options); };
}

}  // namespace

const Command kBaseline{"baseline",
                        kSurveyCommands,
                        "Correct images without a model of the lamps, for comparison",
                        configure_baseline};

}  // namespace aphotic::cli
