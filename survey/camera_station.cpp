// SPDX-License-Identifier: BSD-3-Clause
#include "survey/camera_station.h"

#include "base/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace aphotic {

using Eigen::Vector3d;

namespace {

std::string words_of(const Eigen::AlignedBox3d& box_m, bool has_depth) {
    constexpr std::array<std::string_view, 3> kNames{"north", "east", "depth"};
    std::vector<std::string> words;
    for (const Eigen::Index k : {1, 0, 2}) {
        if (k == 2 && !has_depth) continue;
        words.push_back(fmt::format("{} {:.1f} to {:.1f} m",
                                    kNames.at(static_cast<std::size_t>(k)),
                                    box_m.min()(k),
                                    box_m.max()(k)));
    }
    return fmt::format("{}", fmt::join(words, ", "));
}

void require_place(const Navigation& navigation, const Place& place, bool is_by_depth) {
    std::vector<std::string_view> lacking;
    for (const auto& [name, value] : {std::pair{"east_m", place.east_m},
                                      {"north_m", place.north_m},
                                      {"heading_deg", place.heading_rad},
                                      {"depth_m", is_by_depth ? place.depth_m : 0.0}})
        if (!std::isfinite(value)) lacking.emplace_back(name);
    if (lacking.empty()) return;
    throw InputError(
        "{}: found no {} for it; needed by --relief, in columns of these names or by --columns "
        "{}=NAME: metres of the mesh's frame, not degrees",
        navigation.source(),
        fmt::join(lacking, ", "),
        lacking.front());
}

// From the camera to the floor whose altitude the navigation gives.
Vector3d way_to_floor(const Survey& survey, const Sled& sled, const Vector3d& axis) {
    const auto& notes = survey.navigation->notes();
    const bool is_along_axis = !notes || notes->mounting.altitude_is == AltitudeIs::Axis;
    const Vector3d way = sled.altitude_m * axis;
    return is_along_axis ? way : Vector3d(0.0, 0.0, way.z());
}

}  // namespace

CameraStation station_of(const Survey& survey, const ImageFile& file) {
    const FloorMesh& mesh = *survey.depth->mesh;
    const auto& pose = survey.navigation->pose_of(file.source);
    const Place& place = pose.place;
    require_place(*survey.navigation, place, mesh.is_by_depth);
    CameraStation camera{
        .pupil_m = {place.north_m, place.east_m, place.depth_m},
        .turn = turn_by({pose.sled.roll_rad, pose.sled.pitch_rad, place.heading_rad})};
    if (mesh.is_by_depth) return camera;
    const Vector3d way_m = way_to_floor(survey, pose.sled, camera.turn.col(2));
    const auto floor_m = mesh.scene->floor_at(place.north_m + way_m.x(), place.east_m + way_m.y());
    if (!floor_m)
        throw InputError(
            "it is at east {:.1f} m, north {:.1f} m, where {} has no floor; allowed: {}",
            place.east_m,
            place.north_m,
            survey.depth->place.string(),
            words_of(mesh.scene->box_m(), false));
    camera.pupil_m.z() = *floor_m - way_m.z();
    return camera;
}

void require_in_view(const Survey& survey) {
    const FloorMesh& mesh = *survey.depth->mesh;
    const auto ray = [&](double column, double row) {
        return survey.light.relief->ray(column, row);
    };
    const auto [width_px, height_px] = survey.light.size;
    Eigen::AlignedBox3d flown;
    std::string why;
    for (const ImageFile& file : survey.files) {
        try {
            const Place& place = survey.navigation->pose_of(file.source).place;
            require_place(*survey.navigation, place, mesh.is_by_depth);
            flown.extend(
                Vector3d(place.north_m, place.east_m, mesh.is_by_depth ? place.depth_m : 0.0));
            if (mesh.scene->is_seen(station_of(survey, file), ray, width_px, height_px)) return;
        } catch (const InputError& error) {
            if (why.empty()) why = error.what();
        }
    }
    if (flown.isEmpty()) throw InputError("--relief: no image is over it: {}", why);
    throw InputError(
        "{}: no image sees it: found cameras at {}, and the mesh at {}; allowed: one frame for "
        "both, set by --relief-axes and --columns",
        survey.depth->place.string(),
        words_of(flown, mesh.is_by_depth),
        words_of(mesh.scene->box_m(), true));
}

}  // namespace aphotic
