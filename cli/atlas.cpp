// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic atlas RIG --altitude 1:4:0.1 -o ATLAS: maps over altitude, attitude and water.
#include "lightmap/atlas.h"

#include "cli/command.h"
#include "cli/option_checks.h"
#include "cli/outcome.h"
#include "cli/output_folder.h"
#include "cli/progress.h"
#include "cli/words.h"
#include "lightmap/atlas_export.h"
#include "scene_gen/rig_reader.h"
#include "spectral/atomic_file.h"
#include "spectral/error.h"
#include "spectral/exr.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <sstream>
#include <thread>

namespace aphotic::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

struct Options {
    std::string rig_file;
    std::string folder;
    std::string altitude;
    std::string pitch;
    std::string roll;
    std::string water;
    double tolerance = 0.0;  // 0: every value of the axes
    std::vector<std::string> exports;
    LightmapOptions map{
        .error = 1e-5,
        .threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()))};
    bool json = false;
};

struct Bounds {
    double least;
    double most;
};
constexpr Bounds kAltitude_m{0.001, 10000.0};
constexpr Bounds kTilt_deg{-89.9, 89.9};
constexpr Bounds kMultiple{0.0, 1e6};

// A, or FIRST:LAST:STEP with both ends.
std::vector<double> axis_of(const std::string& option, const std::string& text, Bounds bounds) {
    const auto fail = [&] {
        throw InputError(
            fmt::format("{}: found {}; allowed: a number or FIRST:LAST:STEP, from {} to "
                        "{}, of up to 10001 values that end at LAST",
                        option,
                        text,
                        bounds.least,
                        bounds.most));
    };
    std::vector<double> parts;
    std::istringstream in(text);
    for (std::string part; std::getline(in, part, ':');) {
        std::size_t used = 0;
        try {
            parts.push_back(std::stod(part, &used));
        } catch (const std::exception&) {
            fail();
        }
        if (used != part.size()) fail();
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

MapAxes axes_of(const Options& options, const Rig& rig) {
    MapAxes axes{.altitude_m = axis_of("--altitude", options.altitude, kAltitude_m),
                 .pitch_rad = {rig.sled.pitch_rad},
                 .roll_rad = {rig.sled.roll_rad},
                 .water_multiple = {rig.water.multiple}};
    if (!options.pitch.empty()) {
        axes.pitch_rad = in_radians(axis_of("--pitch", options.pitch, kTilt_deg));
    }
    if (!options.roll.empty()) {
        axes.roll_rad = in_radians(axis_of("--roll", options.roll, kTilt_deg));
    }
    if (!options.water.empty()) {
        axes.water_multiple = axis_of("--water-multiple", options.water, kMultiple);
    }
    return axes;
}

nlohmann::ordered_json export_maps(const Options& options,
                                   const Rig& rig,
                                   const std::vector<double>& altitude_m) {
    nlohmann::ordered_json made = nlohmann::ordered_json::object();
    const fs::path folder = options.folder;
    ProgressLine line;
    const auto request = [&](const char* what) {
        return AltitudeExport{.altitude_m = altitude_m,
                              .map = options.map,
                              .progress = [&line, what](double share) { line.show(what, share); }};
    };
    if (std::ranges::count(options.exports, "bayer") > 0) {
        export_bayer(folder / "bayer", rig, request("Bayer planes"));
        made["bayer"] = {{"folder", (folder / "bayer").string()}, {"bins", altitude_m.size()}};
    }
    if (std::ranges::count(options.exports, "exponential") > 0) {
        const fs::path file = folder / "exponential.exr";
        const FitResiduals found = export_exponential(file, rig, request("fitting"));
        made["exponential"] = {{"file", file.string()}, {"rms", found.rms}, {"worst", found.worst}};
    }
    return made;
}

void print(const nlohmann::ordered_json& outcome) {
    fmt::print("{}: {}, {} of them computed, in {:.1f} s\n",
               outcome["title"].get<std::string>(),
               counted(outcome["bins"].get<std::size_t>(), "bin"),
               outcome["computed"].get<std::size_t>(),
               outcome["atlas_s"].get<double>());
    fmt::print(
        "  between bins the light is off by at most {:.2g}, {:.2g} rms; cones' edges cross {:.1f} "
        "% of "
        "the\n  pixels on the way from bin to bin, and step there\n",
        outcome["interpolation"]["worst"].get<double>(),
        outcome["interpolation"]["rms"].get<double>(),
        100.0 * outcome["interpolation"]["crossed_by_edges"].get<double>());
    const auto& exports = outcome["exports"];
    if (exports.contains("bayer")) {
        fmt::print("  {}  RGGB mosaics of {}\n",
                   exports["bayer"]["folder"].get<std::string>(),
                   counted(exports["bayer"]["bins"].get<std::size_t>(), "altitude"));
    }
    if (exports.contains("exponential")) {
        fmt::print("  {}  a exp(b h) + c, off by {:.2g} of a pixel's mean rms, {:.2g} at most\n",
                   exports["exponential"]["file"].get<std::string>(),
                   exports["exponential"]["rms"].get<double>(),
                   exports["exponential"]["worst"].get<double>());
    }
    fmt::print("  {}/atlas.json\n", outcome["folder"].get<std::string>());
}

// A line that begins anew when the work does.
std::function<void(double)> shown_as(const char* what, std::optional<ProgressLine>& line) {
    return [what, &line, last = 1.0](double share) mutable {
        if (share < last) line.emplace();
        line->show(what, share);
        last = share;
    };
}

ChosenAxes choose(const Options& options, const Rig& rig, const MapAxes& finest) {
    std::optional<ProgressLine> line;
    const MeasureOptions measure{.threads = options.map.threads,
                                 .progress = shown_as("measuring", line)};
    if (options.tolerance > 0.0) return axes_for(rig, finest, options.tolerance, measure);
    return {.axes = finest,
            .interpolation = interpolation_error(rig, finest, kWholeLimit, measure)};
}

ExitStatus make_atlas(const Options& options) {
    const auto start = std::chrono::steady_clock::now();
    const Rig rig = read_rig(options.rig_file);
    const MapAxes finest = axes_of(options, rig);
    AtlasRequest request{.axes = {},
                         .interpolation = {},
                         .map = options.map,
                         .version = APHOTIC_VERSION,
                         .progress = {}};
    std::size_t computed = 0;
    nlohmann::ordered_json exports;
    set_exr_threads(options.map.threads);
    try {
        const ChosenAxes chosen = choose(options, rig, finest);
        request.axes = chosen.axes;
        request.interpolation = chosen.interpolation;
        const FolderLock lock = claim_folder(options.folder);
        remove_abandoned_files(fs::path(options.folder) / "bins");
        {
            std::optional<ProgressLine> line;
            request.progress = shown_as("mapping", line);
            computed = write_atlas(options.folder, rig, request);
        }
        exports = export_maps(options, rig, finest.altitude_m);
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", options.rig_file, error.what()));
    }
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    const InterpolationError& error = request.interpolation;
    const bool holds = options.tolerance == 0.0 || error.worst <= options.tolerance;
    const nlohmann::ordered_json outcome = {
        {"title", rig.title},
        {"rig_sha256", rig.digest},
        {"folder", options.folder},
        {"bins", points_of(request.axes).size()},
        {"computed", computed},
        {"interpolation",
         {{"worst", error.worst}, {"rms", error.rms}, {"crossed_by_edges", error.crossed_share}}},
        {"holds_tolerance", holds},
        {"exports", exports},
        {"atlas_s", elapsed.count()}};
    if (options.json) {
        fmt::print("{}\n", dumped(outcome));
    } else {
        print(outcome);
        if (!holds) {
            fmt::print("  not within the tolerance of {:.2g}: the steps allow no finer bins\n",
                       options.tolerance);
        }
    }
    return holds ? kDone : kAnswerIsNo;
}

}  // namespace

Action configure_atlas(CLI::App& app) {
    constexpr int kMostThreads = 1024;
    constexpr double kLeastTolerance = 1e-6;
    const auto options = std::make_shared<Options>();
    app.add_option("RIG", options->rig_file, "the rig file (TOML)")->required();
    app.add_option("-o,--output", options->folder, "the folder to write to")
        ->required()
        ->type_name("ATLAS");
    app.add_option("--altitude", options->altitude, "altitudes in metres, such as 1:4:0.1")
        ->required()
        ->type_name("FIRST:LAST:STEP");
    app.add_option("--pitch", options->pitch, "pitches in degrees; by default the rig's")
        ->type_name("FIRST:LAST:STEP");
    app.add_option("--roll", options->roll, "rolls in degrees; by default the rig's")
        ->type_name("FIRST:LAST:STEP");
    app.add_option("--water-multiple",
                   options->water,
                   "multiples of the water's absorption; by default the rig's")
        ->type_name("FIRST:LAST:STEP");
    app.add_option("--tolerance",
                   options->tolerance,
                   "of these, only as many as keep interpolation between bins within this relative "
                   "error, off the cones' edges")
        ->check(in_range(kLeastTolerance, 1.0));
    app.add_option("--export",
                   options->exports,
                   "beside the atlas, over all altitudes at the rig's own attitude and water: RGGB "
                   "mosaics (bayer), or a exp(b h) + c fitted to each pixel (exponential)")
        ->delimiter(',')
        ->check(CLI::IsMember({"bayer", "exponential"}))
        ->option_text("bayer,exponential");
    app.add_option("--threads", options->map.threads, "threads to map with; by default the cores")
        ->check(in_range(1, kMostThreads))
        ->capture_default_str();
    app.add_flag("--json", options->json, "say what was made as JSON");
    app.footer(
        "Of the bare flat floor; POV-Ray is not needed. An atlas that was interrupted goes on "
        "where\n"
        "it stopped. The answer is no (exit status 1) when the steps are too wide for "
        "--tolerance.");
    return [options] { return make_atlas(*options); };
}

}  // namespace aphotic::cli
