// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/atlas.h"

#include "base/atomic_file.h"
#include "base/degrees.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/printable.h"
#include "base/sha256.h"
#include "base/work_folder.h"
#include "image/exr.h"
#include "image/image_size.h"
#include "lightmap/planes.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <optional>

namespace aphotic {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using OrderedJson = nlohmann::ordered_json;  // as a reader of the file would like it

namespace {

constexpr const char* kFormat = "aphotic-atlas-1";

// Of a number that was read in degrees and metres: as it was written, without the rounding of
// radians.
double as_written(double value) {
    constexpr double kSteps = 1e9;
    return std::round(value * kSteps) / kSteps + 0.0;  // no negative zero
}

std::vector<double> scaled(std::vector<double> values, double factor) {
    for (double& value : values) value *= factor;
    return values;
}

std::vector<double> in_degrees(const std::vector<double>& values_rad) {
    std::vector<double> values_deg;
    for (const double rad : values_rad) values_deg.push_back(as_written(rad / kRadiansPerDegree));
    return values_deg;
}

fs::path manifest_path(const fs::path& folder) {
    return folder / "atlas.json";
}

fs::path bin_path(const fs::path& folder, const MapPoint& point) {
    return folder / "bins" / bin_name(point);
}

InterpolationError interpolation_of(const Json& json) {
    const Json& whole = json.at("whole_maps");
    return {.worst = json.at("worst"),
            .rms = json.at("rms"),
            .whole_cells = static_cast<std::size_t>(whole_number_at(whole, "cells")),
            .crossed_share = json.at("crossed_by_edges"),
            .whole_rms = whole.at("rms"),
            .whole_limit = whole.at("limit"),
            .whole_over = whole.at("share_over_limit")};
}

OrderedJson json_of(const AtlasExports& exports) {
    OrderedJson json = OrderedJson::object();
    for (const ExportedMosaic& mosaic : exports.bayer) {
        json["bayer"].push_back({{"file", mosaic.file}, {"altitude_m", mosaic.altitude_m}});
    }
    if (exports.exponential) {
        json["exponential"] = {{"file", exports.exponential->file},
                               {"rms", exports.exponential->rms},
                               {"worst", exports.exponential->worst}};
    }
    if (exports.oplab) json["oplab"] = to_json(*exports.oplab);
    return json;
}

AtlasExports exports_of(const Json& json) {
    AtlasExports exports;
    if (json.contains("bayer")) {
        for (const Json& mosaic : json["bayer"]) {
            exports.bayer.push_back(
                {.file = mosaic.at("file"), .altitude_m = mosaic.at("altitude_m")});
        }
    }
    if (json.contains("exponential")) {
        const Json& fit = json["exponential"];
        exports.exponential = {
            .file = fit.at("file"), .rms = fit.at("rms"), .worst = fit.at("worst")};
    }
    if (json.contains("oplab")) {
        const Json& fit = json["oplab"];
        exports.oplab = {.folder = fit.at("folder"),
                         .rms = fit.at("rms"),
                         .worst = fit.at("worst"),
                         .share_off = fit.at("share_off_by_10_percent")};
    }
    return exports;
}

OrderedJson json_of(const AtlasManifest& manifest) {
    OrderedJson bins = OrderedJson::array();
    const std::vector<MapPoint> points = points_of(manifest.axes);
    for (std::size_t i = 0; i < points.size(); ++i) {
        bins.push_back({{"file", "bins/" + bin_name(points[i])},
                        {"altitude_m", points[i].sled.altitude_m},
                        {"pitch_deg", as_written(points[i].sled.pitch_rad / kRadiansPerDegree)},
                        {"roll_deg", as_written(points[i].sled.roll_rad / kRadiansPerDegree)},
                        {"water_multiple", points[i].water_multiple},
                        {"sha256", manifest.checksums[i]}});
    }
    return {{"format", kFormat},
            {"version", manifest.version},
            {"title", manifest.title},
            {"rig_sha256", manifest.rig_digest},
            {"width_px", manifest.width_px},
            {"height_px", manifest.height_px},
            {"error", manifest.error},
            {"axes",
             {{"altitude_m", manifest.axes.altitude_m},
              {"pitch_deg", in_degrees(manifest.axes.pitch_rad)},
              {"roll_deg", in_degrees(manifest.axes.roll_rad)},
              {"water_multiple", manifest.axes.water_multiple}}},
            {"interpolation", interpolation_json(manifest.interpolation)},
            {"exports", json_of(manifest.exports)},
            {"bins", bins}};
}

void write_manifest(const fs::path& folder, const AtlasManifest& manifest) {
    write_text_file(manifest_path(folder), json_text(json_of(manifest)));
}

void require_axis(const std::vector<double>& values) {
    const bool is_increasing =
        std::ranges::adjacent_find(values, std::greater_equal<>{}) == values.end();
    if (values.empty() || !is_increasing) throw InputError("an axis is empty or does not increase");
}

AtlasManifest manifest_of(const Json& json) {
    if (json.at("format") != kFormat) throw InputError("its format is not {}", kFormat);
    const Json& axes = json.at("axes");
    using Values = std::vector<double>;
    AtlasManifest manifest{
        .version = json.at("version"),
        .title = json.at("title"),
        .rig_digest = json.at("rig_sha256"),
        .width_px = static_cast<int>(whole_number_at(json, "width_px", 1, kLargestImagePx)),
        .height_px = static_cast<int>(whole_number_at(json, "height_px", 1, kLargestImagePx)),
        .error = json.at("error"),
        .axes = {.altitude_m = axes.at("altitude_m").get<Values>(),
                 .pitch_rad = scaled(axes.at("pitch_deg").get<Values>(), kRadiansPerDegree),
                 .roll_rad = scaled(axes.at("roll_deg").get<Values>(), kRadiansPerDegree),
                 .water_multiple = axes.at("water_multiple").get<Values>()},
        .interpolation = interpolation_of(json.at("interpolation")),
        .checksums = {},
        .exports = exports_of(json.at("exports"))};
    for (const auto* axis : {&manifest.axes.altitude_m,
                             &manifest.axes.pitch_rad,
                             &manifest.axes.roll_rad,
                             &manifest.axes.water_multiple}) {
        require_axis(*axis);
    }
    for (const Json& bin : json.at("bins")) manifest.checksums.push_back(bin.at("sha256"));
    if (manifest.axes.altitude_m.front() <= 0.0) throw InputError("an altitude is not over 0");
    if (manifest.checksums.size() != bin_count(manifest.axes)) {
        throw InputError("its bins are not those of its axes");
    }
    return manifest;
}

AtlasManifest read_manifest(const fs::path& folder) {
    const fs::path file = manifest_path(folder);
    return parse_atlas(read_text_file(file), file.string());
}

// All that a bin depends on.
ExrAttributes attributes_of(const AtlasManifest& manifest, const MapPoint& point) {
    const auto degrees = [](double rad) {
        return fmt::format("{}", as_written(rad / kRadiansPerDegree));
    };
    return {{"aphotic:version", manifest.version},
            {"aphotic:rig_title", manifest.title},
            {"aphotic:rig_sha256", manifest.rig_digest},
            {"aphotic:renderer", "lightmap"},
            {"aphotic:error", fmt::format("{}", manifest.error)},
            {"aphotic:altitude_m", fmt::format("{}", point.sled.altitude_m)},
            {"aphotic:pitch_deg", degrees(point.sled.pitch_rad)},
            {"aphotic:roll_deg", degrees(point.sled.roll_rad)},
            {"aphotic:water_multiple", fmt::format("{}", point.water_multiple)}};
}

void write_bin(const fs::path& file, const ExrAttributes& attributes, const Lightmap& map) {
    ExrWriter writer(
        file, map.width_px, map.height_px, plane_names("", !map.veil.empty()), attributes);
    writer.write_rows(map.height_px, all_planes(map));
    writer.finish();
}

Lightmap read_bin(const fs::path& file, const AtlasManifest& manifest) {
    ExrReader reader(file);
    if (reader.width_px() != manifest.width_px || reader.height_px() != manifest.height_px) {
        throw RunError("{}: is {} x {} pixels; the atlas is of {} x {}",
                       file.string(),
                       reader.width_px(),
                       reader.height_px(),
                       manifest.width_px,
                       manifest.height_px);
    }
    Lightmap map{.width_px = manifest.width_px, .height_px = manifest.height_px, .samples = {}};
    map.samples = reader.planes(plane_names("", false));
    const std::vector<std::string> veil = {"veil.R", "veil.G", "veil.B"};
    const std::vector<std::string> there = reader.channels();
    if (std::ranges::find(there, veil.front()) != there.end()) map.veil = reader.planes(veil);
    return map;
}

// Whole, and of all the same.
bool is_bin_of(const fs::path& file, const AtlasManifest& manifest, const MapPoint& point) {
    try {
        const ExrReader reader(file);
        for (const auto& [name, value] : attributes_of(manifest, point)) {
            if (reader.attribute(name) != value) return false;
        }
        static_cast<void>(read_bin(file, manifest));
    } catch (const RunError&) {
        return false;
    }
    return true;
}

// The bins of the folder that may stay: file names and checksums.
std::map<std::string, std::string> bins_there(const fs::path& folder, const AtlasManifest& wanted) {
    std::map<std::string, std::string> there;
    if (!is_atlas(folder)) return there;
    const AtlasManifest old = read_manifest(folder);
    if (old.version != wanted.version || old.rig_digest != wanted.rig_digest ||
        old.error != wanted.error) {
        return there;
    }
    const std::vector<MapPoint> points = points_of(old.axes);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const fs::path file = bin_path(folder, points[i]);
        if (!fs::exists(file)) continue;
        // The manifest is written now and then: what was interrupted may have bins beyond it.
        if (old.checksums[i].empty() && !is_bin_of(file, wanted, points[i])) continue;
        const std::string checksum = sha256_of_file(file);
        if (!old.checksums[i].empty() && checksum != old.checksums[i]) continue;
        there[bin_name(points[i])] = checksum;
    }
    return there;
}

// Bins of other axes or rigs, which could only be mistaken.
void remove_others(const fs::path& folder, const std::vector<MapPoint>& points) {
    std::vector<std::string> names;
    for (const MapPoint& point : points) names.push_back(bin_name(point));
    std::ranges::sort(names);
    std::vector<fs::path> others;
    for (const auto& entry : fs::directory_iterator(folder / "bins")) {
        const std::string name = entry.path().filename().string();
        const bool is_bin = name.starts_with("a") && name.ends_with(".exr");
        if (is_bin && !std::ranges::binary_search(names, name)) others.push_back(entry.path());
    }
    for (const fs::path& file : others) fs::remove(file);
}

// Bins that shares of the same atlas have made; what is left in their folders nobody needs.
void take_shares(const fs::path& folder,
                 const std::vector<MapPoint>& points,
                 AtlasManifest& manifest) {
    for (const fs::path& share : share_folders(folder)) {
        const FolderLock lock(share, FolderUse::Write);
        std::vector<fs::path> left{"atlas.json"};
        for (std::size_t i = 0; i < points.size(); ++i) {
            const fs::path made = bin_path(share, points[i]);
            left.push_back(fs::relative(made, share));
            if (!manifest.checksums[i].empty() || !fs::exists(made)) continue;
            if (!is_bin_of(made, manifest, points[i])) continue;
            fs::rename(made, bin_path(folder, points[i]));
            manifest.checksums[i] = sha256_of_file(bin_path(folder, points[i]));
        }
        remove_joined(share, left);
    }
}

}  // namespace

