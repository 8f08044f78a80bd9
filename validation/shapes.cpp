// SPDX-License-Identifier: BSD-3-Clause
#include "validation/shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aphotic {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

namespace {

constexpr double kBoxRoom = 1e-12;  // of the coordinates: a few thousand roundings

bool is_within(double distance_m, Stretch stretch) {
    return distance_m > stretch.from_m && distance_m < stretch.to_m;
}

std::optional<Hit> hit_sphere(const Sphere& sphere, const SightLine& line, Stretch stretch) {
    const Vector3d from_centre = line.origin_m - sphere.centre_m;
    const double b = from_centre.dot(line.direction);
    // The distance of the line from the centre, not from the difference of two large squares.
    const double apart_m = (from_centre - b * line.direction).norm();
    const double quarter = (sphere.radius_m - apart_m) * (sphere.radius_m + apart_m);
    if (quarter < 0.0) return std::nullopt;
    const double c =
        (from_centre.norm() - sphere.radius_m) * (from_centre.norm() + sphere.radius_m);
    const double far = -b - std::copysign(std::sqrt(quarter), b);
    std::array<double, 2> roots{far, far == 0.0 ? 0.0 : c / far};
    if (roots[0] > roots[1]) std::swap(roots[0], roots[1]);
    for (const double distance_m : roots) {
        if (!is_within(distance_m, stretch)) continue;
        return Hit{.distance_m = distance_m,
                   .normal = (from_centre + distance_m * line.direction).normalized(),
                   .face = 0};
    }
    return std::nullopt;
}

// The places where the line enters and leaves the box, and their faces: 2 axis, + 1 for the greater
// side.
struct Crossing {
    std::array<double, 2> distance_m{-std::numeric_limits<double>::infinity(),
                                     std::numeric_limits<double>::infinity()};
    std::array<int, 2> face{0, 0};
};

std::optional<Crossing> cross_box(const Vector3d& least_m,
                                  const Vector3d& most_m,
                                  const SightLine& line) {
    Crossing crossing;
    for (int axis = 0; axis < 3; ++axis) {
        const double origin_m = line.origin_m(axis);
        const double slope = line.direction(axis);
        if (slope == 0.0) {
            if (origin_m < least_m(axis) || origin_m > most_m(axis)) return std::nullopt;
            continue;
        }
        std::array<double, 2> at_m{(least_m(axis) - origin_m) / slope,
                                   (most_m(axis) - origin_m) / slope};
        std::array<int, 2> face{2 * axis, 2 * axis + 1};
        if (slope < 0.0) {
            std::swap(at_m[0], at_m[1]);
            std::swap(face[0], face[1]);
        }
        if (at_m[0] > crossing.distance_m[0]) {
            crossing.distance_m[0] = at_m[0];
            crossing.face[0] = face[0];
        }
        if (at_m[1] < crossing.distance_m[1]) {
            crossing.distance_m[1] = at_m[1];
            crossing.face[1] = face[1];
        }
    }
    if (crossing.distance_m[0] > crossing.distance_m[1]) return std::nullopt;
    return crossing;
}

std::optional<Hit> hit_box(const Box& box, const SightLine& line, Stretch stretch) {
    const auto crossing = cross_box(box.least_m, box.most_m, line);
    for (std::size_t i = 0; crossing && i < 2; ++i) {
        if (!is_within(crossing->distance_m[i], stretch)) continue;
        return Hit{.distance_m = crossing->distance_m[i],
                   .normal = Vector3d::Unit(crossing->face[i] / 2),
                   .face = crossing->face[i]};
    }
    return std::nullopt;
}

}  // namespace

// Eigen's traversal uses this: the nearest triangle so far, and the rest of the line.
struct TracedShape::Nearest {
    const SightLine& line;
    Stretch stretch;
    int skip;
    const Triangle* triangle = nullptr;

    [[nodiscard]] bool intersectVolume(const AlignedBox3d& box) const {  // NOLINT: Eigen's name
        const auto crossing = cross_box(box.min(), box.max(), line);
        return crossing && crossing->distance_m[0] < stretch.to_m &&
               crossing->distance_m[1] > stretch.from_m;
    }

