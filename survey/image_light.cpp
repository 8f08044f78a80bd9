// SPDX-License-Identifier: BSD-3-Clause
#include "survey/image_light.h"

#include "base/error.h"

#include <fmt/format.h>

namespace aphotic {
namespace {

DepthMap depth_map_of(const Survey& survey, const ImageFile& file) {
    const DepthMaps& maps = *survey.depth;
    return resized(read_depth_map(depth_file(maps.place, file.source), maps.unit_m),
                   survey.light.size.width_px,
                   survey.light.size.height_px);
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

ImageLight light_of(const Survey& survey, const ImageFile& file, int within_px) {
    const std::optional<Sled> sled = sled_of(survey, file);
    if (!survey.depth) {
        return {.map = survey.light.map(*sled),
                .edges = survey.light.edges(*sled, within_px),
                .filled = {}};
    }
    const DepthMaps& maps = *survey.depth;
    FloorRelief relief =
        floor_relief(depth_map_of(survey, file), maps.is, maps.normals, *survey.light.relief, sled);
    ReliefMap made = survey.light.relief->map(relief.relief, within_px);
    return {.map = std::move(made.map),
            .edges = std::move(made.edges),
            .filled = std::move(relief.filled)};
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

std::optional<DepthLook> look_at_depth(const Survey& survey, const ImageFile& file) {
    if (!survey.depth) return std::nullopt;
    return look_at_depth(
        depth_map_of(survey, file), survey.depth->is, *survey.light.relief, sled_of(survey, file));
}

}  // namespace aphotic
