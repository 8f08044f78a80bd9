// SPDX-License-Identifier: BSD-3-Clause
#include "survey/image_light.h"

#include "base/error.h"
#include "base/upper_median.h"

#include <fmt/format.h>

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

// Of another unit all would be too near or too far to be lit.
void require_unit(const Survey& survey, const ImageFile& file, const DepthMap& map) {
    constexpr double kOtherUnit = 50.0;
    const std::optional<Sled> sled = sled_of(survey, file);
    const std::optional<double> altitude_m =
        sled ? std::optional(sled->altitude_m) : survey.light.rig_altitude_m;
    const double depth_m = median_of(map);
    const double ratio = altitude_m ? depth_m / *altitude_m : 1.0;
    if (!(ratio > kOtherUnit || ratio < 1.0 / kOtherUnit)) return;
    throw InputError(
        "found a median depth of {:.4g} m in its depth map, and an altitude of {:.4g} m; allowed: "
        "depths in metres, or in millimetres with --depth-unit mm",
        depth_m,
        *altitude_m);
}

DepthMap depth_map_of(const Survey& survey, const ImageFile& file) {
    const DepthMaps& maps = *survey.depth;
    DepthMap map = resized(read_depth_map(depth_file(maps.place, file.source), maps.unit_m),
                           survey.light.size.width_px,
                           survey.light.size.height_px);
    require_unit(survey, file, map);
    return map;
}

}  // namespace

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
    const DepthMaps& maps = *survey.depth;
    const auto maker = out == 0 ? survey.light.relief : survey.strobes.relief_without(out);
    FloorRelief relief =
        floor_relief(depth_map_of(survey, file), maps.is, maps.normals, *maker, sled);
    ReliefMap made = maker->map(relief.relief, within_px);
    return {.map = std::move(made.map),
            .edges = std::move(made.edges),
            .filled = std::move(relief.filled)};
}

std::vector<CellPlane> strobe_cells_of(const Survey& survey, const ImageFile& file) {
    const std::optional<Sled> sled = sled_of(survey, file);
    if (!survey.depth) return survey.strobes.cells(*sled);
    return survey.strobes.relief_cells(depth_map_of(survey, file), *survey.depth, sled);
}

std::string light_inputs(const Survey& survey, const ImageFile& file) {
    const std::optional<Sled> sled = sled_of(survey, file);
    std::string inputs =
        sled ? fmt::format("{} {} {}", sled->altitude_m, sled->pitch_rad, sled->roll_rad) : "none";
    if (!survey.depth) return inputs;
    const std::filesystem::path depth = depth_file(survey.depth->place, file.source);
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
    return OtherDepth{.depth_m = median_of(depth_map_of(survey, file)),
                      .by_other_convention = light_of(other, file, 0).map,
                      .plane = sled ? std::optional(survey.light.map(*sled)) : std::nullopt};
}

}  // namespace aphotic
