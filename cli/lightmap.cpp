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
#include "cli/options.h"
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

namespace aphotic::cli {
namespace {

struct LightmapCommandOptions {
    std::string rig_file;
    std::string file;
    std::optional<double> altitude_m;
    std::optional<double> pitch_deg;
    std::optional<double> roll_deg;
    std::optional<double> water_multiple;
    LightmapOptions map{.error = 1e-5, .threads = all_cores()};
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

struct MadeLightmap {
    std::string title;
    std::string rig_sha256;
    std::string file;
    int width_px = 0;
    int height_px = 0;
    Sled sled;
    std::vector<std::string> channels;
    std::array<float, kChannels> peaks{};
    bool is_normalised = false;
    double error = 0.0;
    MapPromise promise;
    PathRange paths;
    std::size_t grid = 0;
    int table_steps = 0;
    int threads = 1;
    double tables_s = 0.0;
    double map_s = 0.0;
};

nlohmann::ordered_json to_json(const MadeLightmap& made) {
    return {{"title", made.title},
            {"rig_sha256", made.rig_sha256},
            {"file", made.file},
            {"width_px", made.width_px},
            {"height_px", made.height_px},
            {"altitude_m", made.sled.altitude_m},
            {"pitch_deg", made.sled.pitch_rad / kRadiansPerDegree},
            {"roll_deg", made.sled.roll_rad / kRadiansPerDegree},
            {"channels", made.channels},
            {"peak", made.peaks},
            {"normalised", made.is_normalised},
            {"error", made.error},
            {"promise",
             {{"error", made.promise.error},
              {"bounded", made.promise.is_bounded},
              {"of_lamp_grids", made.promise.is_of_lamp_grids}}},
            {"paths_m", {made.paths.shortest_m, made.paths.longest_m}},
            {"grid", made.grid},
            {"table_steps", made.table_steps},
            {"threads", made.threads},
            {"tables_s", made.tables_s},
            {"map_s", made.map_s}};
}

void print(const MadeLightmap& made) {
    constexpr double kMilli = 1e3;
    fmt::print(
        "{}: {} x {} pixels in {:.0f} ms,\n"
        "  {};\n"
        "  {:.0f} ms more for {} of the paths from {:.4g} to {:.4g} m, of {}\n",
        made.title,
        made.width_px,
        made.height_px,
        kMilli * made.map_s,
        words_of(made.promise),
        kMilli * made.tables_s,
        counted(static_cast<std::size_t>(made.table_steps), "step"),
        made.paths.shortest_m,
        made.paths.longest_m,
        counted(made.grid, "wavelength"));
    fmt::print("  peaks {:.6g} (R), {:.6g} (G), {:.6g} (B){}\n",
               made.peaks[0],
               made.peaks[1],
               made.peaks[2],
               made.is_normalised ? ", each channel divided by its own" : "");
    fmt::print("  {}  {}\n", made.file, counted(made.channels.size(), "channel"));
}

MadeLightmap make_lightmap(const LightmapCommandOptions& options) {
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
                                 .has_preview = !options.preview_file.empty(),
                                 .threads = options.map.threads}),
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
    return {.title = rig.title,
            .rig_sha256 = rig.digest,
            .file = options.file,
            .width_px = map.width_px,
            .height_px = map.height_px,
            .sled = rig.sled,
            .channels = planes.names,
            .peaks = peaks,
            .is_normalised = options.normalised,
            .error = options.map.error,
            .promise = map_promise(rig, options.map),
            .paths = maker.paths(),
            .grid = maker.grid_size(),
            .table_steps = maker.table_steps(),
            .threads = options.map.threads,
            .tables_s = tables_s,
            .map_s = map_s};
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
    if (!std::filesystem::is_directory(options.rig_file)) {
        show(make_lightmap(options), options.json);
        return kDone;
    }
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
    app.add_option(kAltitudeNames, options.altitude_m, "Altitude in metres instead of the rig's")
        ->check(in_range(kLeastAltitude_m, kMostAltitude_m))
        ->option_text("M");
    app.add_option(kPitchNames, options.pitch_deg, "Pitch in degrees, bow up, instead of the rig's")
        ->check(in_range(-kMostTilt_deg, kMostTilt_deg))
        ->option_text("DEG");
    app.add_option(
           kRollNames, options.roll_deg, "Roll in degrees, starboard down, instead of the rig's")
        ->check(in_range(-kMostTilt_deg, kMostTilt_deg))
        ->option_text("DEG");
    app.add_option("--water-multiple",
                   options.water_multiple,
                   "Multiple of the water's absorption instead of the rig's")
        ->check(not_negative())
        ->option_text("M");
}

Action configure_lightmap(CLI::App& app) {
    constexpr double kLeastError = 1e-7;
    constexpr double kMostError = 0.1;
    const auto options = std::make_shared<LightmapCommandOptions>();
    app.add_option("RIG", options->rig_file, "The rig file (TOML), or the folder of an atlas")
        ->required();
    app.add_option("-o,--output", options->file, "Write the map to this OpenEXR file")
        ->required()
        ->type_name("FILE.exr");
    add_sled_options(app, *options);
    app.add_flag("--per-strobe",
                 options->per_strobe,
                 "Add each strobe's own light, in channels such as fore.R");
    app.add_flag("--per-cone",
                 options->per_cone,
                 "Add each cone's own light, in channels such as fore.collimated.R");
    app.add_flag("--normalised",
                 options->normalised,
                 "Divide each channel by its largest value, and parts by that of the whole");
    app.add_option("--error",
                   options->map.error,
                   "Relative error of the spectral integral and its table; the rounding of floats "
                   "adds to it, and an unbounded error behind a port")
        ->check(in_range(kLeastError, kMostError))
        ->option_text("E")
        ->capture_default_str();
    add_jobs(app, options->map.threads, "Map with N threads");
    add_needs_option(app, options->ignore_needs);
    add_json(app, options->json);
    app.add_option("--preview", options->preview_file, "Write a picture to look at, too")
        ->type_name("FILE.png")
        ->group("Preview");
    add_preview_options(app, options->preview);
    app.footer(
        "Maps the bare flat floor, without POV-Ray. The file holds what image.exr of a render "
        "does: R, G, B, linear, 32-bit floats. Given an atlas, blends the bins around the "
        "altitude, "
        "attitude and water; its preview's white is image (the default) or none.");
    return [&app, options] { return make_map(app, *options); };
}

}  // namespace

const Command kLightmap{"lightmap",
                        kMapCommands,
                        "Map the camera's signal on a bare flat floor in milliseconds",
                        configure_lightmap};

}  // namespace aphotic::cli
