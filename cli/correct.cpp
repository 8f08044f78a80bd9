// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic correct IMAGES... --rig RIG --nav FILE -o DIR: survey images divided by the map of their
// own altitude and attitude.
//
// Images are streamed: each of --jobs threads holds one of them, its map and its result. What is
// done is noted as it is done, and an image that cannot be corrected costs no other.
#include "lightmap/correction.h"

#include "cli/command.h"
#include "cli/journal.h"
#include "cli/outcome.h"
#include "cli/output_folder.h"
#include "cli/progress.h"
#include "cli/survey_files.h"
#include "cli/survey_image.h"
#include "cli/survey_light.h"
#include "cli/words.h"
#include "spectral/atomic_file.h"
#include "spectral/digest.h"
#include "spectral/error.h"
#include "spectral/exr.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <utility>

namespace aphotic::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct Options {
    std::vector<std::string> images;
    std::string rig;
    std::string nav;
    std::string map;
    std::string folder;
    std::string bayer;
    bool keep_mosaic = false;
    CameraNumbers camera;
    std::vector<double> gain;
    std::optional<double> middle;
    std::size_t gain_images = 16;
    std::vector<double> altitudes_m;
    NoiseLimit limit;
    std::optional<double> read_noise;  // none: what the file's numbers are rounded by
    int edge_px = 2;
    bool mask = false;
    std::string format = "tiff";
    std::size_t jobs = std::max(1U, std::thread::hardware_concurrency());
    bool json = false;
};

struct Skipped {
    std::string image;
    std::string why;
};

struct Survey {
    std::vector<SurveyFile> files;
    SurveyLight light;
    CameraNumbers camera;
};

struct Gain {
    PerChannel gain{};
    PerChannel middle{};
    std::vector<std::string> images;  // that it was taken from
};

constexpr std::array<std::pair<std::string_view, std::uint8_t>, 5> kDoubts{
    {{"dark", kDark},
     {"saturated", kSaturated},
     {"black", kBlack},
     {"edge", kEdge},
     {"clipped", kClipped}}};

// A message of an image without its name, which stands before it.
std::string without_name(const std::string& message, const SurveyFile& file) {
    const std::string name = file.source.string() + ": ";
    return message.starts_with(name) ? message.substr(name.size()) : message;
}

// Calls work(i) for each of `count` on several threads. What it throws stops all, and comes out.
template <typename Work>
void for_each_of(std::size_t count, std::size_t jobs, const Work& work) {
    std::atomic<std::size_t> next = 0;
    std::mutex mutex;
    std::exception_ptr fault;
    const auto take = [&] {
        try {
            for (std::size_t i = next++; i < count; i = next++) work(i);
        } catch (...) {
            const std::scoped_lock lock(mutex);
            if (!fault) fault = std::current_exception();
            next = count;
        }
    };
    std::vector<std::jthread> others;
    for (std::size_t t = 1; t < std::min(jobs, count); ++t) others.emplace_back(take);
    take();
    others.clear();
    if (fault) std::rethrow_exception(fault);
}

double median(std::vector<double> numbers) {
    const auto middle = numbers.begin() + std::ssize(numbers) / 2;
    std::ranges::nth_element(numbers, middle);
    return *middle;
}

PerChannel wanted_middle(const Survey& survey, const Options& options) {
    constexpr double kGrey = 0.2;
    if (!options.middle && survey.light.floor_colour) return *survey.light.floor_colour;
    const double middle = options.middle.value_or(kGrey);
    return {middle, middle, middle};
}

