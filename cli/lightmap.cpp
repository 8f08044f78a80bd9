// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic lightmap RIG -o FILE.exr: the camera's signal on the rig's bare flat floor, at once; or
// of an atlas, from its bins (atlas_map.h).
#include "lightmap/lightmap.h"

#include "base/degrees.h"
#include "base/error.h"
#include "base/words.h"
#include "cli/atlas_map.h"
#include "cli/command.h"
#include "cli/needs_check.h"
#include "cli/option_checks.h"
#include "cli/outcome.h"
#include "image/exr.h"
#include "image/preview.h"
#include "lightmap/planes.h"
#include "rig/rig_reader.h"
#include "scene_gen/scene_set.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>

namespace aphotic::cli {
namespace {

struct LightmapCommandOptions {
    std::string rig_file;
    std::string file;
    std::optional<double> altitude_m;
    std::optional<double> pitch_deg;
    std::optional<double> roll_deg;
    std::optional<double> water_multiple;
    LightmapOptions map{
        .error = 1e-5,
        .threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()))};
    bool per_strobe = false;
    bool per_cone = false;
    bool normalised = false;
    std::string preview_file;
    PreviewOptions preview;
    bool ignore_needs = false;
    bool json = false;
};

Rig rig_of(const LightmapCommandOptions& options) {
    Rig rig = read_rig(options.rig_file);
    if (options.altitude_m) rig.sled.altitude_m = *options.altitude_m;
    if (options.pitch_deg) rig.sled.pitch_rad = *options.pitch_deg * kRadiansPerDegree;
    if (options.roll_deg) rig.sled.roll_rad = *options.roll_deg * kRadiansPerDegree;
    if (options.water_multiple) rig.water.multiple = *options.water_multiple;
    return rig;
}

std::vector<RigPart> parts_of(const LightmapCommandOptions& options, const Rig& rig) {
    std::vector<RigPart> parts;
    if (options.per_strobe) parts = parts_by_strobe(rig);
    if (options.per_cone) std::ranges::move(parts_by_cone(rig), std::back_inserter(parts));
    require_different_names(parts);
    return parts;
}

// The planes of the file, one after another, and their names.
struct Planes {
    std::vector<std::string> names;
    std::vector<float> samples;

    void take(const std::string& layer, const Lightmap& map) {
        for (const std::string_view channel : kChannelNames) {
            names.push_back(layer.empty() ? std::string(channel)
                                          : fmt::format("{}.{}", layer, channel));
        }
        samples.insert(samples.end(), map.samples.begin(), map.samples.end());
    }
};

void write(const LightmapCommandOptions& options, const Rig& rig, const Planes& planes) {
    ExrWriter writer(
        options.file,
        rig.camera.width_px,
        rig.camera.height_px,
        planes.names,
        {{"aphotic:version", APHOTIC_VERSION},
         {"aphotic:rig_title", rig.title},
         {"aphotic:rig_sha256", rig.digest},
         {"aphotic:renderer", "lightmap"},
         {"aphotic:altitude_m", fmt::format("{}", rig.sled.altitude_m)},
         {"aphotic:pitch_deg", fmt::format("{}", rig.sled.pitch_rad / kRadiansPerDegree)},
         {"aphotic:roll_deg", fmt::format("{}", rig.sled.roll_rad / kRadiansPerDegree)},
         {"aphotic:normalised", options.normalised ? "yes" : "no"},
         {"aphotic:error", fmt::format("{}", options.map.error)}});
    writer.write_rows(rig.camera.height_px, planes.samples);
    writer.finish();
}

std::string words_of(const MapPromise& promise) {
    return fmt::format("{} to {:.1e} of a signal off the cones' edges{}{}",
                       promise.is_bounded ? "exact" : "near",
                       promise.error,
                       promise.is_bounded ? "" : ", as measured behind ports and not bounded",
                       promise.is_of_lamp_grids ? ", emitters being grids of lamps" : "");
}

