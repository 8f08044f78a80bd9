// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic correct IMAGES... --rig RIG --nav FILE -o DIR: survey images divided by the map of their
// own altitude and attitude.
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/sha256.h"
#include "base/words.h"
#include "cli/command.h"
#include "cli/options.h"
#include "cli/outcome.h"
#include "cli/output_folder.h"
#include "image/exr.h"
#include "survey/journal.h"
#include "survey/kept_gain.h"
#include "survey/survey_correction.h"
#include "survey/survey_gain.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <algorithm>
#include <chrono>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <system_error>

namespace aphotic::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct CorrectCommandOptions {
    std::vector<std::string> images;
    std::string rig;
    std::string nav;
    std::string map;
    CameraNumbers camera;
    std::vector<double> gain;
    std::optional<double> middle;
    std::size_t gain_images = 16;
    std::vector<double> altitudes_m;
    ResultOptions result;
    bool strict = false;
    bool json = false;
};

const std::map<std::string, Compression> kCompressions{
    {"none", Compression::None}, {"fast", Compression::Fast}, {"small", Compression::Small}};

std::string name_of(Compression compression) {
    return std::ranges::find(kCompressions, compression, [](const auto& c) { return c.second; })
        ->first;
}

PerChannel wanted_middle(const Survey& survey, const CorrectCommandOptions& options) {
    constexpr double kGrey = 0.2;
    if (!options.middle && survey.light.floor_colour) return *survey.light.floor_colour;
    const double middle = options.middle.value_or(kGrey);
    return {middle, middle, middle};
}

Json settings_of(const Survey& survey, const CorrectCommandOptions& options) {
    Json json{{"aphotic", APHOTIC_VERSION},
              {options.map.empty() ? "rig_sha256" : "map_sha256", survey.light.digest},
              {"bayer", mosaic_name(options.camera.mosaic)},
              {"keep_mosaic", options.result.keep_mosaic},
              {"black_level", options.camera.black_level},
              {"white_level", nullptr},
              {"gain", options.gain},
              {"gain_images", nullptr},
              {"middle", wanted_middle(survey, options)},
              {"least_light", options.result.limit.share},
              {"most_noise", options.result.limit.relative},
              {"read_noise", nullptr},
              {"electrons", options.result.limit.electrons_per_number},
              {"edge_px", options.result.edge_px},
              {"mask", options.result.mask},
              {"format", options.result.format},
              {"compression", name_of(options.result.compression)}};
    if (options.gain.empty()) json["gain_images"] = options.gain_images;
    if (options.result.read_noise) json["read_noise"] = *options.result.read_noise;
    if (options.camera.white_level) json["white_level"] = *options.camera.white_level;
    return json;
}

fs::path notes_of(const CorrectCommandOptions& options) {
    return options.result.folder / kCorrectionNotes;
}

std::optional<SurveyGain> noted_gain(const CorrectCommandOptions& options,
                                     const std::string& settings_sha256) {
    if (!fs::exists(notes_of(options))) return std::nullopt;
    return kept_gain(read_text_file(notes_of(options)), settings_sha256);
}

SurveyGain given_gain(const Survey& survey, const CorrectCommandOptions& options) {
    SurveyGain gain{.gain = {}, .middle = wanted_middle(survey, options), .images = {}};
    for (std::size_t c = 0; c < kChannels; ++c) {
        gain.gain[c] = options.gain[options.gain.size() == 1 ? 0 : c];
    }
    return gain;
}

// What a look at the survey gives.
struct FirstLook {
    SurveyGain gain;
    std::vector<Suspicion> suspicions;
    std::string not_checked;  // and why; or empty
};

// A gain that is kept is not taken again, but the survey is looked at: it may have other images and
// another navigation by now.
FirstLook first_look(const Survey& survey,
                     const CorrectCommandOptions& options,
                     const std::string& settings_sha256) {
    std::optional<SurveyGain> gain = noted_gain(options, settings_sha256);
    if (!options.gain.empty()) gain = given_gain(survey, options);
    try {
        const SurveyLook look = look_at(survey,
                                        {.gain_images = gain ? 0 : options.gain_images,
                                         .least_light = options.result.limit.share,
                                         .jobs = options.result.jobs});
        const std::vector<ImageLook> looks = look.looks();
        std::vector<Suspicion> found = suspicions(looks, survey.camera.mosaic);
        tell(found, options.strict);
        return {gain ? *gain : measured_gain(look, wanted_middle(survey, options)),
                std::move(found),
                not_checked(looks)};
    } catch (const InputError&) {
        // Refused before anything is written: no folder is left either, unless it holds something.
        std::error_code ignored;
        fs::remove(options.result.folder, ignored);
        throw;
    }
}

// As shares of all pixels of the images that are done.
Json doubtful_shares(const Outcome& outcome, const Survey& survey, const Journal& journal) {
    const PlaneSize size = survey.light.size;
    const double pixels = static_cast<double>(outcome.done.size()) * size.width_px * size.height_px;
    Json shares;
    for (const auto& [name, bit] : kDoubts) {
        double count = 0.0;
        for (const std::string& image : outcome.done) {
            const Counts counts = journal.counts(image);
            const auto found = counts.find(std::string(name));
            if (found != counts.end()) count += found->second;
        }
        shares[std::string(name)] = pixels > 0.0 ? count / pixels : 0.0;
    }
    return shares;
}

