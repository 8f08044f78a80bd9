// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/light_culling.h"

#include "rig/geometry.h"
#include "rig/solid.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace aphotic {

using Eigen::Vector3d;

namespace {

constexpr std::size_t kGridOfView = 33;
// The largest shift of a floor point, from the grid's, at other wavelengths, as a share of the path
// in water.
constexpr double kPortShift = 0.02;
// A cell that spans more than this angle, seen from a lamp close above it, may be widest away from
// its corners.
constexpr double kWideRad = 1.0;

// The angle by which the direction to a floor point may differ for other wavelengths' rays and
// other lamps of an emitter.
double margin_rad(const Rig& rig, const Strobe& strobe, double distance_m, double camera_leg_m) {
    const double reach_m =
        (rig.camera.port ? kPortShift * camera_leg_m : 0.0) + emitter_reach_m(strobe);
    return reach_m > 0.0 ? std::atan2(reach_m, std::max(0.0, distance_m - reach_m)) : 0.0;
}

}  // namespace

bool lights_the_view(const Rig& rig, const Strobe& strobe, const Beam& beam) {
    if (is_dark(beam)) return false;
    const bool lights_an_object = std::ranges::any_of(rig.objects, [&](const Object& object) {
        return may_light(strobe, beam, object) && may_be_in_view(rig, object);
    });
    if (lights_an_object) return true;
    const BeamFrame frame = frame_about(strobe.axis);
    const std::vector<std::optional<FloorSample>> samples = floor_samples(rig, kGridOfView);
    for (std::size_t row = 0; row + 1 < kGridOfView; ++row) {
        for (std::size_t column = 0; column + 1 < kGridOfView; ++column) {
            const std::size_t corner = row * kGridOfView + column;
            const std::array cell{&samples[corner],
                                  &samples[corner + 1],
                                  &samples[corner + kGridOfView],
                                  &samples[corner + kGridOfView + 1]};
            const auto seen = std::ranges::count_if(cell, [](auto* s) { return s->has_value(); });
            if (seen == 0) continue;
            if (seen < 4) return true;  // the horizon crosses the cell, which extends far
            Vector3d middle_m = Vector3d::Zero();
            for (const auto* sample : cell) middle_m += 0.25 * (*sample)->point_m;
            const Vector3d towards = middle_m - strobe.position_m;
            double reach_rad = 0.0;
            double nearest_m = towards.norm();
            double camera_leg_m = 0.0;
            for (const auto* sample : cell) {
                const Vector3d to_corner = (*sample)->point_m - strobe.position_m;
                reach_rad = std::max(reach_rad, angle_between(towards, to_corner));
                nearest_m = std::min(nearest_m, to_corner.norm());
                camera_leg_m = std::max(camera_leg_m, (*sample)->camera_leg_m);
            }
            reach_rad += margin_rad(rig, strobe, nearest_m, camera_leg_m);
            if (reach_rad > kWideRad || reaches(beam, frame, towards, reach_rad)) {
                return true;
            }
        }
    }
    return false;
}

std::vector<Omission> omissions(const Rig& rig, bool is_user_scene) {
    std::vector<Omission> left_out;
    if (rig.water.is_clear()) {
        left_out.push_back({"the water's medium", "clear water attenuates nothing"});
    }
    if (!rig.camera.port) {
        left_out.push_back({"a port", "none is given: the pupil is in the water"});
    }
    if (!is_user_scene && rig.seafloor.phong == 0.0) {
        left_out.push_back({"the floor's highlight", "its strength is 0"});
    }
    for (const Object& object : rig.objects) {
        if (object.phong > 0.0) continue;
        left_out.push_back(
            {fmt::format("the highlight of object '{}'", object.name), "its strength is 0"});
    }
    for (const Strobe& strobe : rig.strobes) {
        if (strobe.power == 0.0) {
            left_out.push_back({fmt::format("strobe '{}'", strobe.name), "its power is 0"});
            continue;
        }
        for (const Beam& part : parts_of(strobe.beam)) {
            const std::string what =
                part.cones.empty()
                    ? fmt::format("the beam of strobe '{}'", strobe.name)
                    : fmt::format("the {} cone of strobe '{}'", part.name, strobe.name);
            if (is_dark(part)) {
                left_out.push_back({what, "its weight is 0"});
            } else if (!is_user_scene && !lights_the_view(rig, strobe, part)) {
                left_out.push_back({what, "it lights nothing in view"});
            }
        }
    }
    return left_out;
}

}  // namespace aphotic
