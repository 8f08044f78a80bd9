// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic atlas RIG --altitude 1:4:0.1 -o ATLAS: maps over altitude, attitude and water.
#include "lightmap/atlas.h"

#include "base/atomic_file.h"
#include "base/degrees.h"
#include "base/error.h"
#include "base/number.h"
#include "base/progress.h"
#include "base/words.h"
#include "cli/command.h"
#include "cli/model_error.h"
#include "cli/options.h"
#include "cli/outcome.h"
#include "cli/output_folder.h"
#include "cli/rig_file.h"
#include "cli/terminal.h"
#include "image/exr.h"
#include "lightmap/altitude_fit.h"
#include "lightmap/atlas_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <sstream>

namespace aphotic::cli {
namespace {

namespace fs = std::filesystem;

// Of all axes together: HabCam's would be over a terabyte.
constexpr std::size_t kMostBins = 100000;

// Each a number, or FIRST:LAST:STEP with both ends; what is left out is the rig's own.
struct AxisTexts {
    std::string altitude;
    std::string pitch;
    std::string roll;
    std::string water;
};

struct Bounds {
    double least;
    double most;
};
constexpr Bounds kAltitude_m{kLeastAltitude_m, kMostAltitude_m};
constexpr Bounds kTilt_deg{-kMostTilt_deg, kMostTilt_deg};
constexpr Bounds kMultiple{0.0, 1e6};

// A, or FIRST:LAST:STEP with both ends.
std::vector<double> axis_of(const std::string& option, const std::string& text, Bounds bounds) {
    const auto fail = [&] {
        throw InputError(
            "{}: found {}; allowed: a number or FIRST:LAST:STEP, from {} to {}, of up to 10001 "
            "values that end at LAST",
            option,
            text,
            bounds.least,
            bounds.most);
    };
    std::vector<double> parts;
    std::istringstream in(text);
    for (std::string part; std::getline(in, part, ':');) {
        const std::size_t sign = part.starts_with('+') ? 1 : 0;
        const auto number = read_number<double>(std::string_view(part).substr(sign));
        if (!number) fail();
        parts.push_back(*number);
    }
    const bool is_one = parts.size() == 1;
    if (!is_one && parts.size() != 3) fail();
    const double first = parts.front();
    const double last = is_one ? first : parts[1];
    if (!(first >= bounds.least && first <= last && last <= bounds.most)) fail();
    if (is_one || first == last) return {first};
    constexpr double kMostSteps = 10000.0;
    const double steps = (last - first) / parts[2];
    const double whole = std::round(steps);
    constexpr double kWhole = 1e-6;
    if (!(steps >= 1.0 - kWhole && whole <= kMostSteps) || std::abs(steps - whole) > kWhole) fail();
    std::vector<double> values;
    constexpr double kDigits = 1e9;
    for (int i = 0; i <= static_cast<int>(whole); ++i) {
        values.push_back(std::round((first + i * parts[2]) * kDigits) / kDigits);
    }
    return values;
}

std::vector<double> in_radians(std::vector<double> values_deg) {
    for (double& value : values_deg) value *= kRadiansPerDegree;
    return values_deg;
}

void require_few(const MapAxes& axes) {
    const std::size_t bins = bin_count(axes);
    if (bins <= kMostBins) return;
    throw InputError(
        "--altitude, --pitch, --roll, --water-multiple: found {} x {} x {} x {} = {} bins; "
        "allowed: up to {} in all",
        axes.altitude_m.size(),
        axes.pitch_rad.size(),
        axes.roll_rad.size(),
        axes.water_multiple.size(),
        bins,
        kMostBins);
}

void add_axis_options(CLI::App& app, AxisTexts& texts) {
    constexpr const char* kSteps = "FIRST:LAST:STEP";
    app.add_option(kAltitudeNames, texts.altitude, "Altitudes in metres, such as 1:4:0.1")
        ->required()
        ->option_text(kSteps);
    app.add_option(kPitchNames, texts.pitch, "Pitches in degrees; by default the rig's")
        ->option_text(kSteps);
    app.add_option(kRollNames, texts.roll, "Rolls in degrees; by default the rig's")
        ->option_text(kSteps);
    app.add_option("--water-multiple",
                   texts.water,
                   "Multiples of the water's absorption; by default the rig's")
        ->option_text(kSteps);
}

// Throws InputError, which names the option.
MapAxes axes_of(const AxisTexts& texts, const Rig& rig) {
    MapAxes axes{.altitude_m = axis_of("--altitude", texts.altitude, kAltitude_m),
                 .pitch_rad = {rig.sled.pitch_rad},
                 .roll_rad = {rig.sled.roll_rad},
                 .water_multiple = {rig.water.multiple}};
    if (!texts.pitch.empty()) {
        axes.pitch_rad = in_radians(axis_of("--pitch", texts.pitch, kTilt_deg));
    }
    if (!texts.roll.empty()) {
        axes.roll_rad = in_radians(axis_of("--roll", texts.roll, kTilt_deg));
    }
    if (!texts.water.empty()) {
        axes.water_multiple = axis_of("--water-multiple", texts.water, kMultiple);
    }
    require_few(axes);
    return axes;
}

struct AtlasCommandOptions {
    std::string rig_file;
    std::string folder;
    AxisTexts axes;
    double tolerance = 0.0;  // 0: every value of the axes
    double model_tolerance = kModelTolerance;
    bool strict = false;
    std::vector<std::string> exports;
    WorkShare share{};
    LightmapOptions map{.error = 1e-5, .threads = all_cores()};
    bool ignore_needs = false;
    bool json = false;
};

bool is_exported(const AtlasCommandOptions& options, const char* what) {
    return std::ranges::count(options.exports, what) > 0;
}

AtlasExports export_maps(const AtlasCommandOptions& options,
                         const Rig& rig,
                         const std::vector<double>& altitude_m) {
    AtlasExports made;
    ProgressLine line;
    const auto request = [&](const char* what) {
        return AltitudeExport{.altitude_m = altitude_m,
                              .map = options.map,
                              .progress = [&line, what](double share) { line.show(what, share); }};
    };
    if (is_exported(options, "bayer")) {
        made.bayer = export_bayer(options.folder, rig, request("Bayer planes"));
    }
    if (is_exported(options, "exponential")) {
        made.exponential = export_exponential(options.folder, rig, request("fitting"));
    }
    if (is_exported(options, "oplab")) {
        made.oplab = export_oplab(options.folder, rig, request("fitting"));
    }
    note_exports(options.folder, made);
    return made;
}

// A line that begins anew when the work does.
std::function<void(double)> shown_as(const char* what, std::optional<ProgressLine>& line) {
    return [what, &line, last = 1.0](double share) mutable {
        if (share < last) line.emplace();
        line->show(what, share);
        last = share;
    };
}

ChosenAxes choose(const AtlasCommandOptions& options, const Rig& rig, const MapAxes& finest) {
    std::optional<ProgressLine> line;
    const MeasureOptions measure{.threads = options.map.threads,
                                 .progress = shown_as("measuring", line)};
    if (options.tolerance > 0.0) return axes_for(rig, finest, options.tolerance, measure);
    // The atlas measures it, once for all shares.
    if (!options.share.is_whole()) return {.axes = finest, .interpolation = {}};
    return {.axes = finest,
            .interpolation = interpolation_error(rig, finest, kWholeLimit, measure)};
}

// Of a map of the rig's size.
AtlasWork work_of(const AtlasCommandOptions& options, const Rig& rig, const MapAxes& finest) {
    return {.size = {.width_px = rig.camera.width_px, .height_px = rig.camera.height_px},
            .altitudes = finest.altitude_m.size(),
            .has_mosaics = is_exported(options, "bayer"),
            .has_fits = is_exported(options, "exponential"),
            .has_oplab = is_exported(options, "oplab")};
}

std::size_t bins_of(WorkShare share, const MapAxes& axes) {
    return (bin_count(axes) + share.of - share.number) / share.of;
}

// Says what is to come, and refuses it where the disk has no room for it.
void announce(const AtlasCommandOptions& options,
              const MapAxes& chosen,
              AtlasWork work,
              bool has_veil) {
    const std::size_t all = bins_of(options.share, chosen);
    // One more, for a bin is written beside the one that it replaces.
    work.bins = std::min(all, bins_missing(options.folder, chosen) + 1);
    if (has_veil) {  // as many planes again
        work.bins *= 2;
        work.altitudes *= 2;
    }
    const DiskNeeds needs = atlas_needs(work);
    if (!options.json) {
        say("{} of {} x {} pixels: up to {} to write to {}\n",
            counted(all, "bin"),
            work.size.width_px,
            work.size.height_px,
            bytes_in_words(needs.folder_bytes),
            options.folder);
        flush_said();
    }
    require_room(needs, options.folder, options.ignore_needs);
}

struct MadeAtlas {
    Rig rig;
    fs::path folder;
    ChosenAxes chosen;
    WorkShare share{};
    std::optional<ManifestModel> model{};  // of its highest map, in the thickest water
    std::size_t computed = 0;
    AtlasExports exports{};
    double tolerance = 0.0;  // 0: none
    double seconds = 0.0;