Json json_of(const Outcome& outcome) {
    Json json{{"corrected", outcome.corrected}, {"kept", outcome.kept}, {"skipped", Json::array()}};
    for (const Skipped& one : outcome.skipped) {
        json["skipped"].push_back({{"image", one.image}, {"why", one.why}});
    }
    return json;
}

void print_summary(const Json& summary, const CorrectCommandOptions& options) {
    const std::size_t skipped = summary["skipped"].size();
    fmt::print("{} corrected in {:.1f} s, {} kept as they were, {} skipped\n",
               counted(summary["corrected"].get<std::size_t>(), "image"),
               summary["seconds"].get<double>(),
               summary["kept"].get<std::size_t>(),
               skipped);
    const auto gain = summary["gain"].get<PerChannel>();
    const std::size_t from = summary["gain_from"].size();
    fmt::print("  gain {:.6g} (R), {:.6g} (G), {:.6g} (B){}\n",
               gain[0],
               gain[1],
               gain[2],
               from > 0 ? ", taken from " + counted(from, "image") : "");
    fmt::print("  doubtful pixels:");
    for (const auto& [name, share] : summary["doubtful"].items()) {
        constexpr double kPercent = 100.0;
        fmt::print(" {} {:.3g} %", name, kPercent * share.get<double>());
    }
    fmt::print("\n");
    const auto unchecked = summary["not_checked"].get<std::string>();
    if (!unchecked.empty()) fmt::print("  not checked: {}\n", unchecked);
    fmt::print("  {}\n", notes_of(options).string());
    for (const auto& one : summary["skipped"]) {
        fmt::print(
            "  skipped: {}: {}\n", one["image"].get<std::string>(), one["why"].get<std::string>());
    }
}

// The planes of one image have the sizes of those of the next: their memory is kept for them. Given
// back to the system, each of its pages would be cleared anew, a tenth of the processor's time.
void keep_memory() {
#ifdef __GLIBC__
    ::mallopt(M_ARENA_MAX, 1);  // those of threads hold no large planes
    ::mallopt(M_MMAP_MAX, 0);
    ::mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
#endif
}

Survey survey_of(const CorrectCommandOptions& options) {
    if (options.rig.empty() == options.map.empty()) {
        throw InputError("--rig with --nav, or --map: one of them is needed");
    }
    if (options.rig.empty() != options.nav.empty()) {
        throw InputError("--rig and --nav go together: the map depends on where the sled was");
    }
    if (options.gain.size() == 2) {
        throw InputError("--gain: found 2 numbers; allowed: 1, or 3 for R, G and B");
    }
    if (!options.altitudes_m.empty() && options.altitudes_m[0] > options.altitudes_m[1]) {
        throw InputError(fmt::format("--altitude: found {},{}; allowed: the lower first",
                                     options.altitudes_m[0],
                                     options.altitudes_m[1]));
    }
    Survey survey;
    survey.camera = options.camera;
    survey.files = survey_files(options.images, options.result.folder);
    require_sources_stay(survey.files, [&](const SurveyFile& file) {
        std::vector<fs::path> results = results_of(file, options.result);
        for (fs::path& result : results) result = options.result.folder / result;
        return results;
    });
    survey.light = options.map.empty()
                       ? light_of_rig(options.rig, options.nav, options.altitudes_m, survey.files)
                       : light_of_map(options.map);
    return survey;
}

ExitStatus correct(const CorrectCommandOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    keep_memory();
    const Survey survey = survey_of(options);
    const FolderLock lock = claim_tree(options.result.folder);
    set_exr_threads(0);  // the images themselves are spread over the threads
    const Json settings = settings_of(survey, options);
    const std::string settings_sha256 = sha256_of_text(settings.dump());
    const auto [gain, looks_wrong, unchecked] = first_look(survey, options, settings_sha256);
    Json notes{{"settings", settings},
               {"settings_sha256", settings_sha256},
               {"gain", gain.gain},
               {"gain_from", gain.images},
               {"looks_wrong", suspicions_json(looks_wrong)},
               {"not_checked", unchecked}};
    write_text_file(notes_of(options), dumped(notes) + "\n");

    Journal journal(options.result.folder / "corrected.jsonl");
    ResultOptions result = options.result;
    result.limits_noise = options.gain.empty() || options.middle;
    const Outcome outcome = correct_survey(survey, gain, result, settings_sha256, journal);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    notes.update(json_of(outcome));
    notes["doubtful"] = doubtful_shares(outcome, survey, journal);
    notes["seconds"] = elapsed.count();
    write_text_file(notes_of(options), dumped(notes) + "\n");
    if (options.json) {
        fmt::print("{}\n", dumped(notes));
    } else {
        print_summary(notes, options);
    }
    return outcome.skipped.empty() ? kDone : kAnswerIsNo;
}

