// SPDX-License-Identifier: BSD-3-Clause
#include "validation/traced_beam.h"

#include <Eigen/Geometry>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/quadrature/tanh_sinh.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <span>
#include <utility>
#include <variant>

namespace aphotic {

using Eigen::Vector3d;

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kQuarterTurn = 0.5 * kPi;

double square(double x) {
    return x * x;
}

double angle_from_to(const Vector3d& a, const Vector3d& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

// ---- Cones

// The integral of cos^n over a cone; for narrow ones 1 - cos^n is a small difference.
double flux_of_sharp(double half_angle_rad, double n) {
    const double sine2 = std::pow(std::sin(half_angle_rad), 2);
    const double power = n + 1.0;
    return n == 1.0 ? kPi * sine2
                    : -2.0 * kPi * std::expm1(0.5 * power * std::log1p(-sine2)) / power;
}

double versine(double angle_rad) {
    return 2.0 * square(std::sin(0.5 * angle_rad));
}

double flux_of_soft(const Cone& cone) {
    const double none = versine(cone.half_angle_rad);
    const double full = versine(cone.half_angle_rad - cone.edge_rad);
    const double power = cone.exponent + 1.0;
    const auto share = [&](double t) {
        const double end = std::min(1.0, std::lerp(none, full, t));
        return -6.0 * t * (1.0 - t) * std::expm1(power * std::log1p(-end));
    };
    return 2.0 * kPi / power *
           boost::math::quadrature::tanh_sinh<double>().integrate(share, 0.0, 1.0);
}

// ---- Tables

// The place of an angle among a table's: at a share of the way from `below` to the next.
struct Place {
    std::size_t below = 0;
    double share = 0.0;
};

std::optional<Place> place_among(std::span<const double> nodes_rad, double angle_rad) {
    if (angle_rad < nodes_rad.front() || angle_rad > nodes_rad.back()) return std::nullopt;
    const auto above = std::upper_bound(nodes_rad.begin() + 1, nodes_rad.end() - 1, angle_rad);
    const auto below = static_cast<std::size_t>(std::distance(nodes_rad.begin(), above)) - 1;
    return Place{
        .below = below,
        .share = (angle_rad - nodes_rad[below]) / (nodes_rad[below + 1] - nodes_rad[below])};
}

double value_at(const BeamTable& table, std::size_t horizontal, std::size_t vertical) {
    return table.intensity[horizontal * table.vertical_rad.size() + vertical];
}

double value_along(const BeamTable& table, std::size_t horizontal, const Place& vertical) {
    return std::lerp(value_at(table, horizontal, vertical.below),
                     value_at(table, horizontal, vertical.below + 1),
                     vertical.share);
}

struct Angles {
    double vertical_rad;
    double horizontal_rad;
};

// Latitude above the plane across an axis, and longitude about it.
double elevation(const Vector3d& w, const Vector3d& axis) {
    return std::atan2(w.dot(axis), w.cross(axis).norm());
}

double azimuth(const Vector3d& w, const Vector3d& from, const Vector3d& to) {
    return std::atan2(w.dot(to), w.dot(from));
}

Angles goniometer_angles(TableAngles type, const Vector3d& lamp) {
    const Vector3d x = Vector3d::UnitX();
    const Vector3d y = Vector3d::UnitY();
    const Vector3d z = Vector3d::UnitZ();
    switch (type) {
        case TableAngles::TypeA:
            return {elevation(lamp, x), azimuth(lamp, z, y)};
        case TableAngles::TypeB:
            return {azimuth(lamp, z, x), elevation(lamp, y)};
        case TableAngles::TypeC:
            break;
    }
    const double around = azimuth(lamp, x, -y);
    return {angle_from_to(lamp, z), around < 0.0 ? around + 2.0 * kPi : around};
}

double intensity_of(const BeamTable& table, const Vector3d& lamp) {
    const Angles angles = goniometer_angles(table.angles, lamp);
    const auto vertical = place_among(table.vertical_rad, angles.vertical_rad);
    if (!vertical) return 0.0;
    if (table.horizontal_rad.size() == 1) return value_along(table, 0, *vertical);
    // For type C they make exactly a full turn, whatever the rounding of 360 degrees.
    const double around_rad = table.angles == TableAngles::TypeC
                                  ? std::min(angles.horizontal_rad, table.horizontal_rad.back())
                                  : angles.horizontal_rad;
    const auto horizontal = place_among(table.horizontal_rad, around_rad);
    if (!horizontal) return 0.0;
    return std::lerp(value_along(table, horizontal->below, *vertical),
                     value_along(table, horizontal->below + 1, *vertical),
                     horizontal->share);
}

// Cell by cell: in one angle, on which the solid angle depends, by quadrature; in the other I is
// linear and contributes the mean of its ends.
double integral_of(const BeamTable& table) {
    using Gauss = boost::math::quadrature::gauss<double, 20>;
    const bool is_by_horizontal = table.angles == TableAngles::TypeB;
    const std::vector<double>& by = is_by_horizontal ? table.horizontal_rad : table.vertical_rad;
    const std::vector<double>& other = is_by_horizontal ? table.vertical_rad : table.horizontal_rad;
    const auto value = [&](std::size_t i, std::size_t j) {
        return is_by_horizontal ? value_at(table, i, j) : value_at(table, j, i);
    };
    const auto strip = [&](std::size_t j) {  // the integral along one line of the other angle
        double sum = 0.0;
        for (std::size_t i = 0; i + 1 < by.size(); ++i) {
            sum += Gauss::integrate(
                [&](double angle) {
                    const double share = (angle - by[i]) / (by[i + 1] - by[i]);
                    const double solid =
                        table.angles == TableAngles::TypeC ? std::sin(angle) : std::cos(angle);
                    return std::lerp(value(i, j), value(i + 1, j), share) * solid;
                },
                by[i],
                by[i + 1]);
        }
        return sum;
    };
    if (other.size() == 1) return 2.0 * kPi * strip(0);
    double sum = 0.0;
    for (std::size_t j = 0; j + 1 < other.size(); ++j) {
        sum += 0.5 * (strip(j) + strip(j + 1)) * (other[j + 1] - other[j]);
    }
    return sum;
}

// ---- A lens before a lit rectangle

struct Heights {
    double from_m;
    double to_m;
};

// A ray that leaves the lens at height h with slope m came to it with slope m + h/f, from h - s (m
// + h/f) of the rectangle's plane. The heights for which that is within the rectangle's side.
Heights lit_heights(const BeamOptics& optics, double side_m, double slope) {
    const double per_height = 1.0 - optics.distance_m / optics.focal_length_m;
    const double aside_m = optics.distance_m * slope;
    const double radius_m = 0.5 * optics.aperture_m;
    if (per_height == 0.0) {
        return std::abs(aside_m) <= 0.5 * side_m ? Heights{-radius_m, radius_m} : Heights{0.0, 0.0};
    }
    const double a_m = (aside_m - 0.5 * side_m) / per_height;
    const double b_m = (aside_m + 0.5 * side_m) / per_height;
    return {.from_m = std::clamp(std::min(a_m, b_m), -radius_m, radius_m),
            .to_m = std::clamp(std::max(a_m, b_m), -radius_m, radius_m)};
}

// With heights across as R sin(t), a strip of the lens extends R cos(t) to both sides.
double intensity_of(const BeamOptics& optics, const Vector3d& lamp) {
    if (!(lamp.z() > 0.0)) return 0.0;
    const double radius_m = 0.5 * optics.aperture_m;
    const Heights along = lit_heights(optics, optics.along_m, lamp.x() / lamp.z());
    const Heights across = lit_heights(optics, optics.across_m, lamp.y() / lamp.z());
    if (!(along.from_m < along.to_m) || !(across.from_m < across.to_m)) return 0.0;
    const double first = std::asin(across.from_m / radius_m);
    const double last = std::asin(across.to_m / radius_m);
    std::array<double, 6> cuts{first, last};
    auto next = cuts.begin() + 2;
    for (const double end_m : {along.from_m, along.to_m}) {
        const double meets_rim = std::acos(std::abs(end_m) / radius_m);
        *next++ = std::clamp(meets_rim, first, last);
        *next++ = std::clamp(-meets_rim, first, last);
    }
    std::ranges::sort(cuts);
    const auto strip = [&](double t) {
        const double half_m = radius_m * std::cos(t);
        return half_m *
               std::max(0.0, std::min(along.to_m, half_m) - std::max(along.from_m, -half_m));
    };
    double area_m2 = 0.0;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        if (cuts[i] < cuts[i + 1]) {
            area_m2 +=
                boost::math::quadrature::gauss<double, 15>::integrate(strip, cuts[i], cuts[i + 1]);
        }
    }
    return area_m2 * lamp.z() / lamp.norm();
}

// The rectangle's flux through one point of the lens: the integral of (1 + p^2 + q^2)^-2 over the
// slopes p, q with which its light leaves. Over p it is elementary; q = tan(u).
double flux_through(const Heights& p, const Heights& q) {
    const auto over_p = [](double p_end, double u) {
        const double c = 1.0 / std::cos(u);
        return 0.5 * (p_end / (c * c + p_end * p_end) + std::atan(p_end / c) / c);
    };
    return boost::math::quadrature::gauss<double, 30>::integrate(
        [&](double u) { return over_p(p.to_m, u) - over_p(p.from_m, u); },
        std::atan(q.from_m),
        std::atan(q.to_m));
}

// A quarter of the lens, cut where the view from a point passes the rectangle's sides, which is
// almost a step if the rectangle is close.
double integral_of(const BeamOptics& optics) {
    using Adaptive = boost::math::quadrature::gauss_kronrod<double, 15>;
    constexpr unsigned kDepth = 6;  // 64 parts of a piece: absurd lenses take seconds
    constexpr double kError = 1e-10;
    const double radius_m = 0.5 * optics.aperture_m;
    const double s = optics.distance_m;
    const double per_height = 1.0 - s / optics.focal_length_m;
    const auto slopes = [&](double height_m, double side_m) {
        const double middle = per_height * height_m / s;
        return Heights{middle - 0.5 * side_m / s, middle + 0.5 * side_m / s};
    };
    // In fractions of an interval, since Boost compares an error that is not multiplied by its
    // length.
    const auto integrate = [&](const auto& f, double from, double to) {
        const double length = to - from;
        const auto part = [&](double u) { return f(from + length * u); };
        return length * Adaptive::integrate(part, 0.0, 1.0, kDepth, kError);
    };
    const auto in_pieces = [&](const auto& f, double most, double cut) {
        if (!(cut < most)) return integrate(f, 0.0, most);
        return integrate(f, 0.0, cut) + integrate(f, cut, most);
    };
    const double end_along_m = 0.5 * optics.along_m / std::abs(per_height);
    const double end_across_m = 0.5 * optics.across_m / std::abs(per_height);
    const auto strip = [&](double t) {
        const Heights p = slopes(radius_m * std::sin(t), optics.along_m);
        const double half_m = radius_m * std::cos(t);
        const auto point = [&](double across_m) {
            return flux_through(p, slopes(across_m, optics.across_m));
        };
        return half_m * in_pieces(point, half_m, end_across_m);
    };
    const double cut = end_along_m < radius_m ? std::asin(end_along_m / radius_m) : kPi;
    return 4.0 * in_pieces(strip, kQuarterTurn, cut);
}

// ---- Windows

// One face, from the index and cosine in front to those behind it: its reflectance, and its
// transmittance per unit of the cosine in front.
struct Face {
    double reflected;
    double let_through_by_cosine;
};

// One polarisation, s; the other one follows by exchanging the cosines.
Face fresnel(double index, double cosine, double index_behind, double cosine_behind) {
    const double sum = index * cosine + index_behind * cosine_behind;
    return {.reflected = square((index * cosine - index_behind * cosine_behind) / sum),
            .let_through_by_cosine = 4.0 * index * index_behind * cosine_behind / square(sum)};
}

Face fresnel_p(double index, double cosine, double index_behind, double cosine_behind) {
    const double sum = index * cosine_behind + index_behind * cosine;
    return {.reflected = square((index * cosine_behind - index_behind * cosine) / sum),
            .let_through_by_cosine = 4.0 * index * index_behind * cosine_behind / square(sum)};
}

// I in water / I in air, for the sine in air.
double window_gain(const BeamWindow& window, double sine) {
    const double n = window.water_index;
    const double g = window.glass_index;
    const double cosine = std::sqrt((1.0 - sine) * (1.0 + sine));
    const double in_glass = std::sqrt(1.0 - square(sine / g));
    const double in_water = std::sqrt(1.0 - square(sine / n));
    // Reflections between the faces: 1 + R R' + (R R')^2 ...
    const auto both = [&](const Face& front, const Face& back) {
        return front.let_through_by_cosine * back.let_through_by_cosine * in_glass /
               (1.0 - front.reflected * back.reflected);
    };
    const double by_cosine =
        0.5 * (both(fresnel(1.0, cosine, g, in_glass), fresnel(g, in_glass, n, in_water)) +
               both(fresnel_p(1.0, cosine, g, in_glass), fresnel_p(g, in_glass, n, in_water)));
    return by_cosine * n * n * in_water;
}

}  // namespace

