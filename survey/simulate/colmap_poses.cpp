// SPDX-License-Identifier: BSD-3-Clause
#include "survey/simulate/colmap_poses.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "rig/geometry.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <string_view>
#include <utility>

namespace aphotic {

using Eigen::Vector3d;

namespace {

struct ColmapCamera {
    std::string_view model;
    std::vector<double> parameters;
};

LensModel lens_of(const Camera& camera) {
    if (camera.lens) return *camera.lens;
    LensModel pinhole;
    pinhole.focal_px.setConstant(camera.focal_length_m / camera.pixel_pitch_m);
    pinhole.centre_px = {0.5 * camera.width_px, 0.5 * camera.height_px};
    return pinhole;
}

// The model that has exactly these coefficients.
ColmapCamera colmap_camera(const LensModel& lens) {
    const auto& k = lens.radial;
    const auto& q = lens.radial_below;
    const auto& p = lens.tangential;
    const auto has = [](const auto& some) {
        return std::ranges::any_of(some, [](double one) { return one != 0.0; });
    };
    const auto with = [&](std::vector<double> coefficients) {
        coefficients.insert(
            coefficients.begin(),
            {lens.focal_px.x(), lens.focal_px.y(), lens.centre_px.x(), lens.centre_px.y()});
        return coefficients;
    };
    if (lens.skew_px != 0.0)
        throw InputError("found a skew of {} pixels; allowed for COLMAP: none", lens.skew_px);
    if (lens.is_fisheye) {
        if (has(q) || has(p))
            throw InputError(
                "found a fisheye with tangential or rational coefficients; allowed for COLMAP: "
                "radial ones");
        return {.model = "OPENCV_FISHEYE", .parameters = with({k[0], k[1], k[2], k[3]})};
    }
    if (k[3] != 0.0) throw InputError("found a lens with k4 {}; allowed for COLMAP: none", k[3]);
    if (has(q) || k[2] != 0.0)
        return {.model = "FULL_OPENCV",
                .parameters = with({k[0], k[1], p[0], p[1], k[2], q[0], q[1], q[2]})};
    if (has(k) || has(p)) return {.model = "OPENCV", .parameters = with({k[0], k[1], p[0], p[1]})};
    return {.model = "PINHOLE", .parameters = with({})};
}

// From the floor's starboard, forward and up to the camera's right, down and ahead.
Eigen::Quaterniond turn_of(const Sled& sled) {
    const Vector3d up = floor_plane(sled).normal;
    const Vector3d starboard = Vector3d::UnitX().cross(up).normalized();
    const Vector3d forward = up.cross(starboard);
    Eigen::Matrix3d to_camera;
    for (const auto& [column, axis] : {std::pair{0, starboard}, {1, forward}, {2, up}})
        to_camera.col(column) = Vector3d(axis.y(), -axis.x(), axis.z());
    return Eigen::Quaterniond(to_camera);
}

}  // namespace

void require_colmap(const Camera& camera, const std::vector<Leg>& legs) {
    static_cast<void>(colmap_camera(lens_of(camera)));
    const auto blank = std::ranges::find_if(
        legs, [](const Leg& leg) { return leg.name.find_first_of(" \t") != std::string::npos; });
    if (blank != legs.end())
        throw InputError("found an image named '{}'; allowed for COLMAP: names without blanks",
                         blank->name);
}

std::string colmap_cameras(const Camera& camera) {
    const auto [model, parameters] = colmap_camera(lens_of(camera));
    std::string text =
        "# Camera list with one line of data per camera:\n"
        "#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n";
    if (camera.port) {
        text +=
            "# The lens in air, about its pupil. The rig's port refracts what comes to it, which "
            "COLMAP has no model for: points do not project to their pixels by this alone.\n";
    }
    return text + fmt::format("1 {} {} {} {}\n",
                              model,
                              camera.width_px,
                              camera.height_px,
                              fmt::join(parameters, " "));
}

std::string colmap_images(const std::vector<Leg>& legs, const std::string& suffix) {
    std::string text =
        "# Image list with two lines of data per image:\n"
        "#   IMAGE_ID, QW, QX, QY, QZ, TX, TY, TZ, CAMERA_ID, NAME\n"
        "#   POINTS2D[] as (X, Y, POINT3D_ID)\n"
        "# Each image's world: x to starboard and y forward along the floor, z up, the origin "
        "where "
        "the camera's axis meets it.\n";
    for (const Leg& leg : legs) {
        const Eigen::Quaterniond q = turn_of(leg.sled);
        text += fmt::format("{} {} {} {} {} 0 0 {} 1 {}\n\n",
                            leg.image,
                            q.w() + 0.0,  // without the sign of -0
                            q.x() + 0.0,
                            q.y() + 0.0,
                            q.z() + 0.0,
                            leg.sled.altitude_m,
                            leg.name + suffix);
    }
    return text;
}

void write_colmap(const std::filesystem::path& folder,
                  const Camera& camera,
                  const std::vector<Leg>& legs,
                  const std::string& suffix) {
    require_colmap(camera, legs);
    make_folder(folder);
    write_text_file(folder / "cameras.txt", colmap_cameras(camera));
    write_text_file(folder / "images.txt", colmap_images(legs, suffix));
    write_text_file(
        folder / "points3D.txt",
        "# 3D point list with one line of data per point:\n"
        "#   POINT3D_ID, X, Y, Z, R, G, B, ERROR, TRACK[] as (IMAGE_ID, POINT2D_IDX)\n");
}

}  // namespace aphotic
