// SPDX-License-Identifier: BSD-3-Clause
#include "cli/atlas_map.h"

#include "base/degrees.h"
#include "base/error.h"
#include "base/offered.h"
#include "base/words.h"
#include "cli/outcome.h"
#include "cli/terminal.h"
#include "image/exr.h"
#include "lightmap/atlas.h"
#include "lightmap/planes.h"

#include <fmt/format.h>

#include <array>
#include <vector>

namespace aphotic::cli {
namespace {

double value_on(const char* option,
                const std::optional<double>& given,
                const std::vector<double>& values,
                double unit) {
    if (given) return *given * unit;
    if (values.size() == 1) return values.front();
    constexpr double kRounding = 1e-12;  // a bound of 5 degrees is printed as 5
    throw InputError("{}: found none; allowed: from {} to {}, which the atlas covers",
                     option,
                     at_least(values.front() / unit - kRounding, 6),
                     at_most(values.back() / unit + kRounding, 6));
}

MapPoint point_of(const LightmapCommandOptions& options, const MapAxes& axes) {
    return {.sled = {.altitude_m = value_on("--altitude", options.altitude_m, axes.altitude_m, 1.0),
                     .pitch_rad =
                         value_on("--pitch", options.pitch_deg, axes.pitch_rad, kRadiansPerDegree),
                     .roll_rad =
                         value_on("--roll", options.roll_deg, axes.roll_rad, kRadiansPerDegree)},
            .water_multiple =
                value_on("--water-multiple", options.water_multiple, axes.water_multiple, 1.0)};
}

void write(const LightmapCommandOptions& options,
           const AtlasManifest& manifest,
           const MapPoint& point,
           const Lightmap& map) {
    const auto text = [](double value) { return fmt::format("{:.9g}", value); };
    ExrWriter writer(options.file,
                     map.width_px,
                     map.height_px,
                     plane_names("", !map.veil.empty()),
                     {{"aphotic:version", APHOTIC_VERSION},
                      {"aphotic:rig_title", manifest.title},
                      {"aphotic:rig_sha256", manifest.rig_digest},
                      {"aphotic:renderer", "atlas"},
                      {"aphotic:altitude_m", text(point.sled.altitude_m)},
                      {"aphotic:pitch_deg", text(point.sled.pitch_rad / kRadiansPerDegree)},
                      {"aphotic:roll_deg", text(point.sled.roll_rad / kRadiansPerDegree)},
                      {"aphotic:water_multiple", text(point.water_multiple)},
                      {"aphotic:normalised", options.normalised ? "yes" : "no"},
                      {"aphotic:interpolation_error", text(manifest.interpolation.worst)}});
    writer.write_rows(map.height_px, all_planes(map));
    writer.finish();
}

struct BlendedMap {
    const LightmapCommandOptions& options;
    const AtlasManifest& manifest;
    MapPoint point;
    Lightmap map;
    std::array<float, kChannels> peaks{};
    std::size_t bins = 0;  // that it is blended from
};

nlohmann::ordered_json to_json(const BlendedMap& blended) {
    return {{"title", blended.manifest.title},
            {"rig_sha256", blended.manifest.rig_digest},
            {"file", blended.options.file},
            {"width_px", blended.map.width_px},
            {"height_px", blended.map.height_px},
            {"altitude_m", blended.point.sled.altitude_m},
            {"pitch_deg", blended.point.sled.pitch_rad / kRadiansPerDegree},
            {"roll_deg", blended.point.sled.roll_rad / kRadiansPerDegree},
            {"water_multiple", blended.point.water_multiple},
            {"peak", blended.peaks},
            {"normalised", blended.options.normalised},
            {"bins", blended.bins},
            {"interpolation",
             {{"worst", blended.manifest.interpolation.worst},
              {"whole_rms", blended.manifest.interpolation.whole_rms}}}};
}

void print(const BlendedMap& blended) {
    say("{}: {} x {} pixels, {}\n",
        blended.manifest.title,
        blended.map.width_px,
        blended.map.height_px,
        blended.bins == 1 ? "a bin of the atlas"
                          : fmt::format("blended from {}", counted(blended.bins, "bin")));
    if (blended.bins > 1) {
        say("  measured over the atlas, blending is off by up to {:.2g} for light without the "
            "beams' edges,\n  {:.2g} rms for whole maps\n",
            blended.manifest.interpolation.worst,
            blended.manifest.interpolation.whole_rms);
    }
    print_peaks(blended.peaks, blended.options.normalised);
    say("  {}\n", blended.options.file);
}

}  // namespace

void print_peaks(const std::array<float, kChannels>& peaks, bool is_normalised) {
    say("  peaks {:.6g} (R), {:.6g} (G), {:.6g} (B){}\n",
        peaks[0],
        peaks[1],
        peaks[2],
        is_normalised ? ", each channel divided by its own" : "");
}

ExitStatus write_atlas_map(const LightmapCommandOptions& options) {
    Atlas atlas(options.source);
    const AtlasManifest& manifest = atlas.manifest();
    BlendedMap blended = naming(options.source, [&] {
        const MapPoint point = point_of(options, manifest.axes);
        return BlendedMap{.options = options,
                          .manifest = manifest,
                          .point = point,
                          .map = atlas.map(point),
                          .bins = neighbours_of(manifest.axes, point).size()};
    });
    blended.peaks = peaks_of(blended.map);
    if (options.normalised) divide_by(blended.peaks, blended.map);
    write(options, manifest, blended.point, blended.map);
    if (!options.preview_file.empty()) {
        PreviewOptions preview = options.preview;
        if (preview.white == PreviewWhite::Lamp) preview.white = PreviewWhite::Image;  // by default
        write_preview({blended.map.width_px, blended.map.height_px, signal_of(blended.map)},
                      {1.0, 1.0, 1.0},
                      preview,
                      options.preview_file);
    }
    show(blended, options.json);
    return kDone;
}

}  // namespace aphotic::cli