StrobeSides sides_about(const Vector3d& axis) {
    Vector3d across = axis.cross(Vector3d::UnitX());
    constexpr double kForeAndAft = 1e-6;
    if (across.norm() < kForeAndAft) across = axis.cross(Vector3d::UnitZ());
    across.normalize();
    return {.across = across, .along = across.cross(axis)};
}

TracedBeam::TracedBeam(const Beam& beam, const Vector3d& axis) : beam_(beam), axis_(axis) {
    const StrobeSides sides = sides_about(axis);
    along_ = std::cos(beam.turn_rad) * sides.along + std::sin(beam.turn_rad) * sides.across;
    across_ = axis.cross(along_);
    if (const auto* table = std::get_if<BeamTable>(&beam.pattern)) {
        scale_ = 1.0 / integral_of(*table);
        shines_backwards_ = !beam.window && table->angles == TableAngles::TypeC &&
                            table->vertical_rad.back() > kQuarterTurn;
    } else if (const auto* optics = std::get_if<BeamOptics>(&beam.pattern)) {
        scale_ = 1.0 / integral_of(*optics);
    } else {
        place_cones();
    }
    place_edges();
}

void TracedBeam::place_cones() {
    for (const Cone& cone : beam_.cones) {
        const bool is_soft = cone.edge_rad > 0.0;
        const double flux =
            is_soft ? flux_of_soft(cone) : flux_of_sharp(cone.half_angle_rad, cone.exponent);
        cones_.push_back(
            {.on_axis = beam_.weights == ConeWeights::Flux ? cone.weight / flux : cone.weight,
             .exponent = cone.exponent,
             .cos_edge = std::cos(cone.half_angle_rad),
             .is_soft = is_soft,
             .versine_full = versine(cone.half_angle_rad - cone.edge_rad),
             .versine_none = versine(cone.half_angle_rad)});
    }
}