    // False: continue, since a nearer one may follow.
    bool intersectObject(const Triangle& other) {  // NOLINT: Eigen's name
        if (other.face == skip) return false;
        const Vector3d across = line.direction.cross(other.ac_m);
        const double det = other.ab_m.dot(across);
        if (det == 0.0) return false;
        const Vector3d from_a = line.origin_m - other.a_m;
        const double u = from_a.dot(across) / det;
        const Vector3d up = from_a.cross(other.ab_m);
        const double v = line.direction.dot(up) / det;
        if (u < 0.0 || v < 0.0 || u + v > 1.0) return false;
        const double distance_m = other.ac_m.dot(up) / det;
        if (!is_within(distance_m, stretch)) return false;
        stretch.to_m = distance_m;
        triangle = &other;
        return false;
    }
};

TracedShape::Triangles TracedShape::triangles_of(const Mesh& mesh) {
    std::vector<Triangle> triangles;
    std::vector<AlignedBox3d> boxes;
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vector3d& a_m = mesh.vertices_m[static_cast<std::size_t>(a)];
        const Vector3d& b_m = mesh.vertices_m[static_cast<std::size_t>(b)];
        const Vector3d& c_m = mesh.vertices_m[static_cast<std::size_t>(c)];
        triangles.push_back({.a_m = a_m,
                             .ab_m = b_m - a_m,
                             .ac_m = c_m - a_m,
                             .face = static_cast<int>(triangles.size())});
        boxes.emplace_back(a_m);
        boxes.back().extend(b_m);
        boxes.back().extend(c_m);
        // A triangle's box may be flat: margin for rounding.
        const Vector3d room_m = Vector3d::Constant(kBoxRoom * (1.0 + a_m.norm()));
        boxes.back().min() -= room_m;
        boxes.back().max() += room_m;
    }
    return {triangles.begin(), triangles.end(), boxes.begin(), boxes.end()};
}

TracedShape::TracedShape(const Shape& shape) {
    if (const auto* sphere = std::get_if<Sphere>(&shape)) {
        shape_ = *sphere;
        const Vector3d reach_m = Vector3d::Constant(sphere->radius_m);
        parts_m_.emplace_back(sphere->centre_m - reach_m, sphere->centre_m + reach_m);
    } else if (const auto* box = std::get_if<Box>(&shape)) {
        shape_ = *box;
        parts_m_.emplace_back(box->least_m, box->most_m);
    } else {
        const auto& mesh = std::get<Mesh>(shape);
        shape_ = triangles_of(mesh);
        for (const std::array<int, 3>& triangle : mesh.triangles) {
            parts_m_.emplace_back();
            for (const int i : triangle) {
                parts_m_.back().extend(mesh.vertices_m[static_cast<std::size_t>(i)]);
            }
        }
    }
    for (const AlignedBox3d& part_m : parts_m_) bounds_m_.extend(part_m);
    // A mesh may be flat: margin for rounding.
    const Vector3d room_m = Vector3d::Constant(kBoxRoom * (1.0 + bounds_m_.max().norm()));
    bounds_m_.min() -= room_m;
    bounds_m_.max() += room_m;
}

std::optional<Hit> TracedShape::first_hit(const SightLine& line, Stretch stretch, int skip) const {
    if (const auto* triangles = std::get_if<Triangles>(&shape_)) {
        // Eigen's traversal allocates memory before its first box.
        if (!cross_box(bounds_m_.min(), bounds_m_.max(), line)) return std::nullopt;
        Nearest nearest{.line = line, .stretch = stretch, .skip = skip};
        Eigen::BVIntersect(*triangles, nearest);
        if (nearest.triangle == nullptr) return std::nullopt;
        const Triangle& triangle = *nearest.triangle;
        return Hit{.distance_m = nearest.stretch.to_m,
                   .normal = triangle.ab_m.cross(triangle.ac_m).normalized(),
                   .face = triangle.face};
    }
    if (skip >= 0) return std::nullopt;
    if (const auto* sphere = std::get_if<Sphere>(&shape_))
        return hit_sphere(*sphere, line, stretch);
    return hit_box(std::get<Box>(shape_), line, stretch);
}

double TracedShape::least_distance_m(const Vector3d& point_m) const {
    double least_m = std::numeric_limits<double>::infinity();
    for (const AlignedBox3d& part_m : parts_m_) {
        least_m = std::min(least_m, part_m.exteriorDistance(point_m));
    }
    return least_m;
}

}  // namespace aphotic