// The survey's middle quotient: of images spread evenly over it, the median of each one's own.
Gain measured_gain(const Survey& survey, const Options& options) {
    const std::size_t count = std::min(options.gain_images, survey.files.size());
    std::vector<std::optional<PerChannel>> middles(count);
    const auto file_of = [&](std::size_t i) -> const SurveyFile& {
        return survey.files[i * survey.files.size() / count];
    };
    ProgressLine line;
    std::mutex line_mutex;
    std::string first_why;
    for_each_of(count, options.jobs, [&](std::size_t i) {
        try {
            const Sled sled = survey.light.pose(file_of(i).source);
            const SurveyImage taken =
                read_survey_image(file_of(i).source, survey.light.size, survey.camera);
            middles[i] = middle_quotient(
                taken.raw, survey.light.map(sled), taken.levels, options.limit.share);
        } catch (const InputError& error) {
            // It is said of the image when its turn comes, if one does.
            const std::scoped_lock lock(line_mutex);
            if (first_why.empty()) {
                first_why = fmt::format("; {}: {}", file_of(i).name.string(), error.what());
            }
        }
        const std::scoped_lock lock(line_mutex);
        line.show("taking the gain", static_cast<double>(i + 1) / static_cast<double>(count));
    });
    Gain gain{.gain = {}, .middle = wanted_middle(survey, options), .images = {}};
    std::array<std::vector<double>, kChannels> quotients;
    for (std::size_t i = 0; i < count; ++i) {
        if (!middles[i] || !std::ranges::all_of(*middles[i], [](double q) { return q > 0.0; })) {
            continue;
        }
        gain.images.push_back(file_of(i).name.string());
        for (std::size_t c = 0; c < kChannels; ++c) quotients[c].push_back((*middles[i])[c]);
    }
    if (gain.images.empty()) {
        throw InputError(
            fmt::format("no gain can be taken from these images: of {} looked at, none has light "
                        "and a map in every channel; allowed: --gain{}",
                        count,
                        first_why));
    }
    for (std::size_t c = 0; c < kChannels; ++c)
        gain.gain[c] = gain.middle[c] / median(quotients[c]);
    return gain;
}

Json settings_of(const Survey& survey, const Options& options) {
    Json json{{"aphotic", APHOTIC_VERSION},
              {options.map.empty() ? "rig_sha256" : "map_sha256", survey.light.digest},
              {"bayer", mosaic_name(survey.camera.mosaic)},
              {"keep_mosaic", options.keep_mosaic},
              {"black_level", options.camera.black_level},
              {"white_level", nullptr},
              {"gain", options.gain},
              {"middle", wanted_middle(survey, options)},
              {"least_light", options.limit.share},
              {"most_noise", options.limit.relative},
              {"read_noise", nullptr},
              {"electrons", options.limit.electrons_per_number},
              {"edge_px", options.edge_px},
              {"mask", options.mask},
              {"format", options.format}};
    if (options.read_noise) json["read_noise"] = *options.read_noise;
    if (options.camera.white_level) json["white_level"] = *options.camera.white_level;
    return json;
}

fs::path notes_of(const Options& options) {
    return fs::path(options.folder) / "correction.json";
}

// A folder keeps its gain while its settings stay, so that images that come later fit the others.
std::optional<Gain> noted_gain(const Options& options, const std::string& settings_sha256) {
    if (!fs::exists(notes_of(options))) return std::nullopt;
    const Json notes = Json::parse(read_text_file(notes_of(options)), nullptr, false);
    if (!notes.is_object() || notes.value("settings_sha256", "") != settings_sha256) {
        return std::nullopt;
    }
    try {
        return Gain{.gain = notes.at("gain").get<PerChannel>(),
                    .middle = notes.at("settings").at("middle").get<PerChannel>(),
                    .images = notes.at("gain_from").get<std::vector<std::string>>()};
    } catch (const Json::exception&) {
        return std::nullopt;  // not as we wrote it: taken again
    }
}

Gain gain_of(const Survey& survey, const Options& options, const std::string& settings_sha256) {
    if (!options.gain.empty()) {
        Gain gain{.gain = {}, .middle = wanted_middle(survey, options), .images = {}};
        for (std::size_t c = 0; c < kChannels; ++c) {
            gain.gain[c] = options.gain[options.gain.size() == 1 ? 0 : c];
        }
        return gain;
    }
    if (const auto noted = noted_gain(options, settings_sha256)) return *noted;
    return measured_gain(survey, options);
}

// Samples that the format cannot hold are marked; the writer clips them.
void mark_clipped(CorrectedImage& result) {
    const std::size_t pixels = result.doubts.size();
    for (std::size_t i = 0; i < result.image.samples.size(); ++i) {
        const float sample = result.image.samples[i];
        if (sample < 0.0F || sample > 1.0F) result.doubts[i % pixels] |= kClipped;
    }
}

