// SPDX-License-Identifier: BSD-3-Clause
#include "rig/camera/lens_model.h"

#include "base/degrees.h"
#include "base/error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aphotic {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

// s and ds/dq, with q = r^2.
struct RadialScale {
    double s;
    double slope;
};

RadialScale radial_scale(const LensModel& lens, double q) {
    const auto& [k1, k2, k3, k4] = lens.radial;
    const auto& [q1, q2, q3] = lens.radial_below;
    const double above = 1.0 + q * (k1 + q * (k2 + q * (k3 + q * k4)));
    const double below = 1.0 + q * (q1 + q * (q2 + q * q3));
    const double above_slope = k1 + q * (2.0 * k2 + q * (3.0 * k3 + q * 4.0 * k4));
    const double below_slope = q1 + q * (2.0 * q2 + q * 3.0 * q3);
    return {.s = above / below,
            .slope = (above_slope * below - above * below_slope) / (below * below)};
}

// d(s r)/dr
double radial_growth(const LensModel& lens, double r) {
    const RadialScale scale = radial_scale(lens, r * r);
    return scale.s + 2.0 * r * r * scale.slope;
}

Vector2d distorted(const LensModel& lens, const Vector2d& p) {
    const auto& [p1, p2] = lens.tangential;
    const double a = p.x();
    const double b = p.y();
    const double q = p.squaredNorm();
    return radial_scale(lens, q).s * p + Vector2d(2.0 * p1 * a * b + p2 * (q + 2.0 * a * a),
                                                  p1 * (q + 2.0 * b * b) + 2.0 * p2 * a * b);
}

Matrix2d distortion_slopes(const LensModel& lens, const Vector2d& p) {
    const auto& [p1, p2] = lens.tangential;
    const double a = p.x();
    const double b = p.y();
    const auto [s, slope] = radial_scale(lens, p.squaredNorm());
    const double across = 2.0 * a * b * slope + 2.0 * (p1 * a + p2 * b);
    Matrix2d slopes;
    slopes << s + 2.0 * a * a * slope + 2.0 * p1 * b + 6.0 * p2 * a, across,  //
        across, s + 2.0 * b * b * slope + 6.0 * p1 * b + 2.0 * p2 * a;
    return slopes;
}

constexpr int kMostSteps = 50;
constexpr double kDone = 1e-15;

// The least r at which s r has this value, searched from 0 outward.
std::optional<double> undistorted_radius(const LensModel& lens, double distorted_r) {
    double r = 0.0;
    for (int i = 0; i < kMostSteps; ++i) {
        const double growth = radial_growth(lens, r);
        if (growth <= 0.0) return std::nullopt;
        const double step = (distorted_r - radial_scale(lens, r * r).s * r) / growth;
        r += step;
        if (std::abs(step) <= kDone * r) return r;
    }
    return std::nullopt;
}

std::optional<Vector2d> undistorted(const LensModel& lens, const Vector2d& wanted) {
    const double wanted_r = wanted.norm();
    if (wanted_r == 0.0 && lens.tangential == std::array<double, 2>{}) return wanted;
    const std::optional<double> r = undistorted_radius(lens, wanted_r);
    if (!r) return std::nullopt;
    Vector2d p = wanted_r > 0.0 ? Vector2d(wanted * (*r / wanted_r)) : wanted;
    for (int i = 0; i < kMostSteps; ++i) {
        const Vector2d step = distortion_slopes(lens, p).inverse() * (wanted - distorted(lens, p));
        p += step;
        if (step.norm() <= kDone * std::max(1.0, p.norm())) return p;
    }
    return std::nullopt;
}

Vector2d image_plane_point(const LensModel& lens, const Vector2d& point_px) {
    const double b = (point_px.y() - lens.centre_px.y()) / lens.focal_px.y();
    const double a = (point_px.x() - lens.centre_px.x() - lens.skew_px * b) / lens.focal_px.x();
    return {a, b};
}

