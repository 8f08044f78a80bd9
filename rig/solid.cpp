// SPDX-License-Identifier: BSD-3-Clause
#include "rig/solid.h"

#include "rig/camera/lens.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace aphotic {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

namespace {

struct Ball {
    Vector3d centre_m;
    double radius_m;
};

Ball ball_about(const Shape& shape) {
    const AlignedBox3d box = bounds_m(shape);
    return {.centre_m = box.center(), .radius_m = 0.5 * box.diagonal().norm()};
}

std::array<Vector3d, 3> corners_m(const Mesh& mesh, const std::array<int, 3>& triangle) {
    const auto vertex_m = [&](int i) { return mesh.vertices_m[static_cast<std::size_t>(i)]; };
    return {vertex_m(triangle[0]), vertex_m(triangle[1]), vertex_m(triangle[2])};
}

double distance_to_segment_m(const Vector3d& a, const Vector3d& b, const Vector3d& point_m) {
    const Vector3d along = b - a;
    const double share = std::clamp(along.dot(point_m - a) / along.squaredNorm(), 0.0, 1.0);
    return (a + share * along - point_m).norm();
}

// The distance perpendicular to the triangle's plane if the point is over the triangle, else to its
// rim.
double distance_to_triangle_m(const std::array<Vector3d, 3>& corners_m, const Vector3d& point_m) {
    const Vector3d normal =
        (corners_m[1] - corners_m[0]).cross(corners_m[2] - corners_m[0]).normalized();
    bool is_over = true;
    double rim_m = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        const Vector3d& a = corners_m[i];
        const Vector3d& b = corners_m[(i + 1) % 3];
        is_over = is_over && normal.dot((b - a).cross(point_m - a)) >= 0.0;
        rim_m = std::min(rim_m, distance_to_segment_m(a, b, point_m));
    }
    return is_over ? std::abs(normal.dot(point_m - corners_m[0])) : rim_m;
}

double distance_to_mesh_m(const Mesh& mesh, const Vector3d& point_m) {
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const std::array<int, 3>& triangle : mesh.triangles) {
        nearest_m = std::min(nearest_m, distance_to_triangle_m(corners_m(mesh, triangle), point_m));
    }
    return nearest_m;
}

// Whether the half line from the point crosses the triangle: it passes all three sides on the same
// side, with the triangle's plane ahead.
bool crosses(const std::array<Vector3d, 3>& corners_m,
             const Vector3d& point_m,
             const Vector3d& direction) {
    const Vector3d a = corners_m[0] - point_m;
    const Vector3d b = corners_m[1] - point_m;
    const Vector3d c = corners_m[2] - point_m;
    const double ab = direction.dot(a.cross(b));
    const double bc = direction.dot(b.cross(c));
    const double ca = direction.dot(c.cross(a));
    const bool is_left = ab >= 0.0 && bc >= 0.0 && ca >= 0.0;
    const bool is_right = ab <= 0.0 && bc <= 0.0 && ca <= 0.0;
    return (is_left || is_right) && a.dot(b.cross(c)) * (ab + bc + ca) > 0.0;
}

bool mesh_holds(const Mesh& mesh, const Vector3d& point_m) {
    // Three directions, none of them likely to be parallel to an object's edge. A line that meets
    // an edge may count it twice or not at all; the majority of three is right.
    const std::array<Vector3d, 3> directions{Vector3d(0.377, 0.593, 0.711),
                                             Vector3d(-0.823, 0.291, 0.487),
                                             Vector3d(0.139, -0.957, 0.253)};
    int votes = 0;
    for (const Vector3d& direction : directions) {
        const auto crossings = std::ranges::count_if(mesh.triangles, [&](const auto& triangle) {
            return crosses(corners_m(mesh, triangle), point_m, direction);
        });
        votes += crossings % 2 == 1 ? 1 : 0;
    }
    return votes >= 2;
}

}  // namespace

AlignedBox3d bounds_m(const Shape& shape) {
    if (const auto* sphere = std::get_if<Sphere>(&shape)) {
        const Vector3d reach_m = Vector3d::Constant(sphere->radius_m);
        return {sphere->centre_m - reach_m, sphere->centre_m + reach_m};
    }
    if (const auto* box = std::get_if<Box>(&shape)) return {box->least_m, box->most_m};
    const auto& mesh = std::get<Mesh>(shape);
    AlignedBox3d bounds;
    for (const std::array<int, 3>& triangle : mesh.triangles) {
        for (const Vector3d& corner : corners_m(mesh, triangle)) bounds.extend(corner);
    }
    return bounds;
}

double distance_m(const Shape& shape, const Vector3d& point_m) {
    if (const auto* sphere = std::get_if<Sphere>(&shape)) {
        return std::max(0.0, (point_m - sphere->centre_m).norm() - sphere->radius_m);
    }
    if (const auto* mesh = std::get_if<Mesh>(&shape)) return distance_to_mesh_m(*mesh, point_m);
    return bounds_m(shape).exteriorDistance(point_m);
}

bool holds(const Shape& shape, const Vector3d& point_m) {
    const auto* mesh = std::get_if<Mesh>(&shape);
    if (mesh == nullptr) return distance_m(shape, point_m) == 0.0;
    return bounds_m(shape).contains(point_m) && mesh_holds(*mesh, point_m);
}

bool has_highlight(const Rig& rig) {
    return rig.seafloor.phong > 0.0 ||
           std::ranges::any_of(rig.objects, [](const Object& o) { return o.phong > 0.0; });
}

// The image's rays are within a cone about the camera's axis, in water no wider than in air, and
// with a port they start no farther from the pupil than its reach.
bool may_be_in_view(const Rig& rig, const Object& object) {
    const Ball ball = ball_about(object.shape);
    const double radius_m = ball.radius_m + port_reach_m(rig);
    const double range_m = ball.centre_m.norm();
    if (range_m <= radius_m) return true;
    const double off_axis_rad = std::acos(std::clamp(ball.centre_m.z() / range_m, -1.0, 1.0));
    return off_axis_rad <= half_view_rad(rig.camera) + std::asin(radius_m / range_m);
}

bool may_light(const Strobe& strobe, const Beam& beam, const Object& object) {
    if (strobe.power == 0.0 || is_dark(beam)) return false;
    const Ball ball = ball_about(object.shape);
    const Vector3d towards = ball.centre_m - strobe.position_m;
    const double radius_m = ball.radius_m + emitter_reach_m(strobe);
    const double range_m = towards.norm();
    if (range_m <= radius_m) return true;
    return reaches(beam, frame_about(strobe.axis), towards, std::asin(radius_m / range_m));
}

double least_throw_m(const Rig& rig, const Strobe& strobe, const Vector3d& lamp_m) {
    double least_m = height_above(floor_plane(rig.sled), lamp_m);
    for (const Object& object : rig.objects) {
        if (may_light(strobe, strobe.beam, object) && may_be_in_view(rig, object)) {
            least_m = std::min(least_m, distance_m(object.shape, lamp_m));
        }
    }
    return least_m;
}

}  // namespace aphotic