double TracedBeam::intensity_of_cones(const Vector3d& towards) const {
    const double length = towards.norm();
    const double cosine = towards.dot(axis_) / length;
    if (cosine <= 0.0) return 0.0;
    double axial = 0.0;  // of cones that fall off as the cosine
    double other = 0.0;
    for (const TracedCone& cone : cones_) {
        if (cosine < cone.cos_edge) continue;
        double here = cone.on_axis;
        if (cone.is_soft) {
            const double off_axis = 0.5 * (towards / length - axis_).squaredNorm();
            const double t = std::clamp(
                (cone.versine_none - off_axis) / (cone.versine_none - cone.versine_full), 0.0, 1.0);
            here *= t * t * (3.0 - 2.0 * t);
        }
        if (cone.exponent == 1.0) {
            axial += here;
        } else {
            other += here * std::pow(cosine, cone.exponent);
        }
    }
    return axial * cosine + other;
}

Vector3d TracedBeam::in_lamp(const Vector3d& towards) const {
    return {towards.dot(along_), towards.dot(across_), towards.dot(axis_)};
}

double TracedBeam::intensity_in_air(const Vector3d& towards) const {
    if (const auto* table = std::get_if<BeamTable>(&beam_.pattern)) {
        return scale_ * intensity_of(*table, in_lamp(towards));
    }
    if (const auto* optics = std::get_if<BeamOptics>(&beam_.pattern)) {
        return scale_ * intensity_of(*optics, in_lamp(towards));
    }
    return intensity_of_cones(towards);
}

