// SPDX-License-Identifier: BSD-3-Clause
#include "rig/camera/lens.h"

#include "base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace aphotic {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

// The camera frame has X right, Y down, Z along the axis.
Vector3d seen_by_lens(const LensModel& lens, const Vector2d& point_px) {
    const std::optional<Vector3d> direction = direction_at(lens, point_px);
    if (!direction) {
        throw InputError(
            "the lens model is not valid at column {}, row {}", point_px.x(), point_px.y());
    }
    return {-direction->y(), direction->x(), direction->z()};
}

std::vector<Vector3d> rim_seen_by_lens(const Camera& camera) {
    std::vector<Vector3d> rim;
    for (const Vector2d& point_px : rim_px(camera.width_px, camera.height_px))
        rim.push_back(seen_by_lens(*camera.lens, point_px));
    return rim;
}

double widest_rad(const Camera& camera) {
    double least_z = 1.0;
    for (const Vector3d& direction : rim_seen_by_lens(camera))
        least_z = std::min(least_z, direction.z());
    return std::acos(least_z);
}

bool shows(const Camera& camera, const Vector3d& point_m, double factor) {
    const double off_axis_rad = std::atan2(point_m.head<2>().norm(), point_m.z());
    if (off_axis_rad > factor * half_view_rad(camera)) return false;
    const Vector2d image_px(camera.width_px, camera.height_px);
    const Vector2d off_middle =
        image_point(*camera.lens, {point_m.y(), -point_m.x(), point_m.z()}) - 0.5 * image_px;
    return (off_middle.array().abs() <= factor * 0.5 * image_px.array()).all();
}

}  // namespace

Vector3d direction_in_air(const Camera& camera, double column, double row) {
    if (camera.lens) return seen_by_lens(*camera.lens, {column, row});
    return Vector3d(pinhole_way(camera, column, row).data()).normalized();
}

double half_view_rad(const Camera& camera) {
    if (camera.lens) return widest_rad(camera);
    return std::atan(0.5 * std::hypot(camera.width_px, camera.height_px) * camera.pixel_pitch_m /
                     camera.focal_length_m);
}

bool is_in_view(const Camera& camera, const Vector3d& point_m, double factor) {
    if (point_m.z() <= 0.0) return false;
    if (camera.lens) return shows(camera, point_m, factor);
    const double reach = factor * 0.5 * camera.pixel_pitch_m / camera.focal_length_m;
    return std::abs(point_m.x()) <= reach * camera.height_px * point_m.z() &&
           std::abs(point_m.y()) <= reach * camera.width_px * point_m.z();
}

void enlarge_pixels(Camera& camera, double factor, int width_px, int height_px) {
    if (camera.lens) {
        const Vector2d off_middle_px =
            camera.lens->centre_px - 0.5 * Vector2d(camera.width_px, camera.height_px);
        camera.lens->focal_px /= factor;
        camera.lens->skew_px /= factor;
        camera.lens->centre_px = off_middle_px / factor + 0.5 * Vector2d(width_px, height_px);
    }
    camera.width_px = width_px;
    camera.height_px = height_px;
    camera.pixel_pitch_m *= factor;
}

void scale_to_width(Camera& camera, int width_px) {
    const double factor = static_cast<double>(camera.width_px) / width_px;
    const double height_px = std::max(1.0, std::round(camera.height_px / factor));
    enlarge_pixels(camera, factor, width_px, static_cast<int>(height_px));
}

Pinhole pinhole_about(const Camera& camera) {
    if (!camera.lens) {
        return {.focal_length_m = camera.focal_length_m,
                .sensor_width_m = camera.pixel_pitch_m * camera.width_px};
    }
    constexpr double kRoom = 1.001;  // the rim is searched in steps
    double half_width = 0.0;         // at unit distance
    const double shape = static_cast<double>(camera.width_px) / camera.height_px;
    for (const Vector3d& direction : rim_seen_by_lens(camera)) {
        const Vector2d slope = direction.head<2>().cwiseAbs() / direction.z();
        half_width = std::max({half_width, slope.y(), slope.x() * shape});
    }
    return {.focal_length_m = camera.focal_length_m,
            .sensor_width_m = 2.0 * kRoom * half_width * camera.focal_length_m};
}

std::map<std::string, std::string> lens_signature(const Camera& camera) {
    std::map<std::string, std::string> words{
        {"camera.resolution", fmt::format("{} {}", camera.width_px, camera.height_px)},
        {"camera.pixel_pitch_m", fmt::format("{}", camera.pixel_pitch_m)},
        {"camera.focal_length_m", fmt::format("{}", camera.focal_length_m)}};
    if (camera.lens) words["camera.lens"] = lens_model_signature(*camera.lens);
    return words;
}

}  // namespace aphotic