nlohmann::ordered_json interpolation_json(const InterpolationError& error) {
    return {{"worst", error.worst},
            {"rms", error.rms},
            {"crossed_by_edges", error.crossed_share},
            {"whole_maps",
             {{"cells", error.whole_cells},
              {"rms", error.whole_rms},
              {"limit", error.whole_limit},
              {"share_over_limit", error.whole_over}}}};
}

std::string bin_name(const MapPoint& point) {
    return fmt::format("a{}_p{}_r{}_w{}.exr",
                       as_written(point.sled.altitude_m),
                       as_written(point.sled.pitch_rad / kRadiansPerDegree),
                       as_written(point.sled.roll_rad / kRadiansPerDegree),
                       as_written(point.water_multiple));
}

AtlasManifest parse_atlas(std::string_view text, const std::string& name) {
    const Json json = parse_json(text, name);
    try {
        return manifest_of(json);
    } catch (const Json::exception& error) {
        throw InputError("{}: is no atlas: {}", name, printable(error.what()));
    } catch (const InputError& error) {
        throw InputError("{}: {}", name, error.what());
    }
}

std::size_t bins_missing(const fs::path& folder, const MapAxes& axes) {
    const std::vector<MapPoint> points = points_of(axes);
    return static_cast<std::size_t>(std::ranges::count_if(
        points, [&](const MapPoint& point) { return !fs::exists(bin_path(folder, point)); }));
}

