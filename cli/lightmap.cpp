// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic lightmap RIG -o FILE.exr: the camera's signal on the rig's bare flat floor, at once; or
// of an atlas, from its bins (atlas_map.h).
#include "cli/terminal.h"
#include "lightmap/lightmap_file.h"

#include "base/degrees.h"
#include "base/error.h"
#include "base/words.h"
#include "cli/atlas_map.h"
#include "cli/command.h"
#include "cli/options.h"
#include "cli/outcome.h"
#include "cli/output_folder.h"
#include "cli/rig_file.h"
#include "image/exr.h"
#include "image/preview.h"
#include "rig/rig_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>

namespace aphotic::cli {
namespace {

Rig rig_of(const LightmapCommandOptions& options) {
    Rig rig = read_rig(options.source);
    if (options.altitude_m) rig.sled.altitude_m = *options.altitude_m;
    if (options.pitch_deg) rig.sled.pitch_rad = *options.pitch_deg * kRadiansPerDegree;
    if (options.roll_deg) rig.sled.roll_rad = *options.roll_deg * kRadiansPerDegree;
    if (options.water_multiple) rig.water.multiple = *options.water_multiple;
    check_plausible(rig, options.source, options.strict);
    return rig;
}

std::vector<RigPart> parts_of(const LightmapCommandOptions& options, const Rig& rig) {
    std::vector<RigPart> parts;
    if (options.per_strobe) parts = parts_by_strobe(rig);
    if (options.per_cone) std::ranges::move(parts_by_cone(rig), std::back_inserter(parts));
    require_different_names(parts);
    return parts;
}

std::string words_of(const MapPromise& promise) {
    return fmt::format("{} to {:.1e} of a signal off the beams' edges{}{}",
                       promise.is_bounded ? "exact" : "near",
                       promise.error,
                       promise.is_bounded ? ""
                       : promise.has_veil ? ", the veil included, as measured and not bounded"
                                          : ", as measured behind ports and not bounded",
                       promise.is_of_lamp_grids ? ", emitters being grids of lamps" : "");
}

struct MadeLightmap {
    const LightmapCommandOptions& options;
    Rig rig;
    WrittenLightmap written{};
    MapPromise promise{};
    std::optional<ManifestModel> model{};  // of the map with its veil
};

nlohmann::ordered_json to_json(const MadeLightmap& made) {
    const auto& [options, rig, written, promise, model] = made;
    nlohmann::ordered_json json{{"title", rig.title},
                                {"rig_sha256", rig.digest},
                                {"file", options.file},
                                {"width_px", rig.camera.width_px},
                                {"height_px", rig.camera.height_px},
                                {"altitude_m", rig.sled.altitude_m},
                                {"pitch_deg", rig.sled.pitch_rad / kRadiansPerDegree},
                                {"roll_deg", rig.sled.roll_rad / kRadiansPerDegree},
                                {"channels", written.channels},
                                {"peak", written.peaks},
                                {"veil_in_the_middle", veil_share_of(written.map)},
                                {"normalised", options.normalised},
                                {"error", options.map.error},
                                {"promise",
                                 {{"error", promise.error},
                                  {"bounded", promise.is_bounded},
                                  {"of_lamp_grids", promise.is_of_lamp_grids}}},
                                {"paths_m", {written.paths.shortest_m, written.paths.longest_m}},
                                {"grid", written.grid_size},
                                {"table_steps", written.table_steps},
                                {"threads", options.map.threads},
                                {"tables_s", written.tables_s},
                                {"map_s", written.map_s}};
    put_model_error(json, model);
    return json;
}

void print(const MadeLightmap& made) {
    constexpr double kMilli = 1e3;
    const auto& [options, rig, written, promise, model] = made;
    say("{}: {} x {} pixels in {:.0f} ms,\n"
        "  {};\n"
        "  {:.0f} ms more for {} of the paths from {:.4g} to {:.4g} m, of {}\n",
        rig.title,
        rig.camera.width_px,
        rig.camera.height_px,
        kMilli * written.map_s,
        words_of(promise),
        kMilli * written.tables_s,
        counted(static_cast<std::size_t>(written.table_steps), "step"),
        written.paths.shortest_m,
        written.paths.longest_m,
        counted(written.grid_size, "wavelength"));
    print_model_error(model);
    print_peaks(written.peaks, options.normalised);
    if (!written.map.veil.empty()) say("  {}\n", veil_in_words(veil_share_of(written.map)));
    say("  {}  {}\n", options.file, counted(written.channels.size(), "channel"));
}

WrittenLightmap write_map(const LightmapCommandOptions& options,
                          const Rig& rig,
                          const std::optional<ManifestModel>& model) {
    LightmapRequest request{.file = options.file,
                            .parts = parts_of(options, rig),
                            .is_normalised = options.normalised,
                            .map = options.map,
                            .version = APHOTIC_VERSION,
                            .model = model};
    // As many planes again, of the whole and of each part.
    const bool has_veil = rig.water.scatters() && options.map.has_veil;
    const std::size_t planes_of_veil = has_veil ? 1 + request.parts.size() : 0;
    require_room(lightmap_needs({.width_px = rig.camera.width_px,
                                 .height_px = rig.camera.height_px,
                                 .parts = request.parts.size() + planes_of_veil,
                                 .has_preview = !options.preview_file.empty()}),
                 std::filesystem::absolute(options.file).parent_path(),
                 options.ignore_needs);
    return write_lightmap(rig, request);
}

ExitStatus make_lightmap(const LightmapCommandOptions& options) {
    MadeLightmap made{.options = options, .rig = rig_of(options)};
    if (options.map.has_veil)
        made.model = model_error(made.rig, options.source, options.model_tolerance);
    made.written = naming(options.source, [&] { return write_map(options, made.rig, made.model); });
    made.promise = map_promise(made.rig, options.map);
    if (!options.preview_file.empty()) {
        const Lightmap& map = made.written.map;
        write_preview({map.width_px, map.height_px, signal_of(map)},
                      lamp_signal(made.rig, light_family(made.rig)),
                      options.preview,
                      options.preview_file);
    }
    show(made, options.json);
    return kDone;
}

void refuse_what_needs_a_rig(const CLI::App& app, const LightmapCommandOptions& options) {
    for (const char* option : {"--per-strobe", "--per-cone", "--error", "--no-veil", "--strict"}) {
        if (app.count(option) == 0) continue;
        throw InputError(
            "{}: found with the atlas {}; allowed: with a rig", option, options.source);
    }
    if (app.count("--preview-white") > 0 && options.preview.white == PreviewWhite::Lamp) {
        throw InputError(
            "--preview-white: found lamp, which an atlas does not know; allowed: image, none");
    }
}

ExitStatus make_map(const CLI::App& app, const LightmapCommandOptions& options) {
    if (!std::filesystem::is_directory(options.source)) return make_lightmap(options);
    refuse_what_needs_a_rig(app, options);
    set_exr_threads(options.map.threads);
    return write_atlas_map(options);
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
    options->map = {.error = 1e-5, .threads = all_cores()};
    app.add_option("RIG", options->source, "The rig file (TOML), or the folder of an atlas")
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
    app.add_flag_callback(
        "--no-veil",
        [options] { options->map.has_veil = false; },
        "Leave out the light that the water scatters into the view");
    add_model_tolerance(app, options->model_tolerance);
    add_strict_option(app, options->strict);
    add_jobs(app, options->map.threads, "Map with N threads");
    add_needs_option(app, options->ignore_needs);
    add_json(app, options->json);
    app.add_option("--preview", options->preview_file, "Write a picture to look at, too")
        ->type_name("FILE.png")
        ->group("Preview");
    add_preview_options(app, options->preview);
    app.footer(
        "Maps the bare flat floor, without POV-Ray. The file holds what image.exr of a render "
        "does: R, G, B, linear, 32-bit floats, and the veil apart, as veil.R, veil.G, veil.B, "
        "where "
        "the water scatters. Given an atlas, blends the bins around the "
        "altitude, attitude and water; its preview's white is image (the default) or none.");
    return [&app, options] { return make_map(app, *options); };
}

}  // namespace

const Command kLightmap{"lightmap",
                        kMapCommands,
                        "Map the camera's signal on a bare flat floor in milliseconds",
                        configure_lightmap};

}  // namespace aphotic::cli
