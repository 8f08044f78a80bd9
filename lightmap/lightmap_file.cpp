// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/lightmap_file.h"

#include "base/degrees.h"
#include "base/number.h"
#include "base/stopwatch.h"
#include "image/exr.h"

#include <fmt/format.h>

#include <optional>

namespace aphotic {
namespace {

// The planes of the file, in order, and their names.
struct NamedPlanes {
    std::vector<std::string> names;
    std::vector<float> samples;

    void take(const std::string& layer, const Lightmap& map) {
        const std::vector<std::string> own = plane_names(layer, !map.veil.empty());
        names.insert(names.end(), own.begin(), own.end());
        for (const std::vector<float>* planes : {&map.samples, &map.veil})
            samples.insert(samples.end(), planes->begin(), planes->end());
    }
};

void write_planes(const Rig& rig, const LightmapRequest& request, const NamedPlanes& planes) {
    ExrAttributes attributes{
        {"aphotic:version", request.version},
        {"aphotic:rig_title", rig.title},
        {"aphotic:rig_sha256", rig.digest},
        {"aphotic:renderer", "lightmap"},
        {"aphotic:altitude_m", fmt::format("{}", rig.sled.altitude_m)},
        {"aphotic:pitch_deg", fmt::format("{}", rig.sled.pitch_rad / kRadiansPerDegree)},
        {"aphotic:roll_deg", fmt::format("{}", rig.sled.roll_rad / kRadiansPerDegree)},
        {"aphotic:normalised", request.is_normalised ? "yes" : "no"},
        {"aphotic:error", fmt::format("{}", request.map.error)}};
    if (request.model) attributes.emplace_back(kModelErrorAttribute, attribute_of(*request.model));
    write_exr(request.file,
              rig.camera.width_px,
              rig.camera.height_px,
              planes.names,
              planes.samples,
              attributes);
}

}  // namespace

std::vector<std::string> map_names(const std::vector<double>& altitude_m) {
    constexpr int kLeast = 2;
    constexpr int kMost = 9;
    int digits = kLeast;
    for (const double h_m : altitude_m) {
        while (digits < kMost && read_number<double>(fmt::format("{:.{}f}", h_m, digits)) != h_m)
            ++digits;
    }
    std::vector<std::string> names;
    for (const double h_m : altitude_m)
        names.push_back(fmt::format("altitude_{:.{}f}m.exr", h_m, digits));
    return names;
}

void remove_maps(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> maps;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with("altitude_") && name.ends_with("m.exr")) maps.push_back(entry.path());
    }
    for (const std::filesystem::path& file : maps) std::filesystem::remove(file);
}

WrittenLightmap write_lightmap(const Rig& rig, const LightmapRequest& request) {
    const Stopwatch making;
    const LightmapMaker maker(rig, std::nullopt, request.map);
    const double tables_s = making.seconds();
    const Stopwatch mapping;
    Lightmap map = maker.map(rig.sled);
    const double map_s = mapping.seconds();

    const std::array<float, kChannels> peaks = peaks_of(map);
    if (request.is_normalised) divide_by(peaks, map);
    NamedPlanes planes;
    planes.samples.reserve((1 + request.parts.size()) * map.samples.size());
    planes.take("", map);
    for (const RigPart& part : request.parts) {
        Lightmap share = LightmapMaker(part.rig, maker.paths(), request.map).map(rig.sled);
        if (request.is_normalised) divide_by(peaks, share);
        planes.take(part.name, share);
    }
    set_exr_threads(request.map.threads);
    write_planes(rig, request, planes);
    return {.map = std::move(map),
            .channels = std::move(planes.names),
            .peaks = peaks,
            .paths = maker.paths(),
            .grid_size = maker.grid_size(),
            .table_steps = maker.table_steps(),
            .tables_s = tables_s,
            .map_s = map_s};
}

}  // namespace aphotic