void require_over_floor(const Rig& rig, const MapAxes& axes) {
    // A strobe is the lower the lower the sled is.
    MapAxes lowest = axes;
    lowest.altitude_m.resize(1);
    lowest.water_multiple.resize(1);
    for (const MapPoint& point : points_of(lowest)) require_over_floor(rig, point.sled);
}

std::size_t write_atlas(const fs::path& folder, const Rig& rig, const AtlasRequest& request) {
    const std::vector<MapPoint> points = points_of(request.axes);
    require_over_floor(rig, request.axes);
    AtlasManifest manifest{.version = request.version,
                           .title = rig.title,
                           .rig_digest = rig.digest,
                           .width_px = rig.camera.width_px,
                           .height_px = rig.camera.height_px,
                           .error = request.map.error,
                           .axes = request.axes,
                           .interpolation = request.interpolation,
                           .checksums = std::vector<std::string>(points.size()),
                           .exports = {}};
    const std::map<std::string, std::string> there = bins_there(folder, manifest);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto known = there.find(bin_name(points[i]));
        if (known != there.end()) manifest.checksums[i] = known->second;
    }
    MapSource source(rig, request.axes, request.map);
    make_folder(folder / "bins");
    if (request.share.is_whole()) take_shares(folder, points, manifest);
    write_manifest(folder, manifest);
    remove_others(folder, points);
    remove_exports(folder);
    remove_oplab_export(folder);

    // What is not noted is found again by its header, which takes longer.
    constexpr std::chrono::seconds kNoteEvery{2};
    auto noted = std::chrono::steady_clock::now();
    std::size_t computed = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (request.progress) {
            request.progress(static_cast<double>(i) / static_cast<double>(points.size()));
        }
        if (!manifest.checksums[i].empty() || !request.share.has(i)) continue;
        const fs::path file = bin_path(folder, points[i]);
        write_bin(file, attributes_of(manifest, points[i]), source.map(points[i]));
        manifest.checksums[i] = sha256_of_file(file);
        ++computed;
        if (std::chrono::steady_clock::now() - noted < kNoteEvery) continue;
        write_manifest(folder, manifest);
        noted = std::chrono::steady_clock::now();
    }
    write_manifest(folder, manifest);
    return computed;
}