void add_light_options(CLI::App& app, CorrectCommandOptions& options) {
    app.add_option("--rig", options.rig, "The rig that took the images")->type_name("RIG");
    app.add_option(
           "--nav",
           options.nav,
           "Altitude, pitch and roll of each image: CSV with the columns image, altitude_m, "
           "pitch_deg, roll_deg, or lines of these four without a header")
        ->type_name("FILE");
    app.add_option(
           "--map", options.map, "Use one lightmap (EXR) for all images instead of --rig and --nav")
        ->type_name("FILE");
    app.add_option(kAltitudeNames,
                   options.altitudes_m,
                   "Skip images from outside these altitudes in metres")
        ->delimiter(',')
        ->expected(2)
        ->option_text("LEAST,MOST")
        ->check(not_negative());
}

void add_raw_options(CLI::App& app, CorrectCommandOptions& options) {
    add_camera_options(app, options.camera);
    app.add_flag(
        "--keep-mosaic", options.result.keep_mosaic, "Write mosaics as mosaics, not as R, G, B");
    app.add_option("--white-level",
                   options.camera.white_level,
                   "The camera's number at saturation, such as 4095; by default the largest of the "
                   "file's integer type");
    app.add_option("--read-noise",
                   options.result.read_noise,
                   "The camera's noise without light, in its own numbers; by default that of "
                   "rounding to integers, 0.3, and none for floats")
        ->check(not_negative());
    app.add_option("--electrons",
                   options.result.limit.electrons_per_number,
                   "Electrons per number, for shot noise; 0 ignores it")
        ->check(not_negative())
        ->capture_default_str();
}

void add_result_options(CLI::App& app, CorrectCommandOptions& options) {
    constexpr double kLeastShare = 1e-6;
    constexpr double kLeastNoise = 1e-3;
    constexpr double kMostNoise = 10.0;
    constexpr int kMostEdge_px = 100;
    constexpr std::size_t kMostImages = 10000;
    app.add_option("--gain",
                   options.gain,
                   "Multiply (raw - black) / map by this: one number, or R,G,B; by default taken "
                   "from the survey")
        ->delimiter(',')
        ->expected(1, kChannels)
        ->check(positive());
    app.add_option("--middle",
                   options.middle,
                   "Make the survey's median pixel this value, such as 0.2 for grey; by default "
                   "the colour of the rig's floor, with --map 0.2")
        ->check(positive());
    app.add_option("--gain-images", options.gain_images, "Take the gain from N images")
        ->check(in_range(1, kMostImages))
        ->capture_default_str();
    app.add_option("--least-light",
                   options.result.limit.share,
                   "Hold a pixel's gain where the map is below this share of its brightest in a "
                   "channel")
        ->check(in_range(kLeastShare, 1.0))
        ->capture_default_str();
    app.add_option("--most-noise",
                   options.result.limit.relative,
                   "Hold it, too, where noise would exceed this share of the survey's median")
        ->check(in_range(kLeastNoise, kMostNoise))
        ->capture_default_str();
    app.add_option(
           "--edge-px", options.result.edge_px, "Mark N pixels around a cone's edge as doubtful")
        ->check(in_range(0, kMostEdge_px))
        ->capture_default_str();
    app.add_flag("--mask", options.result.mask, "Write NAME.mask.png beside each image");
    app.add_option("--format",
                   options.result.format,
                   "Write tiff or png (16 bits, white 65535) or exr (floats)")
        ->check(CLI::IsMember({"tiff", "png", "exr"}))
        ->capture_default_str();
    app.add_option(
           "--compression",
           options.result.compression,
           "Compress losslessly: none, fast, or small (a few per cent smaller, about 1.5 times "
           "slower)")
        ->transform(CLI::CheckedTransformer(kCompressions).description(""))
        ->type_name("none|fast|small")
        ->default_str("fast");
}

Action configure_correct(CLI::App& app) {
    const auto options = std::make_shared<CorrectCommandOptions>();
    app.add_option(
           "IMAGES", options->images, "Raw images, or folders of them: TIFF, PNG, EXR, JPEG")
        ->required();
    add_light_options(app, *options);
    add_output_folder(app, options->result.folder)->required();
    add_raw_options(app, *options);
    add_result_options(app, *options);
    add_jobs(app, options->result.jobs, "Correct N images at a time");
    add_strict_option(app, options->strict);
    add_json(app, options->json, "Print DIR/correction.json");
    app.footer(
        "Interrupted, it continues where it stopped when run again. Exit status 0 when every image "
        "is corrected, 1 when some are skipped: correction.json lists them. A mask's pixel is a "
        "sum "
        "of 1 dark, 2 saturated, 4 black, 8 on a cone's edge, 16 clipped by the format; 0 is "
        "good.");
    return [options] { return correct(*options); };
}

}  // namespace

const Command kCorrect{"correct",
                       kSurveyCommands,
                       "Divide survey images by the light they were taken in",
                       configure_correct};

}  // namespace aphotic::cli