double TracedBeam::intensity(const Vector3d& towards) const {
    if (!beam_.window) return intensity_in_air(towards);
    const Vector3d unit = towards.normalized();
    const double cos_water = unit.dot(axis_);
    const Vector3d aside = beam_.window->water_index * (unit - cos_water * axis_);
    const double sine = aside.norm();
    if (!(cos_water > 0.0) || !(sine < 1.0)) return 0.0;
    const double cos_air = std::sqrt((1.0 - sine) * (1.0 + sine));
    return window_gain(*beam_.window, sine) * intensity_in_air(aside + cos_air * axis_);
}

// ---- Edges

// Whether light in air reaches the plane across the axis.
bool TracedBeam::reaches_the_plane() const {
    if (const auto* table = std::get_if<BeamTable>(&beam_.pattern)) {
        const auto ends_there = [](const std::vector<double>& angles_rad) {
            return angles_rad.front() <= -kQuarterTurn || angles_rad.back() >= kQuarterTurn;
        };
        return ends_there(table->vertical_rad) ||
               (table->angles != TableAngles::TypeC && ends_there(table->horizontal_rad));
    }
    return std::ranges::any_of(beam_.cones, [](const Cone& cone) {
        return cone.weight > 0.0 && cone.half_angle_rad >= kQuarterTurn;
    });
}

