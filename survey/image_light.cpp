// SPDX-License-Identifier: BSD-3-Clause
#include "survey/image_light.h"

#include "base/error.h"
#include "base/upper_median.h"
#include "survey/camera_station.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace aphotic {
namespace {

double median_of(const DepthMap& map) {
    std::vector<double> depths;
    for (const float depth_m : map.depth_m)
        if (std::isfinite(depth_m)) depths.push_back(depth_m);
    return upper_median(depths);
}

// In the wrong unit, the whole floor would be too near or too far to be lit.
void require_unit(const Survey& survey, const ImageFile& file, const DepthMap& map) {
    constexpr double kOtherUnit = 50.0;
    const std::optional<Sled> sled = sled_of(survey, file);
    const std::optional<double> altitude_m =
        sled ? std::optional(sled->altitude_m) : survey.light.rig_altitude_m;
    const double depth_m = median_of(map);
    const double ratio = altitude_m ? depth_m / *altitude_m : 1.0;
    if (!(ratio > kOtherUnit || ratio < 1.0 / kOtherUnit)) return;
    throw InputError(
        "found a median depth of {:.4g} m in its depth map, and an altitude of {:.4g} m; "
        "allowed: {}",
        depth_m,
        *altitude_m,
        survey.depth->mesh ? "a mesh with the navigation's sea level, or --relief-place altitude"
                           : "depths in metres, or in millimetres with --depth-unit mm");
}

DepthMap seen_of_mesh(const Survey& survey, const ImageFile& file, PlaneSize size) {
    const double columns = static_cast<double>(survey.light.size.width_px) / size.width_px;
    const double rows = static_cast<double>(survey.light.size.height_px) / size.height_px;
    const auto ray = [&](double column, double row) {
        return survey.light.relief->ray(column * columns, row * rows);
    };
    DepthMap map = survey.depth->mesh->scene->depth_map(
        station_of(survey, file), ray, size.width_px, size.height_px);
    if (std::ranges::none_of(map.depth_m, [](float depth_m) { return std::isfinite(depth_m); }))
        throw InputError("it does not see {}", survey.depth->place.string());
    return map;
}

enum class Detail { Full, Rough };

// Rough: a mesh is sampled by fewer rays.
DepthMap lit_depth_map(const Survey& survey, const ImageFile& file, Detail detail = Detail::Full) {
    constexpr int kRough_px = 256;
    PlaneSize size = survey.light.size;
    if (survey.depth->mesh && detail == Detail::Rough) {
        const int times = std::max(1, std::max(size.width_px, size.height_px) / kRough_px);
        size = {.width_px = (size.width_px + times - 1) / times,
                .height_px = (size.height_px + times - 1) / times};
    }
    DepthMap map = depth_map_of(survey, file, size);
    require_unit(survey, file, map);
    return map;
}

}  // namespace

DepthMap depth_map_of(const Survey& survey, const ImageFile& file, PlaneSize size) {
    const DepthMaps& maps = *survey.depth;
    if (maps.mesh) return seen_of_mesh(survey, file, size);
    return resized(read_depth_map(depth_file(maps.place, file.source), maps.unit_m),
                   size.width_px,
                   size.height_px);
}

std::optional<Sled> sled_of(const Survey& survey, const ImageFile& file) {
    if (!survey.navigation) return survey.depth ? std::nullopt : std::optional(Sled{});
    try {
        return survey.navigation->pose_of(file.source).sled;
    } catch (const InputError&) {
        if (!survey.depth) throw;
        return std::nullopt;
    }
}

ImageLight light_of(const Survey& survey, const ImageFile& file, int within_px, std::uint64_t out) {
    const std::optional<Sled> sled = sled_of(survey, file);
    if (!survey.depth) {
        return {.map = out == 0 ? survey.light.map(*sled) : survey.strobes.map_without(*sled, out),
                .edges = survey.light.edges(*sled, within_px),
                .filled = {}};
    }
    const auto maker = out == 0 ? survey.light.relief : survey.strobes.relief_without(out);
    FloorRelief relief = relief_of(survey, file);
    ReliefMap made = maker->map(relief.relief, within_px);
    return {.map = std::move(made.map),
            .edges = std::move(made.edges),
            .filled = std::move(relief.filled)};
}

FloorRelief relief_of(const Survey& survey, const ImageFile& file) {
    const DepthMaps& maps = *survey.depth;
    return floor_relief(lit_depth_map(survey, file),
                        maps.is,
                        maps.normals,
                        *survey.light.relief,
                        sled_of(survey, file));
}

std::vector<CellPlane> strobe_cells_of(const Survey& survey, const ImageFile& file) {
    const std::optional<Sled> sled = sled_of(survey, file);
    if (!survey.depth) return survey.strobes.cells(*sled);
    return survey.strobes.relief_cells(
        lit_depth_map(survey, file, Detail::Rough), *survey.depth, sled);
}

std::string light_inputs(const Survey& survey, const ImageFile& file) {
    const std::optional<Sled> sled = sled_of(survey, file);
    std::string inputs =
        sled ? fmt::format("{} {} {}", sled->altitude_m, sled->pitch_rad, sled->roll_rad) : "none";
    if (!survey.depth) return inputs;
    const DepthMaps& maps = *survey.depth;
    const std::filesystem::path depth =
        maps.mesh ? maps.place : depth_file(maps.place, file.source);
    if (maps.mesh) {
        const Place& place = survey.navigation->pose_of(file.source).place;
        inputs += fmt::format(
            " {} {} {} {}", place.east_m, place.north_m, place.heading_rad, place.depth_m);
    }
    return fmt::format("{} {} {}",
                       inputs,
                       std::filesystem::file_size(depth),
                       std::filesystem::last_write_time(depth).time_since_epoch().count());
}

std::optional<OtherDepth> other_depth(const Survey& survey, const ImageFile& file) {
    if (!survey.depth) return std::nullopt;
    Survey other = survey;
    other.depth->is =
        survey.depth->is == DepthIs::AlongAxis ? DepthIs::AlongRay : DepthIs::AlongAxis;
    const std::optional<Sled> sled = sled_of(survey, file);
    return OtherDepth{.depth_m = median_of(lit_depth_map(survey, file, Detail::Rough)),
                      .by_other_convention = survey.depth->mesh
                                                 ? std::nullopt
                                                 : std::optional(light_of(other, file, 0).map),
                      .plane = sled ? std::optional(survey.light.map(*sled)) : std::nullopt};
}

}  // namespace aphotic
