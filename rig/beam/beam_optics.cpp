// SPDX-License-Identifier: BSD-3-Clause
#include "rig/beam/beam_optics.h"

#include <boost/math/quadrature/gauss_kronrod.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

namespace aphotic {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

// The area of the unit disc below x and below y.
double disc_corner(double x, double y) {
    const auto slice = [](double t) {  // of x below t
        t = std::clamp(t, -1.0, 1.0);
        return 0.5 * std::numbers::pi + t * std::sqrt(1.0 - t * t) + std::asin(t);
    };
    if (x <= -1.0 || y <= -1.0) return 0.0;
    if (x >= 1.0) return slice(y);
    if (y >= 1.0) return slice(x);
    const double x2_y2 = x * x + y * y;
    if (x2_y2 >= 1.0) {
        // The corner is outside and cuts off two caps that do not meet, or only one.
        if (x >= 0.0 && y >= 0.0) return slice(x) + slice(y) - std::numbers::pi;
        if (x >= 0.0) return slice(y);
        if (y >= 0.0) return slice(x);
        return 0.0;
    }
    // A quarter of the disc, half the excess of each slice over half the disc, and a rectangle.
    return 0.5 * (slice(x) + slice(y)) - 0.25 * std::numbers::pi + x * y;
}

double defocus(const BeamOptics& optics) {
    return 1.0 - optics.distance_m / optics.focal_length_m;
}

// The area of the lens where light of a slope comes from the rectangle.
double lit_area_m2(const BeamOptics& optics, const Vector2d& slope) {
    const double R = 0.5 * optics.aperture_m;
    const double k = std::abs(defocus(optics));
    const Vector2d middle_m = optics.distance_m * slope.cwiseAbs();
    const Vector2d half_m(0.5 * optics.along_m, 0.5 * optics.across_m);
    if (k == 0.0) {
        const bool is_lit = (middle_m.array() <= half_m.array()).all();
        return is_lit ? std::numbers::pi * R * R : 0.0;
    }
    const Vector2d high = (middle_m + half_m) / (k * R);
    const Vector2d low = (middle_m - half_m) / (k * R);
    if (low.cwiseMax(0.0).squaredNorm() >= 1.0) return 0.0;  // not a rounding remainder
    const double area = disc_corner(high.x(), high.y()) - disc_corner(low.x(), high.y()) -
                        disc_corner(high.x(), low.y()) + disc_corner(low.x(), low.y());
    return R * R * std::max(0.0, area);
}

Vector2d slope_of(const Vector3d& direction) {
    return direction.head<2>() / direction.z();
}

double cosine_of(const Vector3d& direction) {
    return direction.z() / direction.norm();
}

// The slopes x/z of all directions within an angle: least and largest, from the planes through the
// other axis that touch their cone. Empty when it reaches 90 degrees.
std::optional<std::array<double, 2>> slopes_within(double x, double z, double sine) {
    const double a = z * z - sine * sine;
    if (z <= 0.0 || a <= 0.0) return std::nullopt;
    const double root = sine * std::sqrt(std::max(0.0, x * x + z * z - sine * sine));
    return std::array{(x * z - root) / a, (x * z + root) / a};
}

double nearest_to_zero(const std::optional<std::array<double, 2>>& range) {
    if (!range) return 0.0;
    return std::clamp(0.0, (*range)[0], (*range)[1]);
}

// The integral of dm / (1 + m^2)^2 from the corner 0 to m: Lambert's for a rectangle.
double corner_share(double x, double y) {
    const double x1 = std::sqrt(1.0 + x * x);
    const double y1 = std::sqrt(1.0 + y * y);
    return 0.5 * (x / x1 * std::atan(y / x1) + y / y1 * std::atan(x / y1));
}

}  // namespace

double optics_intensity(const BeamOptics& optics, const Vector3d& direction) {
    if (direction.z() <= 0.0) return 0.0;
    return cosine_of(direction) * lit_area_m2(optics, slope_of(direction));
}

double endless_intensity(const BeamOptics& optics, const Vector3d& direction) {
    return std::max(0.0, cosine_of(direction)) * most_optics_intensity(optics);
}

double most_optics_intensity(const BeamOptics& optics,
                             const Vector3d& direction,
                             double within_rad) {
    const Vector3d unit = direction.normalized();
    const double cos_nearest =
        std::cos(std::max(0.0, std::acos(std::clamp(unit.z(), -1.0, 1.0)) - within_rad));
    if (cos_nearest <= 0.0) return 0.0;
    if (within_rad >= 0.5 * std::numbers::pi) return most_optics_intensity(optics);
    const double sine = std::sin(within_rad);
    // The area shrinks with either slope, independently of the other.
    const Vector2d nearest(nearest_to_zero(slopes_within(unit.x(), unit.z(), sine)),
                           nearest_to_zero(slopes_within(unit.y(), unit.z(), sine)));
    return cos_nearest * lit_area_m2(optics, nearest);
}

double most_optics_intensity(const BeamOptics& optics) {
    return lit_area_m2(optics, Vector2d::Zero());
}

double optics_flux(const BeamOptics& optics) {
    using Kronrod = boost::math::quadrature::gauss_kronrod<double, 31>;
    constexpr unsigned kHalvings = 8;
    constexpr double kClose = 1e-11;
    constexpr int kTurns = 128;  // round a quarter of the disc; all four are equal
    const double R = 0.5 * optics.aperture_m;
    const double k = defocus(optics);
    const double s = optics.distance_m;
    const auto taken_at = [&](double x, double y) {
        const double x0 = (k * x - 0.5 * optics.along_m) / s;
        const double x1 = (k * x + 0.5 * optics.along_m) / s;
        const double y0 = (k * y - 0.5 * optics.across_m) / s;
        const double y1 = (k * y + 0.5 * optics.across_m) / s;
        return corner_share(x1, y1) - corner_share(x0, y1) - corner_share(x1, y0) +
               corner_share(x0, y0);
    };
    // In fractions of the lens: Boost compares an error that is not multiplied by the interval's
    // length, and would bisect endlessly for small lenses.
    const auto ring = [&](double part) {
        double sum = 0.0;
        for (int i = 0; i < kTurns; ++i) {
            const double turn = 0.5 * std::numbers::pi * (i + 0.5) / kTurns;
            sum += taken_at(part * R * std::cos(turn), part * R * std::sin(turn));
        }
        return part * sum / kTurns;
    };
    return 2.0 * std::numbers::pi * R * R * Kronrod::integrate(ring, 0.0, 1.0, kHalvings, kClose);
}

bool is_focused(const BeamOptics& optics) {
    return defocus(optics) == 0.0;
}

bool is_within_image(const BeamOptics& optics, const Vector3d& direction) {
    if (direction.z() <= 0.0) return false;
    const Vector2d slope = slope_of(direction).cwiseAbs();
    return optics.distance_m * slope.x() <= 0.5 * optics.along_m &&
           optics.distance_m * slope.y() <= 0.5 * optics.across_m;
}

}  // namespace aphotic