    [[nodiscard]] bool holds() const {
        return tolerance == 0.0 || chosen.interpolation.worst <= tolerance;
    }
    [[nodiscard]] fs::path mosaics() const {
        return (folder / exports.bayer.front().file).parent_path();
    }
    [[nodiscard]] fs::path fits() const { return folder / exports.exponential->file; }
};

nlohmann::ordered_json to_json(const MadeAtlas& made) {
    nlohmann::ordered_json exports = nlohmann::ordered_json::object();
    if (!made.exports.bayer.empty()) {
        exports["bayer"] = {{"folder", made.mosaics().string()},
                            {"bins", made.exports.bayer.size()}};
    }
    if (const auto& fit = made.exports.exponential) {
        exports["exponential"] = {
            {"file", made.fits().string()}, {"rms", fit->rms}, {"worst", fit->worst}};
    }
    if (made.exports.oplab) exports["oplab"] = to_json(*made.exports.oplab);
    nlohmann::ordered_json json{{"title", made.rig.title},
                                {"rig_sha256", made.rig.digest},
                                {"folder", made.folder.string()},
                                {"bins", bins_of(made.share, made.chosen.axes)},
                                {"computed", made.computed},
                                {"interpolation", nullptr},
                                {"holds_tolerance", made.holds()},
                                {"exports", exports},
                                {"atlas_s", made.seconds}};
    if (made.share.is_whole())
        json["interpolation"] = interpolation_json(made.chosen.interpolation);
    put_model_error(json, made.model);
    return json;
}

void print(const MadeAtlas& made) {
    constexpr double kPercent = 100.0;
    const InterpolationError& error = made.chosen.interpolation;
    say("{}: {}, {} of them computed, in {:.1f} s\n",
        made.rig.title,
        counted(bins_of(made.share, made.chosen.axes), "bin"),
        made.computed,
        made.seconds);
    if (!made.share.is_whole()) {
        say("  {}: join the shares by the same command without --share\n", made.folder.string());
        return;
    }
    say("  measured between bins, light without the beams' edges is off by up to {:.2g}, {:.2g} "
        "rms\n",
        error.worst,
        error.rms);
    say("  whole maps are off by {:.2g} rms, {:.1f} % of their samples by over {:.2g} (in {}): "
        "edges cross\n  {:.1f} % of the pixels on the way from bin to bin, and step there\n",
        error.whole_rms,
        kPercent * error.whole_over,
        error.whole_limit,
        counted(error.whole_cells, "cell"),
        kPercent * error.crossed_share);
    print_model_error(made.model);
    if (!made.exports.bayer.empty()) {
        say("  {}  RGGB mosaics of {}\n",
            made.mosaics().string(),
            counted(made.exports.bayer.size(), "altitude"));
    }
    if (const auto& fit = made.exports.exponential) {
        say("  {}  a exp(b h) + c, off by {:.2g} of a pixel's mean rms, {:.2g} at most\n",
            made.fits().string(),
            fit->rms,
            fit->worst);
    }
    if (const auto& fit = made.exports.oplab) {
        say("  {}  parameters for oplab's correct_images, off by {:.2g} of a pixel's mean rms, "
            "{:.2g} at "
            "most;\n  {:.1f} % of all light by over {:.0f} %\n",
            (made.folder / fit->folder).string(),
            fit->rms,
            fit->worst,
            kPercent * fit->share_off,
            kPercent * kOplabOff);
    }
    say("  {}/atlas.json\n", made.folder.string());
    if (!made.holds()) {
        say("  not within the tolerance of {:.2g}: the steps allow no finer bins\n",
            made.tolerance);
    }
}

MadeAtlas make(const AtlasCommandOptions& options, const Rig& rig, const MapAxes& finest) {
    require_over_floor(rig, finest);
    if (is_exported(options, "exponential") || is_exported(options, "oplab"))
        AltitudeFitter{finest.altitude_m};  // or it says why not
    Rig darkest = rig;
    darkest.sled.altitude_m = finest.altitude_m.back();
    darkest.water.multiple = finest.water_multiple.back();
    MadeAtlas made{.rig = rig,
                   .folder = options.folder,
                   .chosen = {},
                   .share = options.share,
                   .model = model_error(darkest, options.rig_file, options.model_tolerance),
                   .tolerance = options.tolerance};
    made.chosen = choose(options, rig, finest);
    announce(options, made.chosen.axes, work_of(options, rig, finest), rig.water.scatters());
    set_exr_threads(options.map.threads);
    const FolderLock lock = claim_folder(options.folder);
    remove_abandoned_files(fs::path(options.folder) / "bins");
    {
        std::optional<ProgressLine> line;
        made.computed = write_atlas(options.folder,
                                    rig,
                                    {.axes = made.chosen.axes,
                                     .interpolation = made.chosen.interpolation,
                                     .map = options.map,
                                     .version = APHOTIC_VERSION,
                                     .progress = shown_as("mapping", line),
                                     .share = options.share});
    }
    if (!options.share.is_whole()) return made;
    made.exports = export_maps(options, rig, finest.altitude_m);
    return made;
}

ExitStatus make_atlas(AtlasCommandOptions options) {
    options.folder = share_folder(options.folder, options.share).string();
    const auto start = std::chrono::steady_clock::now();
    const Rig rig = read_plausible_rig(options.rig_file, options.strict);
    const MapAxes finest = axes_of(options.axes, rig);
    MadeAtlas made = naming(options.rig_file, [&] { return make(options, rig, finest); });
    made.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    show(made, options.json);
    return made.holds() ? kDone : kAnswerIsNo;
}

Action configure_atlas(CLI::App& app) {
    constexpr double kLeastTolerance = 1e-6;
    const auto options = std::make_shared<AtlasCommandOptions>();
    add_rig(app, options->rig_file);
    add_output_folder(app, options->folder)->required()->type_name("ATLAS");
    add_axis_options(app, options->axes);
    app.add_option("--tolerance",
                   options->tolerance,
                   "Keep only as many of these bins as interpolate within this relative error, "
                   "beams' edges aside")
        ->check(in_range(kLeastTolerance, 1.0))
        ->option_text("E");
    app.add_option(
           "--export",
           options->exports,
           "Also export, over all altitudes at the rig's own attitude and water, RGGB "
           "mosaics (bayer), a exp(b h) + c fitted to each pixel (exponential), or parameters for "
           "oplab's correct_images (oplab)")
        ->delimiter(',')
        ->check(CLI::IsMember({"bayer", "exponential", "oplab"}))
        ->option_text("bayer,exponential,oplab");
    add_model_tolerance(app, options->model_tolerance);
    add_strict_option(app, options->strict);
    add_jobs(app, options->map.threads, "Map with N threads");
    add_share(app,
              "--share",
              options->share,
              "Map of each N bins the Ith alone, to ATLAS/share-I-of-N: the same command without "
              "it then joins all shares");
    add_needs_option(app, options->ignore_needs);
    add_json(app, options->json);
    app.footer(
        "Maps the bare flat floor, without POV-Ray. Interrupted, it continues where it stopped "
        "when run again. Exit status 1 when the steps are too wide for --tolerance.");
    return [options] { return make_atlas(*options); };
}

}  // namespace

const Command kAtlas{"atlas",
                     kMapCommands,
                     "Map over altitude, attitude and water; measure errors in between",
                     configure_atlas};

}  // namespace aphotic::cli