ExitStatus make_lightmap(const LightmapCommandOptions& options) {
    const auto seconds_since = [](auto start) {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    const Rig rig = rig_of(options);
    const auto prefixed = [&](const auto& work) {
        try {
            return work();
        } catch (const InputError& error) {
            throw InputError(fmt::format("{}: {}", options.rig_file, error.what()));
        }
    };
    const std::vector<RigPart> parts = prefixed([&] { return parts_of(options, rig); });
    require_room(lightmap_needs({.width_px = rig.camera.width_px,
                                 .height_px = rig.camera.height_px,
                                 .parts = parts.size(),
                                 .has_preview = !options.preview_file.empty()}),
                 std::filesystem::absolute(options.file).parent_path(),
                 options.ignore_needs);
    const auto start = std::chrono::steady_clock::now();
    const LightmapMaker maker =
        prefixed([&] { return LightmapMaker(rig, std::nullopt, options.map); });
    const double tables_s = seconds_since(start);
    const auto mapping = std::chrono::steady_clock::now();
    Lightmap map = maker.map(rig.sled);
    const double map_s = seconds_since(mapping);

    const std::array<float, kChannels> peaks = peaks_of(map);
    if (options.normalised) divide_by(peaks, map);
    Planes planes;
    planes.samples.reserve((1 + parts.size()) * map.samples.size());
    planes.take("", map);
    for (const RigPart& part : parts) {
        Lightmap share = LightmapMaker(part.rig, maker.paths(), options.map).map(rig.sled);
        if (options.normalised) divide_by(peaks, share);
        planes.take(part.name, share);
    }
    set_exr_threads(options.map.threads);
    write(options, rig, planes);
    if (!options.preview_file.empty()) {
        write_preview({map.width_px, map.height_px, map.samples},
                      lamp_signal(rig, light_family(rig)),
                      options.preview,
                      options.preview_file);
    }

    const MapPromise promise = map_promise(rig, options.map);
    nlohmann::ordered_json outcome = {
        {"title", rig.title},
        {"rig_sha256", rig.digest},
        {"file", options.file},
        {"width_px", map.width_px},
        {"height_px", map.height_px},
        {"altitude_m", rig.sled.altitude_m},
        {"pitch_deg", rig.sled.pitch_rad / kRadiansPerDegree},
        {"roll_deg", rig.sled.roll_rad / kRadiansPerDegree},
        {"channels", planes.names},
        {"peak", peaks},
        {"normalised", options.normalised},
        {"error", options.map.error},
        {"promise",
         {{"error", promise.error},
          {"bounded", promise.is_bounded},
          {"of_lamp_grids", promise.is_of_lamp_grids}}},
        {"paths_m", {maker.paths().shortest_m, maker.paths().longest_m}},
        {"grid", maker.grid_size()},
        {"table_steps", maker.table_steps()},
        {"threads", options.map.threads},
        {"tables_s", tables_s},
        {"map_s", map_s}};
    if (options.json) {
        fmt::print("{}\n", dumped(outcome));
        return kDone;
    }
    fmt::print(
        "{}: {} x {} pixels in {:.0f} ms,\n"
        "  {};\n"
        "  {:.0f} ms more for {} of the paths from {:.4g} to {:.4g} m, of {}\n",
        rig.title,
        map.width_px,
        map.height_px,
        1e3 * map_s,
        words_of(promise),
        1e3 * tables_s,
        counted(static_cast<std::size_t>(maker.table_steps()), "step"),
        maker.paths().shortest_m,
        maker.paths().longest_m,
        counted(maker.grid_size(), "wavelength"));
    fmt::print("  peaks {:.6g} (R), {:.6g} (G), {:.6g} (B){}\n",
               peaks[0],
               peaks[1],
               peaks[2],
               options.normalised ? ", by which each channel is divided" : "");
    fmt::print("  {}  {}\n", options.file, counted(planes.names.size(), "channel"));
    return kDone;
}

void refuse_what_needs_a_rig(const CLI::App& app, const LightmapCommandOptions& options) {
    for (const char* option : {"--per-strobe", "--per-cone", "--error"}) {
        if (app.count(option) == 0) continue;
        throw InputError(fmt::format(
            "{}: found with the atlas {}; allowed: with a rig", option, options.rig_file));
    }
    if (app.count("--preview-white") > 0 && options.preview.white == PreviewWhite::Lamp) {
        throw InputError(
            "--preview-white: found lamp, which an atlas does not know; allowed: image, none");
    }
}

ExitStatus make_map(const CLI::App& app, const LightmapCommandOptions& options) {
    if (!std::filesystem::is_directory(options.rig_file)) return make_lightmap(options);
    refuse_what_needs_a_rig(app, options);
    PreviewOptions preview = options.preview;
    if (preview.white == PreviewWhite::Lamp) preview.white = PreviewWhite::Image;  // by default
    set_exr_threads(options.map.threads);
    return write_atlas_map({.folder = options.rig_file,
                            .file = options.file,
                            .altitude_m = options.altitude_m,
                            .pitch_deg = options.pitch_deg,
                            .roll_deg = options.roll_deg,
                            .water_multiple = options.water_multiple,
                            .normalised = options.normalised,
                            .preview_file = options.preview_file,
                            .preview = preview,
                            .json = options.json});
}

void add_sled_options(CLI::App& app, LightmapCommandOptions& options) {
    constexpr double kLeastAltitude_m = 0.001;
    constexpr double kMostAltitude_m = 10000.0;
    constexpr double kMostTilt_deg = 89.9;
    app.add_option("--altitude-m", options.altitude_m, "instead of the rig's altitude")
        ->check(in_range(kLeastAltitude_m, kMostAltitude_m));
    app.add_option("--pitch-deg", options.pitch_deg, "instead of the rig's pitch, bow up")
        ->check(in_range(-kMostTilt_deg, kMostTilt_deg));
    app.add_option("--roll-deg", options.roll_deg, "instead of the rig's roll, starboard down")
        ->check(in_range(-kMostTilt_deg, kMostTilt_deg));
    app.add_option("--water-multiple",
                   options.water_multiple,
                   "instead of the rig's multiple of the water's absorption")
        ->check(not_negative());
}

}  // namespace