void TracedBeam::place_edges() {
    if (beam_.window && reaches_the_plane()) {
        end_of_window_ = {.centre = axis_,
                          .radius_rad = std::asin(1.0 / beam_.window->water_index)};
    }
    // The directions within an angle from the plane of that side and the axis, on the axis's side
    // of it.
    const auto half_space = [&](const Vector3d& side, double angle_rad) {
        return Cap{.centre = std::sin(angle_rad) * axis_ - std::cos(angle_rad) * side,
                   .radius_rad = kQuarterTurn};
    };
    if (const auto* optics = std::get_if<BeamOptics>(&beam_.pattern)) {
        if (optics->distance_m != optics->focal_length_m) return;
        const double along_rad = std::atan(0.5 * optics->along_m / optics->focal_length_m);
        const double across_rad = std::atan(0.5 * optics->across_m / optics->focal_length_m);
        place_rectangle({half_space(along_, along_rad),
                         half_space(-along_, along_rad),
                         half_space(across_, across_rad),
                         half_space(-across_, across_rad)},
                        {true, true, true, true});
        return;
    }
    const auto* table = std::get_if<BeamTable>(&beam_.pattern);
    if (!table) {
        for (const Cone& cone : beam_.cones) {
            // A cone of 90 degrees ends where its cosine is 0, without a step unless it falls more
            // steeply. Where there is no light, there is no step either.
            constexpr double kRounding = 1e-9;
            const bool ends_before =
                cone.half_angle_rad < kQuarterTurn - kRounding || cone.exponent < 1.0;
            if (ends_before && cone.edge_rad == 0.0 && cone.weight > 0.0) {
                edges_.push_back({.cap = {axis_, cone.half_angle_rad}, .within = {}});
            }
        }
        return;
    }
    const std::size_t last_v = table->vertical_rad.size() - 1;
    const std::size_t last_h = table->horizontal_rad.size() - 1;
    const auto is_lit_at_vertical = [&](std::size_t v) {
        for (std::size_t h = 0; h <= last_h; ++h) {
            if (value_at(*table, h, v) > 0.0) return true;
        }
        return false;
    };
    const auto is_lit_at_horizontal = [&](std::size_t h) {
        for (std::size_t v = 0; v <= last_v; ++v) {
            if (value_at(*table, h, v) > 0.0) return true;
        }
        return false;
    };
    const double from_v = table->vertical_rad.front();
    const double to_v = table->vertical_rad.back();
    if (table->angles == TableAngles::TypeC) {
        if (from_v > 0.0 && is_lit_at_vertical(0)) {
            edges_.push_back({.cap = {-axis_, kPi - from_v}, .within = {}});
        }
        if (to_v < kPi && is_lit_at_vertical(last_v)) {
            edges_.push_back({.cap = {axis_, to_v}, .within = {}});
        }
        return;
    }
    // A's vertical angle and B's horizontal one are latitudes over the equator of a pole, and have
    // no line at 90 degrees; the others are longitudes about it.
    const bool is_a = table->angles == TableAngles::TypeA;
    const Vector3d& pole = is_a ? along_ : across_;
    const Vector3d& side = is_a ? across_ : along_;
    const double from_h = table->horizontal_rad.front();
    const double to_h = table->horizontal_rad.back();
    const double south = is_a ? from_v : from_h;
    const double north = is_a ? to_v : to_h;
    const double west = is_a ? from_h : from_v;
    const double east = is_a ? to_h : to_v;
    const std::array<bool, 2> steps_v{is_lit_at_vertical(0), is_lit_at_vertical(last_v)};
    const std::array<bool, 2> steps_h{is_lit_at_horizontal(0), is_lit_at_horizontal(last_h)};
    const auto& [at_south, at_north] = is_a ? steps_v : steps_h;
    const auto& [at_west, at_east] = is_a ? steps_h : steps_v;
    place_rectangle(
        {Cap{.centre = pole, .radius_rad = kQuarterTurn - south},
         Cap{.centre = -pole, .radius_rad = kQuarterTurn + north},
         half_space(side, east),
         half_space(-side, -west)},
        {at_south && south > -kQuarterTurn, at_north && north < kQuarterTurn, at_east, at_west});
}