fs::path result_of(const SurveyFile& file, const Options& options) {
    return file.name.string() + (options.format == "tiff" ? ".tif" : "." + options.format);
}

fs::path mask_of(const SurveyFile& file) {
    return file.name.string() + ".mask.png";
}

// By pixels, for each kind.
Json doubts_in(const std::vector<std::uint8_t>& doubts) {
    Json counts;
    for (const auto& [name, bit] : kDoubts) {
        counts[std::string(name)] =
            std::ranges::count_if(doubts, [bit = bit](std::uint8_t d) { return (d & bit) != 0; });
    }
    return counts;
}

// The whole work on an image; what is noted of it.
Json correct_image(const SurveyFile& file,
                   const Sled& sled,
                   const Survey& survey,
                   const Options& options,
                   const Gain& gain) {
    const SurveyImage taken = read_survey_image(file.source, survey.light.size, survey.camera);
    NoiseLimit limit = options.limit;
    limit.read_noise = options.read_noise.value_or(taken.rounding);
    // Of a gain by itself nobody knows how much light the survey's middle has.
    if (!options.gain.empty() && !options.middle) limit = {.share = options.limit.share};
    const Correction correction{
        .gain = gain.gain, .middle = gain.middle, .levels = taken.levels, .limit = limit};
    CorrectedImage result = corrected(taken.raw, survey.light.map(sled), correction);
    if (result.image.mosaic != Mosaic::None && !options.keep_mosaic) result = demosaiced(result);
    const std::vector<std::uint8_t> edges = survey.light.edges(sled, options.edge_px);
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if (edges[i] != 0) result.doubts[i] |= kEdge;
    }
    if (options.format != "exr") mark_clipped(result);
    const fs::path folder(options.folder);
    make_folder((folder / file.name).parent_path());
    if (options.mask) write_mask(folder / mask_of(file), result);
    write_corrected(folder / result_of(file, options), result.image, taken);
    return doubts_in(result.doubts);
}

// Of all that an image's result depends on.
std::string digest_of(const SurveyFile& file,
                      const Sled& sled,
                      const std::string& settings_sha256,
                      const Gain& gain) {
    return sha256_of_text(fmt::format("{} {} {} {} {} {} {}",
                                      settings_sha256,
                                      fmt::join(gain.gain, " "),
                                      sled.altitude_m,
                                      sled.pitch_rad,
                                      sled.roll_rad,
                                      fs::file_size(file.source),
                                      fs::last_write_time(file.source).time_since_epoch().count()));
}

struct Outcome {
    std::size_t corrected = 0;
    std::size_t kept = 0;
    std::vector<Skipped> skipped;  // in the order of the images
    std::vector<std::string> done;
};

Outcome correct_all(const Survey& survey,
                    const Options& options,
                    const Gain& gain,
                    const std::string& settings_sha256,
                    Journal& journal) {
    Outcome outcome;
    std::vector<std::string> whys(survey.files.size());
    std::size_t count = 0;
    std::mutex mutex;
    ProgressLine line;
    for_each_of(survey.files.size(), options.jobs, [&](std::size_t i) {
        const SurveyFile& file = survey.files[i];
        const std::string name = file.name.string();
        try {
            const Sled sled = survey.light.pose(file.source);
            const std::string digest = digest_of(file, sled, settings_sha256, gain);
            std::unique_lock lock(mutex);
            if (journal.is_done(name, digest)) {
                ++outcome.kept;
            } else {
                lock.unlock();
                const Json doubts = correct_image(file, sled, survey, options, gain);
                lock.lock();
                std::vector<fs::path> files{result_of(file, options)};
                if (options.mask) files.push_back(mask_of(file));
                journal.note(name, digest, files, doubts);
                ++outcome.corrected;
            }
        } catch (const InputError& error) {
            const std::scoped_lock lock(mutex);
            whys[i] = without_name(error.what(), file);
            line.wipe();
            fmt::print(stderr, "aphotic: {}: {}; skipped\n", file.source.string(), whys[i]);
        }
        const std::scoped_lock lock(mutex);
        ++count;
        line.show(fmt::format("{} of {} images", count, survey.files.size()),
                  static_cast<double>(count) / static_cast<double>(survey.files.size()));
    });
    for (std::size_t i = 0; i < whys.size(); ++i) {
        if (whys[i].empty()) {
            outcome.done.push_back(survey.files[i].name.string());
        } else {
            outcome.skipped.push_back({survey.files[i].source.string(), whys[i]});
        }
    }
    return outcome;
}