Action configure_lightmap(CLI::App& app) {
    constexpr int kMostThreads = 1024;
    constexpr double kLeastError = 1e-7;
    constexpr double kMostError = 0.1;
    const auto options = std::make_shared<LightmapCommandOptions>();
    app.add_option("RIG", options->rig_file, "the rig file (TOML), or the folder of an atlas")
        ->required();
    app.add_option("-o,--output", options->file, "the OpenEXR file to write")
        ->required()
        ->type_name("FILE.exr");
    add_sled_options(app, *options);
    app.add_flag("--per-strobe",
                 options->per_strobe,
                 "what each strobe gives too, in channels such as fore.R");
    app.add_flag("--per-cone",
                 options->per_cone,
                 "what each cone of each strobe gives too, in channels such as fore.collimated.R");
    app.add_flag(
        "--normalised",
        options->normalised,
        "each channel divided by its largest value; absolute by default. Parts are divided "
        "by what the whole is");
    app.add_option("--error",
                   options->map.error,
                   "relative error of the spectral integral and its table; the rounding of floats "
                   "comes on top, and behind a port what is not bounded")
        ->check(in_range(kLeastError, kMostError))
        ->capture_default_str();
    app.add_option("--preview", options->preview_file, "a picture to look at, too")
        ->type_name("FILE.png");
    add_preview_options(app, options->preview);
    app.add_option("--threads", options->map.threads, "threads to map with; by default the cores")
        ->check(in_range(1, kMostThreads))
        ->capture_default_str();
    add_needs_option(app, options->ignore_needs);
    app.add_flag("--json", options->json, "say what was made as JSON");
    app.footer(
        "Of the bare flat floor; POV-Ray is not needed. The file holds what image.exr of a render\n"
        "does: R, G, B, linear, 32-bit floats. Of an atlas it is blended from the bins about that\n"
        "altitude, attitude and water, and the preview's white is image or none: image by "
        "default.");
    return [&app, options] { return make_map(app, *options); };
}

}  // namespace aphotic::cli