void TracedBeam::place_rectangle(const std::array<Cap, 4>& sides,
                                 const std::array<bool, 4>& has_step) {
    for (std::size_t i = 0; i < sides.size(); ++i) {
        if (!has_step.at(i)) continue;
        Edge edge{.cap = sides.at(i), .within = {}};
        for (std::size_t j = 0; j < sides.size(); ++j) {
            if (j != i) edge.within.push_back(sides.at(j));
        }
        edges_.push_back(std::move(edge));
    }
}

// Beyond the window's last angle, the value at that angle. Angles in air grow ever faster outwards.
TracedBeam::Aim TracedBeam::in_air(const Aim& in_water) const {
    const double n = beam_.window->water_index;
    const double off_axis = angle_from_to(in_water.towards, axis_);
    const auto refracted = [&](double angle_rad) {
        return std::asin(std::min(1.0, n * std::sin(std::clamp(angle_rad, 0.0, kQuarterTurn))));
    };
    const double in_air = refracted(off_axis);
    const Vector3d aside = in_water.towards - in_water.towards.dot(axis_) * axis_;
    const double around = n * std::sin(off_axis) < 1.0 ? n * in_water.within_rad : 0.0;
    return {.towards = std::cos(in_air) * axis_ + std::sin(in_air) * aside.stableNormalized(),
            .within_rad = std::max({around,
                                    refracted(off_axis + in_water.within_rad) - in_air,
                                    in_air - refracted(off_axis - in_water.within_rad)})};
}

bool TracedBeam::is_on(const Edge& edge, const std::array<Aim, 2>& aims) {
    const auto beyond = [](const Aim& aim, const Cap& cap) {
        return angle_from_to(aim.towards, cap.centre) - cap.radius_rad;
    };
    const auto is_within_others = [&](const Aim& aim) {
        return std::ranges::all_of(
            edge.within, [&](const Cap& cap) { return beyond(aim, cap) <= aim.within_rad; });
    };
    const auto is_near = [&](const Aim& aim) {
        return std::abs(beyond(aim, edge.cap)) <= aim.within_rad && is_within_others(aim);
    };
    return std::ranges::any_of(aims, is_near) ||
           ((beyond(aims[0], edge.cap) > 0.0) != (beyond(aims[1], edge.cap) > 0.0) &&
            std::ranges::any_of(aims, is_within_others));
}

bool TracedBeam::is_on_edge(const std::array<Vector3d, 2>& towards, double within_rad) const {
    std::array<Aim, 2> aims{Aim{towards[0], within_rad}, Aim{towards[1], within_rad}};
    if (end_of_window_ && is_on({.cap = *end_of_window_, .within = {}}, aims)) return true;
    if (edges_.empty()) return false;
    if (beam_.window) aims = {in_air(aims[0]), in_air(aims[1])};
    return std::ranges::any_of(edges_, [&](const Edge& edge) { return is_on(edge, aims); });
}

