// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic lightmap RIG -o FILE.exr: the camera's signal on the rig's bare flat floor, without
// rendering; with --altitude 1:4:0.1 -o DIR a map at each altitude, for other programs.
#include "cli/terminal.h"
#include "lightmap/lightmap_file.h"

#include "base/degrees.h"
#include "base/error.h"
#include "base/number.h"
#include "base/progress.h"
#include "base/words.h"
#include "base/work_folder.h"
#include "cli/command.h"
#include "cli/model_error.h"
#include "cli/options.h"
#include "cli/outcome.h"
#include "cli/output_folder.h"
#include "cli/rig_file.h"
#include "image/preview.h"
#include "lightmap/altitude_fit.h"
#include "lightmap/oplab_export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>

namespace aphotic::cli {
namespace {

namespace fs = std::filesystem;

struct LightmapCommandOptions {
    std::string rig_file;
    std::string output;              // a file, or a folder of maps by altitude
    std::string altitudes;           // empty: the rig's own
    std::vector<double> altitude_m;  // parsed from altitudes
    std::optional<double> pitch_deg;
    std::optional<double> roll_deg;
    std::optional<double> water_multiple;
    LightmapOptions map;
    std::string export_as;
    bool per_strobe = false;
    bool per_cone = false;
    bool normalised = false;
    std::string preview_file;
    PreviewOptions preview;
    bool ignore_needs = false;
    double model_tolerance = kModelTolerance;
    bool strict = false;
    bool json = false;
};

// From FROM:TO:STEP, both ends included; empty if the steps do not end at TO.
std::vector<double> range_of(double from, double to, double step) {
    constexpr double kMostSteps = 10000.0;
    constexpr double kWhole = 1e-6;
    constexpr double kDigits = 1e9;
    const double steps = (to - from) / step;
    const double whole = std::round(steps);
    if (!(whole >= 1.0 && whole <= kMostSteps && std::abs(steps - whole) <= kWhole)) return {};
    std::vector<double> values;
    for (int i = 0; i <= static_cast<int>(whole); ++i)
        values.push_back(std::round((from + i * step) * kDigits) / kDigits);
    return values;
}

std::vector<double> altitudes_in(const std::string& text) {
    std::vector<double> altitude_m;
    std::istringstream pieces(text);
    for (std::string piece; std::getline(pieces, piece, ',');) {
        std::vector<double> numbers;
        std::istringstream parts(piece);
        for (std::string part; std::getline(parts, part, ':');) {
            const std::size_t sign = part.starts_with('+') ? 1 : 0;
            const auto number = read_number<double>(std::string_view(part).substr(sign));
            if (!number) return {};
            numbers.push_back(*number);
        }
        if (numbers.size() == 3)
            numbers = range_of(numbers[0], numbers[1], numbers[2]);
        else if (numbers.size() != 1)
            return {};
        if (numbers.empty()) return {};
        altitude_m.insert(altitude_m.end(), numbers.begin(), numbers.end());
    }
    const bool is_increasing =
        std::ranges::adjacent_find(altitude_m, std::greater_equal<>()) == altitude_m.end();
    const bool is_within = std::ranges::all_of(
        altitude_m, [](double h_m) { return h_m >= kLeastAltitude_m && h_m <= kMostAltitude_m; });
    return is_increasing && is_within ? altitude_m : std::vector<double>{};
}

std::string altitude_fault(const std::string& text) {
    if (!altitudes_in(text).empty()) return "";
    return fmt::format(
        "found {}; allowed: {} to {}, or FROM:TO:STEP that ends at TO, or several of these with "
        "commas between, increasing",
        text,
        kLeastAltitude_m,
        kMostAltitude_m);
}

Rig rig_of(const LightmapCommandOptions& options) {
    Rig rig = read_rig_as_set(options.rig_file);
    if (options.altitude_m.size() == 1) rig.sled.altitude_m = options.altitude_m.front();
    if (options.pitch_deg) rig.sled.pitch_rad = *options.pitch_deg * kRadiansPerDegree;
    if (options.roll_deg) rig.sled.roll_rad = *options.roll_deg * kRadiansPerDegree;
    if (options.water_multiple) rig.water.multiple = *options.water_multiple;
    check_plausible(rig, options.rig_file, options.strict);
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
    std::string file;
    std::optional<ManifestModel> model{};  // of the map with its veil
    WrittenLightmap written{};
    std::optional<VeilShare> veil{};  // in the middle
    MapPromise promise{};
};

nlohmann::ordered_json to_json(const MadeLightmap& made) {
    const auto& [options, rig, file, model, written, veil, promise] = made;
    nlohmann::ordered_json json{{"title", rig.title},
                                {"rig_sha256", rig.digest},
                                {"file", file},
                                {"width_px", rig.camera.width_px},
                                {"height_px", rig.camera.height_px},
                                {"altitude_m", rig.sled.altitude_m},
                                {"pitch_deg", rig.sled.pitch_rad / kRadiansPerDegree},
                                {"roll_deg", rig.sled.roll_rad / kRadiansPerDegree},
                                {"channels", written.channels},
                                {"peak", written.peaks},
                                {"veil_in_the_middle", veil.value_or(VeilShare{})},
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
    const auto& [options, rig, file, model, written, veil, promise] = made;
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
    say("  peaks {:.6g} (R), {:.6g} (G), {:.6g} (B){}\n",
        written.peaks[0],
        written.peaks[1],
        written.peaks[2],
        options.normalised ? ", each channel divided by its own" : "");
    if (veil) say("  {}\n", veil_in_words(*veil));
    say("  {}  {}\n", file, counted(written.channels.size(), "channel"));
}

std::optional<ManifestModel> model_of(const LightmapCommandOptions& options, const Rig& rig) {
    if (!options.map.has_veil) return std::nullopt;
    return model_error(rig, options.rig_file, options.model_tolerance, "--altitude");
}

void require_room_for_maps(const LightmapCommandOptions& options,
                           const Rig& rig,
                           std::size_t maps,
                           const fs::path& folder) {
    const std::size_t parts = parts_of(options, rig).size();
    // The same number of planes again, of the whole and of each part.
    const bool has_veil = rig.water.scatters() && options.map.has_veil;
    require_room(lightmap_needs({.maps = maps,
                                 .width_px = rig.camera.width_px,
                                 .height_px = rig.camera.height_px,
                                 .parts = parts + (has_veil ? 1 + parts : 0),
                                 .has_preview = !options.preview_file.empty()}),
                 folder,
                 options.ignore_needs);
}

void write_map(MadeLightmap& made) {
    const LightmapCommandOptions& options = made.options;
    made.written = write_lightmap(made.rig,
                                  {.file = made.file,
                                   .parts = parts_of(options, made.rig),
                                   .is_normalised = options.normalised,
                                   .map = options.map,
                                   .version = APHOTIC_VERSION,
                                   .model = made.model});
    if (!made.written.map.veil.empty()) made.veil = veil_share_of(made.written.map);
    made.promise = map_promise(made.rig, options.map);
}

ExitStatus make_map(const LightmapCommandOptions& options, const Rig& rig) {
    if (fs::path(options.output).extension() != ".exr") {
        throw InputError(
            "--output: found {}; allowed: a name that ends in .exr, or a folder with "
            "several altitudes or --export",
            options.output);
    }
    MadeLightmap made{
        .options = options, .rig = rig, .file = options.output, .model = model_of(options, rig)};
    naming(options.rig_file, [&] {
        require_room_for_maps(options, rig, 1, fs::absolute(made.file).parent_path());
        write_map(made);
    });
    if (!options.preview_file.empty()) {
        const Lightmap& map = made.written.map;
        write_preview({map.width_px, map.height_px, signal_of(map)},
                      lamp_signal(rig, light_family(rig)),
                      options.preview,
                      options.preview_file);
    }
    show(made, options.json);
    return kDone;
}

Rig rig_at(Rig rig, double altitude_m) {
    rig.sled.altitude_m = altitude_m;
    return rig;
}

struct MadeMaps {
    std::string folder;
    std::vector<MadeLightmap> maps;
};

nlohmann::ordered_json to_json(const MadeMaps& made) {
    nlohmann::ordered_json json{{"folder", made.folder}, {"maps", nlohmann::json::array()}};
    for (const MadeLightmap& map : made.maps) json["maps"].push_back(to_json(map));
    return json;
}

void print(const MadeMaps& made) {
    const MadeLightmap& highest = made.maps.back();
    say("{}: {} of {} x {} pixels, {} to {} m,\n  {}\n",
        highest.rig.title,
        counted(made.maps.size(), "map"),
        highest.rig.camera.width_px,
        highest.rig.camera.height_px,
        made.maps.front().rig.sled.altitude_m,
        highest.rig.sled.altitude_m,
        words_of(highest.promise));
    print_model_error(highest.model);
    say("  {} to {}\n", made.maps.front().file, fs::path(highest.file).filename().string());
}

// Nothing is written until all maps are known to be possible.
ExitStatus make_maps(const LightmapCommandOptions& options, const Rig& rig) {
    MadeMaps made{.folder = options.output, .maps = {}};
    const std::vector<std::string> names = map_names(options.altitude_m);
    std::vector<std::optional<ManifestModel>> models(names.size());
    for (std::size_t i = names.size(); i-- > 0;)  // the highest is refused first
        models[i] = model_of(options, rig_at(rig, options.altitude_m[i]));
    for (std::size_t i = 0; i < names.size(); ++i) {
        made.maps.push_back({.options = options,
                             .rig = rig_at(rig, options.altitude_m[i]),
                             .file = (fs::path(options.output) / names[i]).string(),
                             .model = models[i]});
    }
    naming(options.rig_file, [&] {
        require_over_floor(made.maps.front().rig, made.maps.front().rig.sled);
        require_room_for_maps(options, rig, made.maps.size(), options.output);
        const WorkFolder place(options.output);
        remove_maps(options.output);
        ProgressLine line;
        for (std::size_t i = 0; i < made.maps.size(); ++i) {
            line.show("mapping", static_cast<double>(i) / static_cast<double>(made.maps.size()));
            write_map(made.maps[i]);
            made.maps[i].written.map = {};  // hundreds of maps would not fit in memory
        }
    });
    show(made, options.json);
    return kDone;
}

struct MadeOplab {
    const LightmapCommandOptions& options;
    Rig rig;
    std::optional<ManifestModel> model{};  // of the highest map
    ExportedOplab written{};
};

nlohmann::ordered_json to_json(const MadeOplab& made) {
    nlohmann::ordered_json json{{"title", made.rig.title},
                                {"rig_sha256", made.rig.digest},
                                {"folder", made.options.output},
                                {"altitudes_m", made.options.altitude_m},
                                {"oplab", to_json(made.written)}};
    put_model_error(json, made.model);
    return json;
}

void print(const MadeOplab& made) {
    constexpr double kPercent = 100.0;
    say("{}: {} of {} x {} pixels, {} to {} m\n",
        made.rig.title,
        counted(made.options.altitude_m.size(), "altitude"),
        made.rig.camera.width_px,
        made.rig.camera.height_px,
        made.options.altitude_m.front(),
        made.options.altitude_m.back());
    print_model_error(made.model);
    say("  {}  parameters for oplab's correct_images, off by {:.2g} of a pixel's mean rms, {:.2g} "
        "at most;\n  {:.1f} % of all light by over {:.0f} %\n",
        made.options.output,
        made.written.rms,
        made.written.worst,
        kPercent * made.written.share_off,
        kPercent * kOplabOff);
}

ExitStatus export_maps(const LightmapCommandOptions& options, const Rig& rig) {
    MadeOplab made{.options = options, .rig = rig};
    naming(options.rig_file, [&] {
        static_cast<void>(AltitudeFitter{options.altitude_m});  // throws if not even
        require_over_floor(rig, rig_at(rig, options.altitude_m.front()).sled);
        made.model = model_of(options, rig_at(rig, options.altitude_m.back()));
        require_room(oplab_needs(rig.camera.width_px, rig.camera.height_px),
                     options.output,
                     options.ignore_needs);
        const WorkFolder place(options.output);
        ProgressLine line;
        made.written = export_oplab(
            options.output,
            rig,
            {.altitude_m = options.altitude_m, .map = options.map, .progress = [&](double share) {
                 line.show("fitting", share);
             }});
    });
    show(made, options.json);
    return kDone;
}

ExitStatus run_lightmap(LightmapCommandOptions options) {
    if (!options.altitudes.empty()) options.altitude_m = altitudes_in(options.altitudes);
    const std::size_t altitudes = options.altitude_m.size();
    const bool is_folder = altitudes > 1 || !options.export_as.empty();
    if (is_folder && fs::path(options.output).extension() == ".exr") {
        throw InputError("--output: found {}; allowed: a folder, for several altitudes or --export",
                         options.output);
    }
    if (is_folder && !options.preview_file.empty()) {
        throw InputError("--preview: found with {}; allowed: with one map",
                         counted(altitudes, "altitude"));
    }
    const Rig rig = rig_of(options);
    if (!options.export_as.empty()) return export_maps(options, rig);
    return altitudes > 1 ? make_maps(options, rig) : make_map(options, rig);
}

void add_sled_options(CLI::App& app, LightmapCommandOptions& options) {
    add_option(app, "--altitude", options.altitudes)->check(CLI::Validator(altitude_fault, ""));
    add_option(app, "--pitch", options.pitch_deg)->check(in_range(-kMostTilt_deg, kMostTilt_deg));
    add_option(app, "--roll", options.roll_deg)->check(in_range(-kMostTilt_deg, kMostTilt_deg));
    add_option(app, "--water-multiple", options.water_multiple)->check(not_negative());
}

}  // namespace

Action configure_lightmap(CLI::App& app) {
    const auto options = std::make_shared<LightmapCommandOptions>();
    options->map = {.error = 1e-5, .threads = all_cores()};
    add_rig(app, options->rig_file);
    add_option(app, "--output", options->output)->required();
    add_sled_options(app, *options);
    CLI::Option* exported =
        add_option(app, "--export", options->export_as)->check(CLI::IsMember({"oplab"}));
    add_flag(app, "--per-strobe", options->per_strobe)->excludes(exported);
    add_flag(app, "--per-cone", options->per_cone)->excludes(exported);
    add_flag(app, "--normalised", options->normalised)->excludes(exported);
    add_option(app, "--error", options->map.error)->check(in_range(kLeastMapError, kMostMapError));
    add_option(app, "--tolerance", options->map.veil_tolerance)
        ->check(in_range(0.0, kMostMapError));
    add_flag(app, "--no-veil", [options] { options->map.has_veil = false; });
    add_model_tolerance(app, options->model_tolerance);
    add_strict_option(app, options->strict);
    add_jobs(app, options->map.threads);
    add_needs_option(app, options->ignore_needs);
    add_json(app, options->json);
    add_option(app, "--preview", options->preview_file)->group("Preview");
    add_preview_options(app, options->preview);
    return [options] { return run_lightmap(*options); };
}

}  // namespace aphotic::cli
