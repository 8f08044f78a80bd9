// SPDX-License-Identifier: BSD-3-Clause
#include "rig/beam/beam_crease.h"

#include <cmath>
#include <numbers>
#include <variant>

namespace aphotic {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using std::numbers::pi;

// The frame of one beam's creases: the beam's own directions in the sled's frame, and the window's
// index.
struct CreaseFrame {
    Vector3d X;
    Vector3d Y;
    Vector3d Z;
    double n;  // 1 without a window

    // w.l = at in air, with l across the axis: in water the sine is smaller by n.
    [[nodiscard]] Crease circle_across(const Vector3d& l, double sine) const {
        return {.l = l, .at = sine / n};
    }
    // x = m z in air, with x along l and y along the other direction across the axis.
    [[nodiscard]] Crease slope(const Vector3d& l, const Vector3d& other, double m) const {
        if (n == 1.0) return {.l = (l - m * Z).normalized()};
        // n^2 x^2 = m^2 (1 - n^2 (x^2 + y^2)) in water
        const double share = m * m / (1.0 + m * m);
        return {.Q = n * n * (l * l.transpose() + share * other * other.transpose()),
                .at = share,
                .is_quadratic = true};
    }
    [[nodiscard]] Crease about_axis(double theta_rad) const {
        const double sine = std::sin(theta_rad) / n;
        const double cosine = n == 1.0 ? std::cos(theta_rad) : std::sqrt(1.0 - sine * sine);
        return {.l = Z, .at = cosine};
    }
};

CreaseFrame crease_frame(const Beam& beam, const BeamFrame& frame) {
    const double c = std::cos(beam.turn_rad);
    const double s = std::sin(beam.turn_rad);
    return {.X = c * frame.along + s * frame.across,
            .Y = c * frame.across - s * frame.along,
            .Z = frame.axis,
            .n = beam.window ? beam.window->water_index : 1.0};
}

void add_creases(const std::vector<Cone>& cones,
                 const CreaseFrame& frame,
                 std::vector<Crease>& creases) {
    for (const Cone& cone : cones) {
        if (cone.weight == 0.0) continue;
        creases.push_back(frame.about_axis(cone.half_angle_rad));
        if (cone.edge_rad > 0.0)
            creases.push_back(frame.about_axis(cone.half_angle_rad - cone.edge_rad));
    }
}

void add_creases(const BeamTable& table, const CreaseFrame& frame, std::vector<Crease>& creases) {
    const bool has_columns = table.horizontal_rad.size() > 1;
    for (const double V : table.vertical_rad) {
        if (table.angles == TableAngles::TypeA)
            creases.push_back(frame.circle_across(frame.X, std::sin(V)));
        else if (table.angles == TableAngles::TypeB)
            creases.push_back(frame.slope(frame.X, frame.Y, std::tan(V)));
        else if (frame.n == 1.0 || V <= 0.5 * pi)
            creases.push_back(frame.about_axis(V));
    }
    for (const double H : table.horizontal_rad) {
        if (table.angles == TableAngles::TypeA)
            creases.push_back(frame.slope(frame.Y, frame.X, std::tan(H)));
        else if (table.angles == TableAngles::TypeB)
            creases.push_back(frame.circle_across(frame.Y, std::sin(H)));
        else if (has_columns)
            creases.push_back({.l = std::sin(H) * frame.X + std::cos(H) * frame.Y});
    }
}

void add_creases(const BeamOptics& optics, const CreaseFrame& frame, std::vector<Crease>& creases) {
    const double s = optics.distance_m;
    const double blur_m =
        0.5 * optics.aperture_m * std::abs(1.0 - optics.distance_m / optics.focal_length_m);
    const double x_m = 0.5 * optics.along_m;
    const double y_m = 0.5 * optics.across_m;
    for (const double sign : {-1.0, 1.0}) {
        for (const double blur : {-blur_m, blur_m}) {
            creases.push_back(frame.slope(frame.X, frame.Y, sign * (x_m + blur) / s));
            creases.push_back(frame.slope(frame.Y, frame.X, sign * (y_m + blur) / s));
        }
        if (is_focused(optics) || frame.n != 1.0) continue;
        for (const double other : {-1.0, 1.0}) {
            const Vector3d x = s * frame.X + sign * x_m * frame.Z;
            const Vector3d y = s * frame.Y + other * y_m * frame.Z;
            creases.push_back({.Q = x * x.transpose() + y * y.transpose() -
                                    blur_m * blur_m * frame.Z * frame.Z.transpose(),
                               .is_quadratic = true});
        }
    }
}

void add_creases(std::monostate /*none*/,
                 const CreaseFrame& /*frame*/,
                 std::vector<Crease>& /*creases*/) {}

}  // namespace

std::vector<Crease> creases_of(const Beam& beam, const BeamFrame& frame) {
    const CreaseFrame own = crease_frame(beam, frame);
    std::vector<Crease> creases;
    add_creases(beam.cones, own, creases);
    std::visit([&](const auto& pattern) { add_creases(pattern, own, creases); }, beam.pattern);
    creases.push_back(own.about_axis(0.5 * pi));
    return creases;
}

void add_crossings(const Crease& crease,
                   const Vector3d& e,
                   const Vector3d& u,
                   std::vector<double>& phi_rad) {
    if (!crease.is_quadratic) {
        const double A = crease.l.dot(e);
        const double B = crease.l.dot(u);
        const double size = std::sqrt(A * A + B * B);
        if (std::abs(crease.at) >= size) return;
        const double middle = std::atan2(B, A);
        const double half = std::acos(crease.at / size);
        for (const double phi : {middle - half, middle + half})
            phi_rad.push_back(std::abs(phi) <= pi ? phi : std::remainder(phi, 2.0 * pi));
        return;
    }
    const Vector3d turned = crease.Q * e;
    const double a = e.dot(turned);
    const double b = u.dot(crease.Q * u);
    const double c = 2.0 * u.dot(turned);
    const double size = std::hypot(a - b, c);
    const double at = 2.0 * crease.at - a - b;
    if (std::abs(at) >= size) return;
    const double middle = 0.5 * std::atan2(c, a - b);
    const double half = 0.5 * std::acos(at / size);
    for (const double phi : {middle - half, middle + half, middle - half + pi, middle + half + pi})
        phi_rad.push_back(std::abs(phi) <= pi ? phi : std::remainder(phi, 2.0 * pi));
}

}  // namespace aphotic