// As shares of all pixels of the images that are done.
Json doubtful_shares(const Outcome& outcome, const Survey& survey, const Journal& journal) {
    const PlaneSize size = survey.light.size;
    const double pixels = static_cast<double>(outcome.done.size()) * size.width_px * size.height_px;
    Json shares;
    for (const auto& [name, bit] : kDoubts) {
        double count = 0.0;
        for (const std::string& image : outcome.done) {
            count += journal.noted(image).value(std::string(name), 0.0);
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

void print_summary(const Json& summary, const Options& options) {
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
    fmt::print("\n  {}\n", notes_of(options).string());
    for (const auto& one : summary["skipped"]) {
        fmt::print(
            "  skipped: {}: {}\n", one["image"].get<std::string>(), one["why"].get<std::string>());
    }
}

void require_sources_stay(const Survey& survey, const Options& options) {
    std::set<fs::path> sources;
    for (const SurveyFile& file : survey.files) sources.insert(fs::weakly_canonical(file.source));
    for (const SurveyFile& file : survey.files) {
        const fs::path result = fs::path(options.folder) / result_of(file, options);
        if (!sources.contains(fs::weakly_canonical(result))) continue;
        throw InputError(
            fmt::format("{}: would be overwritten by the result; allowed: another "
                        "folder for -o",
                        result.string()));
    }
}

Survey survey_of(const Options& options) {
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
        throw InputError(fmt::format("--altitudes-m: found {},{}; allowed: the lower first",
                                     options.altitudes_m[0],
                                     options.altitudes_m[1]));
    }
    Survey survey;
    survey.camera = options.camera;
    if (!options.bayer.empty()) {
        const auto mosaic = mosaic_named(options.bayer);
        if (!mosaic) {
            throw InputError(
                fmt::format("--bayer: found '{}'; allowed: RGGB, BGGR, GRBG, GBRG", options.bayer));
        }
        survey.camera.mosaic = *mosaic;
    }
    survey.files = survey_files(options.images, options.folder);
    require_sources_stay(survey, options);
    survey.light = options.map.empty()
                       ? light_of_rig(options.rig, options.nav, options.altitudes_m, survey.files)
                       : light_of_map(options.map);
    return survey;
}

ExitStatus correct(const Options& options) {
    const auto start = std::chrono::steady_clock::now();
    const Survey survey = survey_of(options);
    const FolderLock lock = claim_folder(options.folder);
    for (const auto& entry : fs::recursive_directory_iterator(options.folder)) {
        if (entry.is_directory()) remove_abandoned_files(entry.path());
    }
    set_exr_threads(0);  // the images themselves are spread over the threads
    const Json settings = settings_of(survey, options);
    const std::string settings_sha256 = sha256_of_text(settings.dump());
    const Gain gain = gain_of(survey, options, settings_sha256);
    Json notes{{"settings", settings},
               {"settings_sha256", settings_sha256},
               {"gain", gain.gain},
               {"gain_from", gain.images}};
    write_text_file(notes_of(options), dumped(notes) + "\n");

    Journal journal(fs::path(options.folder) / "corrected.jsonl");
    const Outcome outcome = correct_all(survey, options, gain, settings_sha256, journal);
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

void add_light_options(CLI::App& app, Options& options) {
    app.add_option("--rig", options.rig, "the sled that took the images")->type_name("RIG");
    app.add_option(
           "--nav",
           options.nav,
           "altitude, pitch and roll of each image: CSV with the columns image, altitude_m, "
           "pitch_deg, roll_deg, or lines of these four without a header")
        ->type_name("FILE");
    app.add_option("--map", options.map, "instead of both, one lightmap (EXR) for all images")
        ->type_name("FILE");
    app.add_option("--altitudes-m",
                   options.altitudes_m,
                   "least,most altitude; images from beyond are skipped")
        ->delimiter(',')
        ->expected(2)
        ->check(CLI::NonNegativeNumber);
}

void add_camera_options(CLI::App& app, Options& options) {
    app.add_option("--bayer",
                   options.bayer,
                   "the images are mosaics of one channel: RGGB, BGGR, GRBG or GBRG")
        ->type_name("SITES");
    app.add_flag("--keep-mosaic", options.keep_mosaic, "write mosaics as such, not R, G, B");
    app.add_option("--black-level", options.camera.black_level, "the camera's number for no light")
        ->capture_default_str();
    app.add_option("--white-level",
                   options.camera.white_level,
                   "the camera's number at saturation, such as 4095; by default the largest that "
                   "the file's integers hold");
    app.add_option("--read-noise",
                   options.read_noise,
                   "its noise without light, in the camera's numbers; by default what rounding to "
                   "whole numbers makes, 0.3, and none for floats")
        ->check(CLI::NonNegativeNumber);
    app.add_option("--electrons",
                   options.limit.electrons_per_number,
                   "electrons a number, for shot noise; 0 leaves it aside")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
}

void add_result_options(CLI::App& app, Options& options) {
    constexpr double kLeastShare = 1e-6;
    constexpr double kLeastNoise = 1e-3;
    constexpr double kMostNoise = 10.0;
    constexpr int kMostEdge_px = 100;
    constexpr std::size_t kMostImages = 10000;
    app.add_option("--gain",
                   options.gain,
                   "what (raw - black) / map is multiplied by: one number, or R,G,B; by default "
                   "taken from the survey")
        ->delimiter(',')
        ->expected(1, kChannels)
        ->check(CLI::PositiveNumber);
    app.add_option("--middle",
                   options.middle,
                   "what the survey's middle pixel comes out as, such as 0.2, grey; by default the "
                   "colour of the rig's floor, with --map 0.2")
        ->check(CLI::PositiveNumber);
    app.add_option("--gain-images", options.gain_images, "images that the gain is taken from")
        ->check(CLI::Range(std::size_t{1}, kMostImages))
        ->capture_default_str();
    app.add_option("--least-light",
                   options.limit.share,
                   "the gain is held where the map is under this share of its brightest")
        ->check(CLI::Range(kLeastShare, 1.0))
        ->capture_default_str();
    app.add_option("--most-noise",
                   options.limit.relative,
                   "and where the middle's noise would be over this share of it")
        ->check(CLI::Range(kLeastNoise, kMostNoise))
        ->capture_default_str();
    app.add_option("--edge-px", options.edge_px, "pixels about a cone's edge that are doubtful")
        ->check(CLI::Range(0, kMostEdge_px))
        ->capture_default_str();
    app.add_flag("--mask", options.mask, "write NAME.mask.png beside each image");
    app.add_option("--format",
                   options.format,
                   "tiff or png, of 16 bits with 65535 for white, or exr, of floats")
        ->check(CLI::IsMember({"tiff", "png", "exr"}))
        ->capture_default_str();
}

}  // namespace

Action configure_correct(CLI::App& app) {
    constexpr std::size_t kMostJobs = 1024;
    const auto options = std::make_shared<Options>();
    app.add_option(
           "IMAGES", options->images, "raw images, or folders of them: TIFF, PNG, EXR, JPEG")
        ->required();
    add_light_options(app, *options);
    app.add_option("-o,--output", options->folder, "the folder to write to")
        ->required()
        ->type_name("DIR");
    add_camera_options(app, *options);
    add_result_options(app, *options);
    app.add_option("--jobs", options->jobs, "images at a time; by default the cores")
        ->check(CLI::Range(std::size_t{1}, kMostJobs))
        ->capture_default_str();
    app.add_flag("--json", options->json, "print DIR/correction.json");
    app.footer(
        "Given again, it goes on where it stopped. Exit status 0 when all images are corrected, 1\n"
        "when some had to be skipped: correction.json lists them. A mask's pixel is a sum of 1\n"
        "dark, 2 saturated, 4 black, 8 on a cone's edge, 16 clipped by the format; 0 is good.");
    return [options] { return correct(*options); };
}

}  // namespace aphotic::cli