void note_exports(const fs::path& folder, const AtlasExports& exports) {
    AtlasManifest manifest = read_manifest(folder);
    manifest.exports = exports;
    write_manifest(folder, manifest);
}

bool is_atlas(const fs::path& folder) {
    return fs::exists(manifest_path(folder));
}

Atlas::Atlas(const fs::path& folder)
    : folder_(folder), manifest_(read_manifest(folder)), points_(points_of(manifest_.axes)) {
    const auto missing = std::ranges::count(manifest_.checksums, std::string());
    if (missing > 0) {
        throw InputError(
            "{}: {} of {} bins are not there yet; the command that began "
            "it goes on where it stopped",
            folder.string(),
            missing,
            points_.size());
    }
}

Lightmap Atlas::map(const MapPoint& point) {
    const std::vector<Neighbour> neighbours = neighbours_of(manifest_.axes, point);
    std::vector<const Lightmap*> maps;
    std::map<std::size_t, Lightmap> kept;
    for (const Neighbour& neighbour : neighbours) {
        load(neighbour.bin);
        kept.insert(read_.extract(neighbour.bin));
        maps.push_back(&kept.at(neighbour.bin));
    }
    Lightmap map = blended(maps, neighbours);
    read_ = std::move(kept);
    return map;
}

void Atlas::load(std::size_t index) {
    if (read_.contains(index)) return;
    read_[index] = read_bin(bin_path(folder_, points_[index]), manifest_);
}

}  // namespace aphotic