// The circle crosses a cap's rim where r cos(x - x_0) = cos(radius).
void TracedBeam::add_crossings(const Vector3d& e,
                               const Vector3d& u,
                               std::vector<double>& x_rad) const {
    const auto add = [&](const Cap& cap) {
        const double by_e = cap.centre.dot(e);
        const double by_u = cap.centre.dot(u);
        const double cosine = std::cos(cap.radius_rad) / std::hypot(by_e, by_u);
        if (!(std::abs(cosine) < 1.0)) return;
        for (const double off : {-std::acos(cosine), std::acos(cosine)})
            x_rad.push_back(std::remainder(std::atan2(by_u, by_e) + off, 2.0 * kPi));
    };
    const auto add_ring = [&](double in_air_rad) {
        if (!beam_.window) return add({axis_, in_air_rad});
        if (in_air_rad <= kQuarterTurn)
            add({axis_, std::asin(std::sin(in_air_rad) / beam_.window->water_index)});
    };
    add({axis_, kQuarterTurn});
    if (end_of_window_) add(*end_of_window_);
    if (!beam_.window) {
        for (const Edge& edge : edges_) add(edge.cap);
    }
    if (const auto* table = std::get_if<BeamTable>(&beam_.pattern)) {
        if (table->angles == TableAngles::TypeC) {
            for (const double row_rad : table->vertical_rad) add_ring(row_rad);
        }
    } else if (std::holds_alternative<std::monostate>(beam_.pattern)) {
        for (const Cone& cone : beam_.cones) {
            add_ring(cone.half_angle_rad);
            if (cone.edge_rad > 0.0) add_ring(cone.half_angle_rad - cone.edge_rad);
        }
    }
}

// ---- Steepness

namespace {

constexpr double kStep = kPi / 180.0;

// Directions about a degree apart, out to an angle off the axis.
template <typename Visit>
void visit_directions(const Vector3d& axis, double widest_rad, const Visit& visit) {
    const StrobeSides sides = sides_about(axis);
    const auto rings = static_cast<int>(std::round(widest_rad / kStep));
    for (int ring = 0; ring < rings; ++ring) {
        const double off_axis = (ring + 0.5) * kStep;
        const auto spokes = static_cast<int>(std::ceil(2.0 * kPi * std::sin(off_axis) / kStep));
        for (int spoke = 0; spoke < spokes; ++spoke) {
            const double around = 2.0 * kPi * spoke / spokes;
            visit(Vector3d(std::cos(off_axis) * axis +
                           std::sin(off_axis) *
                               (std::cos(around) * sides.along + std::sin(around) * sides.across)));
        }
    }
}

}  // namespace

// Where the lamp moves by e across the axis, the direction turns by |e|/d about the axis, and by
// |e| cos(theta)/d away from it. cos^n then has the slope n sin(theta), and a curvature of at most
// n^2 + n.
double TracedBeam::steepness_at(const Vector3d& towards, double most) const {
    const double here = intensity(towards);
    const double share_of = std::max(here, kDimmest * most);
    const Vector3d around = axis_.cross(towards).normalized();
    const Vector3d outwards = around.cross(towards);
    double n = 0.0;
    for (const auto& [way, turned] :
         {std::pair(around, 1.0), std::pair(outwards, std::abs(towards.dot(axis_)))}) {
        const double before = intensity(std::cos(kStep) * towards - std::sin(kStep) * way);
        const double after = intensity(std::cos(kStep) * towards + std::sin(kStep) * way);
        const double slope = turned * std::abs(after - before) / (2.0 * kStep * share_of);
        const double bend =
            square(turned / kStep) * std::abs(after - 2.0 * here + before) / share_of;
        n = std::max({n, slope, std::sqrt(0.25 + bend) - 0.5});
    }
    return n;
}

double TracedBeam::steepness() const {
    const bool has_pattern = !std::holds_alternative<std::monostate>(beam_.pattern);
    const bool is_soft =
        std::ranges::any_of(cones_, [](const TracedCone& cone) { return cone.is_soft; });
    double n = 0.0;
    if (!has_pattern && !beam_.window && !is_soft) {
        for (const TracedCone& cone : cones_) n = std::max(n, cone.exponent);
        return n;
    }
    const double widest_rad = shines_backwards_ ? kPi : kQuarterTurn;
    double most = 0.0;
    visit_directions(axis_, widest_rad, [&](const Vector3d& towards) {
        most = std::max(most, intensity(towards));
    });
    if (most == 0.0) return n;
    constexpr double kReach = 1.5 * kStep;
    visit_directions(axis_, widest_rad, [&](const Vector3d& towards) {
        if (!is_on_edge({towards, towards}, kReach)) n = std::max(n, steepness_at(towards, most));
    });
    return n;
}

}  // namespace aphotic
