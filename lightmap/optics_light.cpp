// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/optics_light.h"

#include "lightmap/row_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace aphotic {

namespace {

constexpr double kPi = std::numbers::pi;

// A line x = t of the disc of radius 1, and the area on its near side.
struct DiscLine {
    double t;
    double area;
};

constexpr double kBeyond = 1e30;

// The area of the disc beyond a line at |t| from its middle, which is no square root at the rim but
// its cube: with v = 1 - |t|,
//
//   int_{|t|}^1 2 sqrt(1 - s^2) ds  =  v^(3/2) Q(v),      Q(v) = int_0^1 2 sqrt(q (2 - v q)) dq
//
// and Q a polynomial, Chebyshev's fit: right to 5e-11 of the area.
APHOTIC_IN_LOOP double cap_area(double v) {
    double Q = -6.45499585516518e-05;
    Q = 0.00016462075882373028 + v * Q;
    Q = -0.00029620303160982075 + v * Q;
    Q = 8.196091333445565e-05 + v * Q;
    Q = -0.00046846221730945103 + v * Q;
    Q = -0.0012280584481212387 + v * Q;
    Q = -0.004914885367565347 + v * Q;
    Q = -0.025253455339456 + v * Q;
    Q = -0.2828427236607898 + v * Q;
    Q = 1.8856180832214717 + v * Q;
    return v * std::sqrt(v) * Q;
}

// The part with x below and y below. Where the corner is outside, it cuts off caps that do not
// meet, or takes one alone.
APHOTIC_IN_LOOP double disc_corner(const DiscLine& x, const DiscLine& y) {
    const bool is_inside = x.t * x.t + y.t * y.t < 1.0;
    const double within = 0.5 * (x.area + y.area) - 0.25 * kPi + x.t * y.t;
    const double of_x = y.t >= 0.0 ? x.area : 0.0;
    const double of_y = x.t >= 0.0 ? y.area : 0.0;
    const double of_both = x.t >= 0.0 ? kPi : 0.0;
    const double both = y.t >= 0.0 ? of_both : 0.0;
    return is_inside ? within : of_x + of_y - both;
}

APHOTIC_WIDE void find_image(const OpticsLight& light,
                             const DirectionBlock& V,
                             RowBlock<double>& is_within) {
    const double along = light.half_along;
    const double across = light.half_across;
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        const double beyond_along = std::abs(V.along[i]) - along * V.axis[i];
        const double beyond_across = std::abs(V.across[i]) - across * V.axis[i];
        const bool is_in = std::max(beyond_along, beyond_across) <= 0.0;
        is_within[i] = is_in && V.axis[i] > 0.0 ? 1.0 : 0.0;
    }
}

// |x| and |y| of the rectangle's middle, in the lens.
APHOTIC_WIDE void find_middle(const OpticsLight& light, const DirectionBlock& V, OpticsWork& work) {
    const double shift = light.shift;
    for (std::size_t i = 0; i < V.count; ++i) {
        // Behind the lens: far outside of it.
        const double by_axis = V.axis[i] > 0.0 ? shift / V.axis[i] : 0.0;
        const double beyond = V.axis[i] > 0.0 ? 0.0 : kBeyond;
        work.x[i] = std::abs(V.along[i]) * by_axis + beyond;
        work.y[i] = std::abs(V.across[i]) * by_axis;
    }
}

// Which of them meet the disc: most blocks see few of the rectangle's sides.
APHOTIC_WIDE bool find_lines(const RowBlock<double>& middle,
                             double by,
                             std::size_t count,
                             RowBlock<double>& lines) {
    std::int64_t met = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double above = middle[i] + by > -1.0 ? middle[i] + by : -1.0;
        const double t = above < 1.0 ? above : 1.0;
        lines[i] = t;
        met += t * t < 1.0 ? 1 : 0;
    }
    return met > 0;
}

APHOTIC_WIDE void take_areas(std::size_t count, DiscLines& lines) {
    for (std::size_t i = 0; i < count; ++i) {
        const double t = lines.t[i];
        const double cap = cap_area(1.0 - (t < 0.0 ? -t : t));
        lines.area[i] = t < 0.0 ? cap : kPi - cap;
    }
}

