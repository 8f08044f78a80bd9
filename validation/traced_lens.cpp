// SPDX-License-Identifier: BSD-3-Clause
#include "validation/traced_lens.h"

#include <boost/math/tools/toms748_solve.hpp>

#include <cmath>
#include <cstdint>

namespace aphotic {

namespace {

using Point = Eigen::Matrix<long double, 2, 1>;

// Just below 90 degrees, where a rectilinear lens has no image, and a fisheye's ray has no z.
constexpr long double kMost_rad = 1.5692L;

}  // namespace

TracedLens::TracedLens(const LensModel& lens) : lens_(lens), most_r_(0.0L), most_image_r_(0.0L) {
    constexpr int kSteps = 10000;
    for (int i = 1; i <= kSteps; ++i) {
        const long double angle_rad = kMost_rad * i / kSteps;
        const long double r = lens.is_fisheye ? angle_rad : std::tan(angle_rad);
        const long double image_r = image_radius(r);
        if (!(image_r > most_image_r_)) break;
        most_r_ = r;
        most_image_r_ = image_r;
    }
}

long double TracedLens::image_radius(long double r) const {
    long double above = 1.0L;
    long double below = 1.0L;
    long double power = r * r;
    for (std::size_t k = 0; k < lens_.radial.size(); ++k) {
        above += lens_.radial[k] * power;
        if (k < lens_.radial_below.size()) below += lens_.radial_below[k] * power;
        power *= r * r;
    }
    return r * above / below;
}

std::optional<TracedLens::Direction> TracedLens::direction(double column, double row) const {
    const long double y =
        (static_cast<long double>(row) - lens_.centre_px.y()) / lens_.focal_px.y();
    const long double x =
        (static_cast<long double>(column) - lens_.centre_px.x() - lens_.skew_px * y) /
        lens_.focal_px.x();
    const long double p1 = lens_.tangential[0];
    const long double p2 = lens_.tangential[1];
    const Point wanted(x, y);
    Point at = wanted;
    constexpr int kMostRounds = 200;
    constexpr long double kSame = 1e-17L;
    for (int round = 0; round < kMostRounds; ++round) {
        const long double a = at.x();
        const long double b = at.y();
        const Point decentred(2.0L * p1 * a * b + p2 * (3.0L * a * a + b * b),
                              p1 * (a * a + 3.0L * b * b) + 2.0L * p2 * a * b);
        const Point radial = wanted - decentred;
        const long double image_r = radial.norm();
        if (image_r >= most_image_r_) return std::nullopt;
        long double share = 1.0L;
        if (image_r > 0.0L) {
            std::uintmax_t most_steps = 200;
            const auto found = boost::math::tools::toms748_solve(
                [&](long double r) { return image_radius(r) - image_r; },
                0.0L,
                most_r_,
                boost::math::tools::eps_tolerance<long double>(62),
                most_steps);
            share = 0.5L * (found.first + found.second) / image_r;
        }
        const Point next = share * radial;
        const bool is_same = (next - at).norm() <= kSame * (1.0L + next.norm());
        at = next;
        if (!is_same) continue;
        const long double angle_rad = at.norm();
        if (lens_.is_fisheye && angle_rad > 0.0L) at *= std::tan(angle_rad) / angle_rad;
        return Direction(-at.y(), at.x(), 1.0L);
    }
    return std::nullopt;
}

double traced_vignetting(const Camera& camera,
                         double column,
                         double row,
                         const Eigen::Matrix<long double, 3, 1>& sight) {
    if (!camera.vignetting) return 1.0;
    const long double tangent_squared =
        (sight.x() * sight.x() + sight.y() * sight.y()) / (sight.z() * sight.z());
    if (const auto* radial = std::get_if<RadialVignetting>(&*camera.vignetting)) {
        double right = column - camera.width_px / 2.0;
        double down = row - camera.height_px / 2.0;
        if (camera.lens) {
            right = column - camera.lens->centre_px.x();
            down = row - camera.lens->centre_px.y();
        }
        const double p =
            std::hypot(right, down) / std::hypot(camera.width_px, camera.height_px) * 2;
        return 1.0 + radial->a[0] * std::pow(p, 2) + radial->a[1] * std::pow(p, 4) +
               radial->a[2] * std::pow(p, 6);
    }
    if (const auto* table = std::get_if<TabulatedVignetting>(&*camera.vignetting)) {
        const double angle_rad = static_cast<double>(std::atan(std::sqrt(tangent_squared)));
        std::size_t row_of = 0;
        while (row_of + 2 < table->angles_rad.size() && table->angles_rad[row_of + 1] < angle_rad)
            ++row_of;
        const double from_rad = table->angles_rad[row_of];
        const double slope = (table->factors[row_of + 1] - table->factors[row_of]) /
                             (table->angles_rad[row_of + 1] - from_rad);
        return table->factors[row_of] + slope * (angle_rad - from_rad);
    }
    // cos^n = (1 + tan^2)^(-n/2)
    const long double n = std::get<NaturalVignetting>(*camera.vignetting).exponent;
    return static_cast<double>(std::pow(1.0L + tangent_squared, -n / 2.0L));
}

}  // namespace aphotic