// The largest angle off the axis for which the model is valid: beyond, the image no longer grows.
double reach_rad(const LensModel& lens) {
    constexpr int kSteps = 2000;
    constexpr double kMost_rad = 0.5 * std::numbers::pi * (1.0 - 1e-3);
    for (int i = 1; i <= kSteps; ++i) {
        const double angle_rad = kMost_rad * i / kSteps;
        const double r = lens.is_fisheye ? angle_rad : std::tan(angle_rad);
        if (radial_growth(lens, r) <= 0.0) return kMost_rad * (i - 1) / kSteps;
    }
    return kMost_rad;
}

}  // namespace

Vector2d image_point(const LensModel& lens, const Vector3d& direction) {
    const double across = direction.head<2>().norm();
    Vector2d p = direction.head<2>() / direction.z();
    if (lens.is_fisheye && across > 0.0)
        p = direction.head<2>() * (std::atan2(across, direction.z()) / across);
    const Vector2d q = distorted(lens, p);
    return lens.centre_px +
           Vector2d(lens.focal_px.x() * q.x() + lens.skew_px * q.y(), lens.focal_px.y() * q.y());
}

std::optional<Vector3d> direction_at(const LensModel& lens, const Vector2d& point_px) {
    const std::optional<Vector2d> p = undistorted(lens, image_plane_point(lens, point_px));
    if (!p) return std::nullopt;
    if (!lens.is_fisheye) return Vector3d(p->x(), p->y(), 1.0).normalized();
    const double angle_rad = p->norm();
    if (angle_rad >= 0.5 * std::numbers::pi) return std::nullopt;
    Vector3d direction(0.0, 0.0, std::cos(angle_rad));
    if (angle_rad > 0.0) direction.head<2>() = *p * (std::sin(angle_rad) / angle_rad);
    return direction;
}

std::vector<Vector2d> rim_px(int width_px, int height_px) {
    constexpr int kSteps = 64;
    std::vector<Vector2d> rim;
    for (int i = 0; i <= kSteps; ++i) {
        const double column = width_px * (i / static_cast<double>(kSteps));
        const double row = height_px * (i / static_cast<double>(kSteps));
        rim.insert(rim.end(), {{column, 0.0}, {column, height_px}, {0.0, row}, {width_px, row}});
    }
    return rim;
}

void require_to_hold(const LensModel& lens, int width_px, int height_px) {
    const double most_rad = reach_rad(lens);
    for (const Vector2d& point_px : rim_px(width_px, height_px)) {
        const std::optional<Vector3d> direction = direction_at(lens, point_px);
        if (direction && std::acos(std::min(1.0, direction->z())) < most_rad) continue;
        throw InputError(
            "the lens model is valid to {:.2f} degrees off the axis, which the image exceeds at "
            "column {:.0f}, row {:.0f}; allowed: a calibration that is valid over the whole image, "
            "within 89.9 degrees",
            most_rad * kDegreesPerRadian,
            point_px.x(),
            point_px.y());
    }
}

bool is_pinhole(const LensModel& lens, int width_px, int height_px) {
    return lens == LensModel{.focal_px = Vector2d::Constant(lens.focal_px.x()),
                             .centre_px = {0.5 * width_px, 0.5 * height_px}};
}

std::string lens_model_signature(const LensModel& lens) {
    // Names every field: a new field must be added here.
    const auto& [focal_px, centre_px, skew_px, is_fisheye, radial, below, tangential] = lens;
    return fmt::format("{} f {} {} c {} {} skew {} k {} q {} p {}",
                       is_fisheye ? "fisheye" : "rectilinear",
                       focal_px.x(),
                       focal_px.y(),
                       centre_px.x(),
                       centre_px.y(),
                       skew_px,
                       fmt::join(radial, " "),
                       fmt::join(below, " "),
                       fmt::join(tangential, " "));
}

}  // namespace aphotic
