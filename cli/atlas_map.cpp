// SPDX-License-Identifier: BSD-3-Clause
#include "cli/atlas_map.h"

#include "base/degrees.h"
#include "base/error.h"
#include "base/words.h"
#include "cli/outcome.h"
#include "image/exr.h"
#include "lightmap/atlas.h"
#include "lightmap/planes.h"

#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

namespace aphotic::cli {
namespace {

double value_on(const char* option,
                const std::optional<double>& given,
                const std::vector<double>& values,
                double unit) {
    if (given) return *given * unit;
    if (values.size() == 1) return values.front();
    throw InputError("{}: found none; allowed: from {:.6g} to {:.6g}, which the atlas covers",
                     option,
                     values.front() / unit,
                     values.back() / unit);
}

MapPoint point_of(const AtlasMapRequest& request, const MapAxes& axes) {
    return {.sled = {.altitude_m = value_on("--altitude", request.altitude_m, axes.altitude_m, 1.0),
                     .pitch_rad =
                         value_on("--pitch", request.pitch_deg, axes.pitch_rad, kRadiansPerDegree),
                     .roll_rad =
                         value_on("--roll", request.roll_deg, axes.roll_rad, kRadiansPerDegree)},
            .water_multiple =
                value_on("--water-multiple", request.water_multiple, axes.water_multiple, 1.0)};
}

MapPoint point_of(const AtlasMapRequest& request, const Atlas& atlas) {
    try {
        return point_of(request, atlas.manifest().axes);
    } catch (const InputError& error) {
        throw InputError("{}: {}", request.folder, error.what());
    }
}

Lightmap map_of(const AtlasMapRequest& request, Atlas& atlas, const MapPoint& point) {
    try {
        return atlas.map(point);
    } catch (const InputError& error) {
        throw InputError("{}: {}", request.folder, error.what());
    }
}

void write(const AtlasMapRequest& request,
           const AtlasManifest& manifest,
           const MapPoint& point,
           const Lightmap& map) {
    const auto text = [](double value) { return fmt::format("{:.9g}", value); };
    ExrWriter writer(request.file,
                     map.width_px,
                     map.height_px,
                     {kChannelNames.begin(), kChannelNames.end()},
                     {{"aphotic:version", APHOTIC_VERSION},
                      {"aphotic:rig_title", manifest.title},
                      {"aphotic:rig_sha256", manifest.rig_digest},
                      {"aphotic:renderer", "atlas"},
                      {"aphotic:altitude_m", text(point.sled.altitude_m)},
                      {"aphotic:pitch_deg", text(point.sled.pitch_rad / kRadiansPerDegree)},
                      {"aphotic:roll_deg", text(point.sled.roll_rad / kRadiansPerDegree)},
                      {"aphotic:water_multiple", text(point.water_multiple)},
                      {"aphotic:normalised", request.normalised ? "yes" : "no"},
                      {"aphotic:interpolation_error", text(manifest.interpolation.worst)}});
    writer.write_rows(map.height_px, map.samples);
    writer.finish();
}

void write_picture(const AtlasMapRequest& request, const Lightmap& map) {
    if (request.preview_file.empty()) return;
    write_preview({map.width_px, map.height_px, map.samples},
                  {1.0, 1.0, 1.0},
                  request.preview,
                  request.preview_file);
}

struct BlendedMap {
    const AtlasMapRequest& request;
    const AtlasManifest& manifest;
    MapPoint point;
    int width_px = 0;
    int height_px = 0;
    std::array<float, kChannels> peaks{};
    std::size_t bins = 0;  // that it is blended from
};

nlohmann::ordered_json to_json(const BlendedMap& map) {
    return {{"title", map.manifest.title},
            {"rig_sha256", map.manifest.rig_digest},
            {"file", map.request.file},
            {"width_px", map.width_px},
            {"height_px", map.height_px},
            {"altitude_m", map.point.sled.altitude_m},
            {"pitch_deg", map.point.sled.pitch_rad / kRadiansPerDegree},
            {"roll_deg", map.point.sled.roll_rad / kRadiansPerDegree},
            {"water_multiple", map.point.water_multiple},
            {"peak", map.peaks},
            {"normalised", map.request.normalised},
            {"bins", map.bins},
            {"interpolation",
             {{"worst", map.manifest.interpolation.worst},
              {"whole_rms", map.manifest.interpolation.whole_rms}}}};
}

void print(const BlendedMap& map) {
    fmt::print("{}: {} x {} pixels, {}\n",
               map.manifest.title,
               map.width_px,
               map.height_px,
               map.bins == 1 ? "a bin of the atlas"
                             : fmt::format("blended from {}", counted(map.bins, "bin")));
    if (map.bins > 1) {
        fmt::print(
            "  measured over the atlas, blending is off by up to {:.2g} for light without the "
            "cones' edges,\n  {:.2g} rms for whole maps\n",
            map.manifest.interpolation.worst,
            map.manifest.interpolation.whole_rms);
    }
    print_peaks(map.peaks, map.request.normalised);
    fmt::print("  {}\n", map.request.file);
}

}  // namespace

void print_peaks(const std::array<float, kChannels>& peaks, bool is_normalised) {
    fmt::print("  peaks {:.6g} (R), {:.6g} (G), {:.6g} (B){}\n",
               peaks[0],
               peaks[1],
               peaks[2],
               is_normalised ? ", each channel divided by its own" : "");
}

ExitStatus write_atlas_map(const AtlasMapRequest& request) {
    Atlas atlas(request.folder);
    const AtlasManifest& manifest = atlas.manifest();
    const MapPoint point = point_of(request, atlas);
    Lightmap map = map_of(request, atlas, point);
    const std::array<float, kChannels> peaks = peaks_of(map);
    if (request.normalised) divide_by(peaks, map);
    write(request, manifest, point, map);
    write_picture(request, map);
    show(BlendedMap{.request = request,
                    .manifest = manifest,
                    .point = point,
                    .width_px = map.width_px,
                    .height_px = map.height_px,
                    .peaks = peaks,
                    .bins = neighbours_of(manifest.axes, point).size()},
         request.json);
    return kDone;
}

}  // namespace aphotic::cli
