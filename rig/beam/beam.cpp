// SPDX-License-Identifier: BSD-3-Clause
#include "rig/beam/beam.h"

#include "base/sha256.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/Geometry>
#include <boost/math/quadrature/gauss.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aphotic {

using Eigen::Vector3d;

namespace {

constexpr double kRightAngle_rad = 0.5 * std::numbers::pi;

template <class... Fs>
struct Cases : Fs... {
    using Fs::operator()...;
};
template <class... Fs>
Cases(Fs...) -> Cases<Fs...>;

bool is_pattern(const Beam& beam) {
    return !std::holds_alternative<std::monostate>(beam.pattern);
}

bool has_step(const Cone& cone) {
    const bool ends_smoothly = cone.half_angle_rad >= kRightAngle_rad && cone.exponent >= 1.0;
    return cone.weight > 0.0 && cone.edge_rad == 0.0 && !ends_smoothly;
}

// cos^n of a non-negative cosine.
double falloff(double cosine, double exponent) {
    return exponent == 1.0 ? cosine : std::pow(cosine, exponent);
}

// POV-Ray's own curve, from a spotlight's falloff to its radius.
double smooth_step(double cosine, double none, double full) {
    const double t = std::clamp((cosine - none) / (full - none), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// S.
double soft_edge(const Cone& cone, double cosine) {
    if (cone.edge_rad == 0.0) return 1.0;
    return smooth_step(
        cosine, std::cos(cone.half_angle_rad), std::cos(cone.half_angle_rad - cone.edge_rad));
}

// The integral of cos^n(theta) up to an angle. 1 - cos^(n + 1) is a small difference for narrow
// cones: expm1 and log1p preserve its digits.
double cone_flux(double half_angle_rad, double exponent) {
    if (exponent == 1.0) {
        const double sin_gamma = std::sin(half_angle_rad);
        return std::numbers::pi * sin_gamma * sin_gamma;
    }
    const double sin_half = std::sin(0.5 * half_angle_rad);
    const double ln_cos = std::log1p(-2.0 * sin_half * sin_half);
    const double n = exponent + 1.0;
    return -2.0 * std::numbers::pi / n * std::expm1(n * ln_cos);
}

// The integral for the cone cos^n(theta) S(theta). Over the angle, because cos^n of a soft edge
// that reaches 90 degrees has unbounded derivatives in the cosine.
double cone_flux(const Cone& cone) {
    if (cone.edge_rad == 0.0) return cone_flux(cone.half_angle_rad, cone.exponent);
    using Gauss = boost::math::quadrature::gauss<double, 30>;
    const double full_rad = cone.half_angle_rad - cone.edge_rad;
    const auto ring = [&](double theta_rad) {
        const double cosine = std::max(0.0, std::cos(theta_rad));
        return 2.0 * std::numbers::pi * std::sin(theta_rad) * falloff(cosine, cone.exponent) *
               soft_edge(cone, cosine);
    };
    return cone_flux(full_rad, cone.exponent) +
           Gauss::integrate(ring, full_rad, cone.half_angle_rad);
}

// A_k.
double axial_intensity(const Cone& cone, ConeWeights weights) {
    return weights == ConeWeights::Literal ? cone.weight : cone.weight / cone_flux(cone);
}

Vector3d turned(const Beam& beam, const BeamFrame& frame, const Vector3d& towards) {
    const double x = frame.along.dot(towards);
    const double y = frame.across.dot(towards);
    if (beam.turn_rad == 0.0) return {x, y, frame.axis.dot(towards)};
    const double c = std::cos(beam.turn_rad);
    const double s = std::sin(beam.turn_rad);
    return {c * x + s * y, c * y - s * x, frame.axis.dot(towards)};
}

// Beyond the directions that a window transmits, the last of them is used.
PatternView view_of(const Beam& beam, const Vector3d& direction) {
    if (!beam.window) return {.direction = direction};
    if (const auto found = in_air(*beam.window, direction))
        return {found->direction, found->factor};
    const Vector3d grazing = Vector3d(direction.x(), direction.y(), 0.0).normalized();
    return {.direction = grazing, .factor = window_factor(*beam.window, 0.0)};
}

bool is_let_out(const Beam& beam, const Vector3d& direction) {
    return !beam.window || in_air(*beam.window, direction).has_value();
}

double of_cones(const Beam& beam, double cos_theta, double cos_from) {
    if (cos_theta <= 0.0) return 0.0;
    double intensity = 0.0;
    for (const Cone& cone : beam.cones) {
        if (cone.edge_rad == 0.0 && cos_from < std::cos(cone.half_angle_rad)) continue;
        intensity += axial_intensity(cone, beam.weights) * falloff(cos_theta, cone.exponent) *
                     soft_edge(cone, cos_theta);
    }
    return intensity;
}

bool is_within(const std::vector<double>& range, double angle) {
    return angle >= range.front() && angle <= range.back();
}

// A table's direction moved into the range of its angles.
Vector3d into_table(const BeamTable& table, const Vector3d& direction) {
    GoniometerAngles at = angles_of(table.angles, direction);
    at.vertical_rad =
        std::clamp(at.vertical_rad, table.vertical_rad.front(), table.vertical_rad.back());
    if (table.horizontal_rad.size() > 1) {
        at.horizontal_rad = std::clamp(
            at.horizontal_rad, table.horizontal_rad.front(), table.horizontal_rad.back());
    }
    return direction_at(table.angles, at);
}

bool is_in_table(const BeamTable& table, const Vector3d& direction) {
    const GoniometerAngles at = angles_of(table.angles, direction);
    return is_within(table.vertical_rad, at.vertical_rad) &&
           (table.horizontal_rad.size() == 1 || is_within(table.horizontal_rad, at.horizontal_rad));
}

// Continues past a line at which the table ends with a step; a table that ends at 0 continues as 0.
bool is_beyond_edge(const BeamTable& table, const Vector3d& direction) {
    const GoniometerAngles at = angles_of(table.angles, direction);
    return std::ranges::any_of(edges_of(table), [&](const TableEdge& edge) {
        const bool is_vertical = edge.angle == TableAngle::Vertical;
        const double angle = is_vertical ? at.vertical_rad : at.horizontal_rad;
        const double first = (is_vertical ? table.vertical_rad : table.horizontal_rad).front();
        return edge.at_rad == first ? angle < first : angle > edge.at_rad;
    });
}

double of_pattern(const Beam& beam, const Vector3d& towards, const Vector3d& from) {
    return std::visit(
        Cases{[&](std::monostate) {
                  return of_cones(beam, towards.z() / towards.norm(), from.z() / from.norm());
              },
              [&](const BeamTable& table) {
                  if (is_in_table(table, from))
                      return beam.per_flux * table_intensity(table, into_table(table, towards));
                  return is_beyond_edge(table, from)
                             ? 0.0
                             : beam.per_flux * table_intensity(table, towards);
              },
              [&](const BeamOptics& optics) {
                  if (!is_focused(optics)) return beam.per_flux * optics_intensity(optics, towards);
                  if (!is_within_image(optics, from)) return 0.0;
                  return beam.per_flux * endless_intensity(optics, towards);
              }},
        beam.pattern);
}

double most_of_cones(const Beam& beam, double nearest_rad) {
    const double cosine = std::max(0.0, std::cos(nearest_rad));
    double intensity = 0.0;
    for (const Cone& cone : beam.cones) {
        if (nearest_rad > cone.half_angle_rad) continue;
        intensity += axial_intensity(cone, beam.weights) * falloff(cosine, cone.exponent) *
                     soft_edge(cone, cosine);
    }
    return intensity;
}

// A cone in air that contains a cone of directions in water, and the bound of the window's factor.
struct PatternCone {
    Vector3d direction;
    double nearest_rad = 0.0;  // to the axis
    double within_rad = 0.0;
    double factor = 1.0;
};

// Empty where the window transmits nothing. In air, by sin(theta) = n sin(theta_w), the azimuthal
// part of a displacement grows n times; in water it is at most pi/2 times the angle.
std::optional<PatternCone> cone_of(const Beam& beam, const Vector3d& direction, double within_rad) {
    const double theta_rad = angle_between(Vector3d::UnitZ(), direction);
    const double nearest_rad = std::max(0.0, theta_rad - within_rad);
    if (!beam.window) return PatternCone{direction, nearest_rad, within_rad, 1.0};
    const BeamWindow& window = *beam.window;
    const double widest_rad = widest_in_water_rad(window);
    if (nearest_rad > widest_rad) return std::nullopt;
    const double middle_rad = angle_in_air_rad(window, std::min(theta_rad, widest_rad));
    const double near_rad = angle_in_air_rad(window, nearest_rad);
    const double far_rad = angle_in_air_rad(window, std::min(theta_rad + within_rad, widest_rad));
    const double along_rad = std::max(far_rad - middle_rad, middle_rad - near_rad);
    const double around_rad = window.water_index * kRightAngle_rad * within_rad;
    return PatternCone{.direction = view_of(beam, direction).direction,
                       .nearest_rad = near_rad,
                       .within_rad = std::min(std::numbers::pi, along_rad + around_rad),
                       .factor = window_factor(window, std::max(0.0, std::cos(far_rad)))};
}

// Angles off the axis at which the light of a ring is not smooth: cones' edges and a table's rows.
// Some more are added for patterns with lines of other shapes.
std::vector<double> breaks_rad(const Beam& beam) {
    constexpr int kPieces = 45;
    std::vector<double> breaks{0.0, kRightAngle_rad};
    for (const Cone& cone : beam.cones) {
        breaks.push_back(cone.half_angle_rad - cone.edge_rad);
        breaks.push_back(cone.half_angle_rad);
    }
    if (const auto* table = std::get_if<BeamTable>(&beam.pattern)) {
        for (const double row_rad : table->vertical_rad) {
            if (row_rad > 0.0 && row_rad < kRightAngle_rad) breaks.push_back(row_rad);
        }
    }
    for (int i = 1; i < kPieces; ++i) breaks.push_back(i * kRightAngle_rad / kPieces);
    std::ranges::sort(breaks);
    return breaks;
}

// The window's transmission: the integral of T I over directions in air. 720 equal steps in
// azimuth, exact for tables of whole degrees.
double flux_through_window(const Beam& beam) {
    using Gauss = boost::math::quadrature::gauss<double, 20>;
    const int turns = is_pattern(beam) ? 720 : 1;
    const auto ring = [&](double theta_rad) {
        const double cosine = std::cos(theta_rad);
        const double sine = std::sin(theta_rad);
        double sum = 0.0;
        for (int j = 0; j < turns; ++j) {
            const double phi_rad = 2.0 * std::numbers::pi * j / turns;
            const Vector3d direction(sine * std::cos(phi_rad), sine * std::sin(phi_rad), cosine);
            sum += of_pattern(beam, direction, direction);
        }
        return 2.0 * std::numbers::pi * sine * sum / turns * cosine *
               transmittance_by_cosine(*beam.window, cosine);
    };
    const std::vector<double> breaks = breaks_rad(beam);
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
        if (breaks[i] < breaks[i + 1]) sum += Gauss::integrate(ring, breaks[i], breaks[i + 1]);
    }
    return sum;
}

// From the relative slope and curvature of I in all directions of a grid.
double steepest_by_grid(const Beam& beam) {
    constexpr double kStep_rad = std::numbers::pi / 180.0;
    constexpr int kRings = 90;
    constexpr int kTurns = 24;
    const BeamFrame frame{Vector3d::UnitZ(), Vector3d::UnitX(), Vector3d::UnitY()};
    const double least = kDimBeamShare * most_intensity(beam);
    double steepest = 0.0;
    const int turns = is_pattern(beam) ? kTurns : 1;
    for (int i = 0; i < kRings; ++i) {
        for (int j = 0; j < turns; ++j) {
            const double theta_rad = i * kStep_rad;
            const double phi_rad = 2.0 * std::numbers::pi * j / turns;
            const Vector3d radial(std::cos(phi_rad), std::sin(phi_rad), 0.0);
            const Vector3d middle =
                std::sin(theta_rad) * radial + std::cos(theta_rad) * Vector3d::UnitZ();
            const Vector3d outwards =
                std::cos(theta_rad) * radial - std::sin(theta_rad) * Vector3d::UnitZ();
            const double here = intensity_towards(beam, frame, middle);
            if (here < least) continue;
            for (const Vector3d& way : {outwards, Vector3d(middle.cross(outwards))}) {
                const Vector3d step = std::tan(kStep_rad) * way;
                const double up = continued_intensity(beam, frame, middle + step, middle);
                const double down = continued_intensity(beam, frame, middle - step, middle);
                const double slope = std::abs(up - down) / (2.0 * kStep_rad * here);
                const double bend =
                    std::abs(up - 2.0 * here + down) / (kStep_rad * kStep_rad * here);
                steepest = std::max({steepest, slope, std::sqrt(bend)});
            }
        }
    }
    return steepest;
}

}  // namespace

Beam scaled_to_flux(Beam beam) {
    std::visit(Cases{[&](std::monostate) { beam.per_flux = 1.0; },
                     [&](const BeamTable& table) { beam.per_flux = 1.0 / table_flux(table); },
                     [&](const BeamOptics& optics) { beam.per_flux = 1.0 / optics_flux(optics); }},
               beam.pattern);
    return beam;
}

double angle_between(const Vector3d& a, const Vector3d& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

double intensity_towards(const Beam& beam, const BeamFrame& frame, const Vector3d& towards) {
    const auto view = pattern_view(beam, frame, towards);
    if (!view) return 0.0;
    const Vector3d& direction = view->direction;
    const double intensity =
        std::visit(Cases{[&](std::monostate) {
                             const double cosine = direction.z() / direction.norm();
                             return of_cones(beam, cosine, cosine);
                         },
                         [&](const BeamTable& table) {
                             return beam.per_flux * table_intensity(table, direction);
                         },
                         [&](const BeamOptics& optics) {
                             return beam.per_flux * optics_intensity(optics, direction);
                         }},
                   beam.pattern);
    return view->factor * intensity;
}

std::optional<PatternView> pattern_view(const Beam& beam,
                                        const BeamFrame& frame,
                                        const Vector3d& towards) {
    const Vector3d direction = turned(beam, frame, towards);
    if (!beam.window) return PatternView{.direction = direction};
    const auto found = in_air(*beam.window, direction);
    if (!found) return std::nullopt;
    return PatternView{.direction = found->direction, .factor = found->factor};
}

double continued_intensity(const Beam& beam,
                           const BeamFrame& frame,
                           const Vector3d& towards,
                           const Vector3d& from) {
    const Vector3d local_from = turned(beam, frame, from);
    if (!is_let_out(beam, local_from)) return 0.0;
    const PatternView view = view_of(beam, turned(beam, frame, towards));
    return view.factor * of_pattern(beam, view.direction, view_of(beam, local_from).direction);
}

double most_intensity(const Beam& beam,
                      const BeamFrame& frame,
                      const Vector3d& towards,
                      double within_rad) {
    const auto cone = cone_of(beam, turned(beam, frame, towards), within_rad);
    if (!cone) return 0.0;
    const double most =
        std::visit(Cases{[&](std::monostate) { return most_of_cones(beam, cone->nearest_rad); },
                         [&](const BeamTable& table) {
                             return beam.per_flux *
                                    most_table_intensity(table, cone->direction, cone->within_rad);
                         },
                         [&](const BeamOptics& optics) {
                             return beam.per_flux * most_optics_intensity(
                                                        optics, cone->direction, cone->within_rad);
                         }},
                   beam.pattern);
    return cone->factor * most;
}

double most_intensity(const Beam& beam) {
    const double most = std::visit(
        Cases{[&](std::monostate) { return most_of_cones(beam, 0.0); },
              [&](const BeamTable& table) { return beam.per_flux * largest_intensity(table); },
              [&](const BeamOptics& optics) {
                  return beam.per_flux * most_optics_intensity(optics);
              }},
        beam.pattern);
    return beam.window ? most * window_factor(*beam.window, 0.0) : most;
}

bool reaches(const Beam& beam, const BeamFrame& frame, const Vector3d& towards, double within_rad) {
    return most_intensity(beam, frame, towards, within_rad) > 0.0;
}

bool is_dark(const Beam& beam) {
    return !is_pattern(beam) &&
           std::ranges::all_of(beam.cones, [](const Cone& cone) { return cone.weight == 0.0; });
}

std::vector<double> edges_rad(const Beam& beam) {
    std::vector<double> edges;
    for (const Cone& cone : beam.cones) {
        if (has_step(cone)) edges.push_back(cone.half_angle_rad);
    }
    if (const auto* table = std::get_if<BeamTable>(&beam.pattern)) {
        if (table->angles == TableAngles::TypeC) {
            for (const TableEdge& edge : edges_of(*table)) edges.push_back(edge.at_rad);
        }
    }
    if (!beam.window) return edges;
    for (double& edge : edges) edge = angle_in_water_rad(*beam.window, edge);
    edges.push_back(widest_in_water_rad(*beam.window));
    return edges;
}

bool has_rim(const Beam& beam) {
    if (const auto* optics = std::get_if<BeamOptics>(&beam.pattern)) return is_focused(*optics);
    const auto* table = std::get_if<BeamTable>(&beam.pattern);
    return table != nullptr && table->angles != TableAngles::TypeC && !edges_of(*table).empty();
}

bool is_within_rim(const Beam& beam, const BeamFrame& frame, const Vector3d& towards) {
    const Vector3d local = turned(beam, frame, towards);
    if (!is_let_out(beam, local)) return false;
    const Vector3d direction = view_of(beam, local).direction;
    if (const auto* optics = std::get_if<BeamOptics>(&beam.pattern)) {
        return is_within_image(*optics, direction);
    }
    const auto* table = std::get_if<BeamTable>(&beam.pattern);
    return table != nullptr && is_in_table(*table, direction);
}

double steepest_exponent(const Beam& beam) {
    const auto is_sharp = [](const Cone& cone) { return cone.edge_rad == 0.0; };
    if (is_pattern(beam) || beam.window || !std::ranges::all_of(beam.cones, is_sharp))
        return steepest_by_grid(beam);
    double steepest = 0.0;
    for (const Cone& cone : beam.cones) steepest = std::max(steepest, cone.exponent);
    return steepest;
}

double flux_of(const Beam& beam) {
    if (beam.window) return flux_through_window(beam);
    if (is_pattern(beam)) return 1.0;  // per_flux accounts for it
    double flux = 0.0;
    for (const Cone& cone : beam.cones) {
        flux += beam.weights == ConeWeights::Flux ? cone.weight : cone.weight * cone_flux(cone);
    }
    return flux;
}

std::vector<Beam> parts_of(const Beam& beam) {
    if (is_pattern(beam)) return {beam};
    std::vector<Beam> parts;
    for (const Cone& cone : beam.cones) {
        parts.push_back(beam);
        parts.back().name = cone.part;
        parts.back().cones = {cone};
    }
    return parts;
}

Beam parts_that(const Beam& beam, const std::function<bool(const Beam&)>& is_wanted) {
    if (is_pattern(beam) && is_wanted(beam)) return beam;
    Beam kept{.name = beam.name, .weights = beam.weights, .cones = {}, .window = beam.window};
    for (const Beam& part : parts_of(beam)) {
        if (!is_pattern(part) && is_wanted(part)) kept.cones.push_back(part.cones.front());
    }
    return kept;
}

std::vector<ConeLight> cone_lights(const Beam& beam) {
    std::vector<ConeLight> lights;
    if (is_pattern(beam)) return lights;
    lights.reserve(beam.cones.size());
    for (const Cone& cone : beam.cones) {
        const double full_rad = cone.half_angle_rad - cone.edge_rad;
        lights.push_back({.on_axis = axial_intensity(cone, beam.weights),
                          .exponent = cone.exponent,
                          .edge_cosine = std::cos(cone.half_angle_rad),
                          .full_cosine = cone.edge_rad > 0.0 ? std::cos(full_rad) : -1.0});
    }
    return lights;
}

std::string beam_signature(const Beam& beam) {
    // Names every field, here and below: a new field must be added.
    const auto& [name, weights, beam_cones, pattern, per_flux, turn_rad, window] = beam;
    std::vector<std::string> parts;
    for (const Cone& cone : beam_cones) {
        const auto& [part, half_angle_rad, weight, exponent, edge_rad] = cone;
        parts.push_back(
            fmt::format("{} rad {} 1/sr", half_angle_rad, axial_intensity(cone, weights)));
        if (exponent != 1.0) parts.back() += fmt::format(" cos^{}", exponent);
        if (edge_rad != 0.0) parts.back() += fmt::format(" soft {}", edge_rad);
    }
    if (const auto* table = std::get_if<BeamTable>(&pattern)) {
        const auto& [angles, vertical_rad, horizontal_rad, intensity] = *table;
        const std::string numbers = fmt::format("{} {} {}",
                                                fmt::join(vertical_rad, " "),
                                                fmt::join(horizontal_rad, " "),
                                                fmt::join(intensity, " "));
        parts.push_back(
            fmt::format("beam of a table of type {}, {} x {} directions, SHA-256 {}, times {}",
                        "ABC"[static_cast<std::size_t>(angles)],
                        vertical_rad.size(),
                        horizontal_rad.size(),
                        sha256_of_text(numbers),
                        per_flux));
    }
    if (const auto* optics = std::get_if<BeamOptics>(&pattern)) {
        const auto& [along_m, across_m, focal_length_m, distance_m, aperture_m] = *optics;
        parts.push_back(fmt::format("beam of optics {} {} {} {} {} m",
                                    along_m,
                                    across_m,
                                    focal_length_m,
                                    distance_m,
                                    aperture_m));
    }
    if (turn_rad != 0.0) parts.push_back(fmt::format("turned {}", turn_rad));
    if (window) {
        const auto& [glass_index, water_index] = *window;
        parts.push_back(fmt::format("window {} {}", glass_index, water_index));
    }
    return fmt::format("{}{}", is_pattern(beam) ? "" : "cones ", fmt::join(parts, ", "));
}

}  // namespace aphotic