APHOTIC_WIDE void take_all_or_nothing(std::size_t count, DiscLines& lines) {
    for (std::size_t i = 0; i < count; ++i) lines.area[i] = lines.t[i] < 0.0 ? 0.0 : kPi;
}

void cut_disc(const RowBlock<double>& middle, double by, std::size_t count, DiscLines& lines) {
    (find_lines(middle, by, count, lines.t) ? take_areas : take_all_or_nothing)(count, lines);
}

APHOTIC_WIDE void take_lit_area(const OpticsLight& light,
                                const OpticsWork& work,
                                std::size_t count,
                                RowBlock<double>& intensity) {
    const double half_along = light.half_along;
    const double half_across = light.half_across;
    const double per_area = light.per_area;
    for (std::size_t i = 0; i < count; ++i) {
        const DiscLine x0{work.x0.t[i], work.x0.area[i]};
        const DiscLine y0{work.y0.t[i], work.y0.area[i]};
        const DiscLine x1{work.x1.t[i], work.x1.area[i]};
        const DiscLine y1{work.y1.t[i], work.y1.area[i]};
        const double area =
            disc_corner(x1, y1) - disc_corner(x0, y1) - disc_corner(x1, y0) + disc_corner(x0, y0);
        const double low_x = work.x[i] - half_along;
        const double low_y = work.y[i] - half_across;
        const double near_x = low_x > 0.0 ? low_x : 0.0;
        const double near_y = low_y > 0.0 ? low_y : 0.0;
        // And not what rounding leaves.
        const bool is_lit = (area > 0.0) & (near_x * near_x + near_y * near_y < 1.0);
        intensity[i] = is_lit ? per_area * area : 0.0;
    }
}

void take_lit_areas(const OpticsLight& light,
                    const DirectionBlock& V,
                    OpticsWork& work,
                    RowBlock<double>& intensity) {
    cut_disc(work.x, -light.half_along, V.count, work.x0);
    cut_disc(work.x, light.half_along, V.count, work.x1);
    cut_disc(work.y, -light.half_across, V.count, work.y0);
    cut_disc(work.y, light.half_across, V.count, work.y1);
    take_lit_area(light, work, V.count, intensity);
}

APHOTIC_WIDE int count_lit(const OpticsLight& light, const OpticsWork& work) {
    int lit = 0;
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        const double x = work.x[i] - light.half_along;
        const double y = work.y[i] - light.half_across;
        const double near_x = x > 0.0 ? x : 0.0;
        const double near_y = y > 0.0 ? y : 0.0;
        lit += near_x * near_x + near_y * near_y < 1.0 ? 1 : 0;
    }
    return lit;
}

// The lit slopes are convex: between two of a row all are lit. Within them the area is smooth, but
// where the rectangle's sides touch the lens or its corners are on the rim.
void take_blurred(const OpticsLight& light,
                  const DirectionBlock& V,
                  OpticsWork& work,
                  RowBlock<double>& intensity) {
    find_middle(light, V, work);
    if (count_lit(light, work) == 0) {
        intensity.fill(0.0);
        return;
    }
    take_lit_areas(light, V, work, intensity);
}

}  // namespace

OpticsLight optics_light(const BeamOptics& optics, double factor) {
    const double R = 0.5 * optics.aperture_m;
    const double s = optics.distance_m;
    const double k = std::abs(1.0 - s / optics.focal_length_m);
    const bool is_sharp = is_focused(optics);
    const double unit_m = is_sharp ? s : k * R;
    return {.is_focused = is_sharp,
            .half_along = 0.5 * optics.along_m / unit_m,
            .half_across = 0.5 * optics.across_m / unit_m,
            .shift = s / unit_m,
            .per_area = factor * R * R};
}

void look_into(const OpticsLight& light,
               const DirectionBlock& V,
               Edges edges,
               OpticsWork& work,
               RowBlock<double>& intensity) {
    if (!light.is_focused) {
        take_blurred(light, V, work, intensity);
        return;
    }
    if (edges == Edges::Found) find_image(light, V, work.is_within);
    for (std::size_t i = 0; i < kBlockCount; ++i) {
        intensity[i] = work.is_within[i] * light.per_area * kPi;
    }
}

}  // namespace aphotic
