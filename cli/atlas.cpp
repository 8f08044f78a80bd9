// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic atlas RIG --altitude 1:4:0.1 -o ATLAS: maps over altitude, attitude and water.
#include "lightmap/atlas.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/progress.h"
#include "base/words.h"
#include "cli/atlas_axes.h"
#include "cli/command.h"
#include "cli/needs_check.h"
#include "cli/option_checks.h"
#include "cli/outcome.h"
#include "cli/output_folder.h"
#include "image/exr.h"
#include "lightmap/altitude_fit.h"
#include "lightmap/atlas_export.h"
#include "rig/rig_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <thread>

namespace aphotic::cli {
namespace {

namespace fs = std::filesystem;

struct AtlasCommandOptions {
    std::string rig_file;
    std::string folder;
    AxisTexts axes;
    double tolerance = 0.0;  // 0: every value of the axes
    std::vector<std::string> exports;
    LightmapOptions map{
        .error = 1e-5,
        .threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()))};
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
    note_exports(options.folder, made);
    return made;
}

nlohmann::ordered_json json_of(const AtlasCommandOptions& options, const AtlasExports& exports) {
    nlohmann::ordered_json made = nlohmann::ordered_json::object();
    const fs::path folder = options.folder;
    if (!exports.bayer.empty()) {
        made["bayer"] = {{"folder", (folder / exports.bayer.front().file).parent_path().string()},
                         {"bins", exports.bayer.size()}};
    }
    if (exports.exponential) {
        made["exponential"] = {{"file", (folder / exports.exponential->file).string()},
                               {"rms", exports.exponential->rms},
                               {"worst", exports.exponential->worst}};
    }
    return made;
}

void print_atlas(const nlohmann::ordered_json& outcome) {
    fmt::print("{}: {}, {} of them computed, in {:.1f} s\n",
               outcome["title"].get<std::string>(),
               counted(outcome["bins"].get<std::size_t>(), "bin"),
               outcome["computed"].get<std::size_t>(),
               outcome["atlas_s"].get<double>());
    const auto& error = outcome["interpolation"];
    fmt::print(
        "  between bins the light without the cones' edges is off by {:.2g} at most, {:.2g} rms, "
        "as measured\n",
        error["worst"].get<double>(),
        error["rms"].get<double>());
    const auto& whole = error["whole_maps"];
    fmt::print(
        "  whole maps by {:.2g} rms, {:.1f} % of their samples by over {:.2g} (in {}): edges cross "
        "{:.1f} % of\n  the pixels on the way from bin to bin, and step there\n",
        whole["rms"].get<double>(),
        100.0 * whole["share_over_limit"].get<double>(),
        whole["limit"].get<double>(),
        counted(whole["cells"].get<std::size_t>(), "cell"),
        100.0 * error["crossed_by_edges"].get<double>());
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

ChosenAxes choose(const AtlasCommandOptions& options, const Rig& rig, const MapAxes& finest) {
    std::optional<ProgressLine> line;
    const MeasureOptions measure{.threads = options.map.threads,
                                 .progress = shown_as("measuring", line)};
    if (options.tolerance > 0.0) return axes_for(rig, finest, options.tolerance, measure);
    return {.axes = finest,
            .interpolation = interpolation_error(rig, finest, kWholeLimit, measure)};
}

// Of a map of the rig's size.
AtlasWork work_of(const AtlasCommandOptions& options, const Rig& rig, const MapAxes& finest) {
    return {.size = {.width_px = rig.camera.width_px, .height_px = rig.camera.height_px},
            .altitudes = finest.altitude_m.size(),
            .has_mosaics = is_exported(options, "bayer"),
            .has_fits = is_exported(options, "exponential")};
}

// Says what is to come, and refuses it where the disk has no room for it.
void announce(const AtlasCommandOptions& options, const MapAxes& chosen, AtlasWork work) {
    const std::size_t all = bin_count(chosen);
    // One more, for a bin is written beside the one that it replaces.
    work.bins = std::min(all, bins_missing(options.folder, chosen) + 1);
    const DiskNeeds needs = atlas_needs(work);
    if (!options.json) {
        fmt::print("{} of {} x {} pixels: up to {} to write to {}\n",
                   counted(all, "bin"),
                   work.size.width_px,
                   work.size.height_px,
                   bytes_in_words(needs.folder_bytes),
                   options.folder);
        std::fflush(stdout);
    }
    require_room(needs, options.folder, options.ignore_needs);
}

struct MadeAtlas {
    ChosenAxes chosen;
    std::size_t computed = 0;
    AtlasExports exports;
};

MadeAtlas make(const AtlasCommandOptions& options, const Rig& rig, const MapAxes& finest) {
    require_over_floor(rig, finest);
    if (is_exported(options, "exponential"))
        AltitudeFitter{finest.altitude_m};  // or it says why not
    MadeAtlas made{.chosen = choose(options, rig, finest), .exports = {}};
    announce(options, made.chosen.axes, work_of(options, rig, finest));
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
                                     .progress = shown_as("mapping", line)});
    }
    made.exports = export_maps(options, rig, finest.altitude_m);
    return made;
}

MadeAtlas make_named(const AtlasCommandOptions& options, const Rig& rig, const MapAxes& finest) {
    try {
        return make(options, rig, finest);
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", options.rig_file, error.what()));
    }
}

nlohmann::ordered_json noted_interpolation(const fs::path& folder) {
    return nlohmann::ordered_json::parse(read_text_file(folder / "atlas.json"))["interpolation"];
}

ExitStatus make_atlas(const AtlasCommandOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    const Rig rig = read_rig(options.rig_file);
    const MadeAtlas made = make_named(options, rig, axes_of(options.axes, rig));
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    const InterpolationError& error = made.chosen.interpolation;
    const bool holds = options.tolerance == 0.0 || error.worst <= options.tolerance;
    const nlohmann::ordered_json outcome = {{"title", rig.title},
                                            {"rig_sha256", rig.digest},
                                            {"folder", options.folder},
                                            {"bins", bin_count(made.chosen.axes)},
                                            {"computed", made.computed},
                                            {"interpolation", noted_interpolation(options.folder)},
                                            {"holds_tolerance", holds},
                                            {"exports", json_of(options, made.exports)},
                                            {"atlas_s", elapsed.count()}};
    if (options.json) {
        fmt::print("{}\n", dumped(outcome));
        return holds ? kDone : kAnswerIsNo;
    }
    print_atlas(outcome);
    if (!holds) {
        fmt::print("  not within the tolerance of {:.2g}: the steps allow no finer bins\n",
                   options.tolerance);
    }
    return holds ? kDone : kAnswerIsNo;
}

}  // namespace

Action configure_atlas(CLI::App& app) {
    constexpr int kMostThreads = 1024;
    constexpr double kLeastTolerance = 1e-6;
    const auto options = std::make_shared<AtlasCommandOptions>();
    app.add_option("RIG", options->rig_file, "the rig file (TOML)")->required();
    app.add_option("-o,--output", options->folder, "the folder to write to")
        ->required()
        ->type_name("ATLAS");
    add_axis_options(app, options->axes);
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
    add_needs_option(app, options->ignore_needs);
    app.add_flag("--json", options->json, "say what was made as JSON");
    app.footer(
        "Of the bare flat floor; POV-Ray is not needed. An atlas that was interrupted goes on "
        "where\n"
        "it stopped. The answer is no (exit status 1) when the steps are too wide for "
        "--tolerance.");
    return [options] { return make_atlas(*options); };
}

}  // namespace aphotic::cli
