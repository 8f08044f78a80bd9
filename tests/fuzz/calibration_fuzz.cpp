// SPDX-License-Identifier: BSD-3-Clause
//
// A camera calibration from any text, in each format. A lens that holds all over its image has a
// direction for each corner, of length 1, and it arrives where it was asked for.
#include "fuzz.h"
#include "rig/camera/calibration_file.h"

#include <cmath>
#include <optional>

namespace {

void demand(bool holds) {
    if (!holds) std::abort();
}

bool holds_all_over(const aphotic::CameraCalibration& camera) {
    try {
        require_to_hold(camera.lens, camera.width_px, camera.height_px);
    } catch (const aphotic::InputError&) {
        return false;
    }
    return true;
}

void demand_sound_port(const aphotic::CalibratedPort& port) {
    constexpr double kUnit = 1e-12;
    demand(std::abs(port.normal.norm() - 1.0) < kUnit);
    demand(port.thickness_m > 0.0);
    demand(port.dome ? port.dome->centre_m.norm() < port.dome->radius_m : port.distance_m > 0.0);
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text = aphotic::text_of(data, size);
    std::optional<aphotic::CameraCalibration> camera;
    aphotic::expect_result_or_placed_error(
        "cam.yaml", [&] { camera = aphotic::parse_calibration("cam.yaml", text); });
    if (!camera) return 0;
    demand(camera->width_px > 0 && camera->height_px > 0);
    if (camera->port) demand_sound_port(*camera->port);
    if (!holds_all_over(*camera)) return 0;
    for (const Eigen::Vector2d& corner_px :
         {Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(camera->width_px, camera->height_px)}) {
        constexpr double kUnit = 1e-12;
        const auto direction = direction_at(camera->lens, corner_px);
        demand(direction && std::abs(direction->norm() - 1.0) < kUnit);
        demand(image_point(camera->lens, *direction).allFinite());
    }
    return 0;
}
