// SPDX-License-Identifier: BSD-3-Clause
#include "validation/tracer.h"

#include "base/error.h"
#include "base/parallel.h"
#include "spectral/refractive_index.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace aphotic {

using Eigen::ArrayXd;
using Eigen::Vector3d;

namespace {

// The world's vertical in the sled's frame: pitch about starboard, then roll about forward,
// both undone.
WideVector vertical(const Sled& sled) {
    const Eigen::AngleAxis<long double> pitch(sled.pitch_rad, WideVector::UnitY());
    const Eigen::AngleAxis<long double> roll(sled.roll_rad, WideVector::UnitX());
    return (pitch * roll).inverse() * WideVector::UnitZ();
}

double sight_error_rad(const Camera& camera) {
    if (camera.lens) return kEdgeThroughLensRad;
    return camera.port ? kEdgeBehindPortRad : kEdgeRad;
}

// The second derivative of a lamp's light by its place in the emitter's plane, relative to the
// light and in units of 1/d^2. With e the direction in which the lamp moves, c = e.v the cosine to
// the ray v and s = e.n the rise over the surface, cos(theta) d does not change, cos(i) d grows by
// s, and
//
//   f''/f = (c^2 (M^2 + M + m) - M) / d^2 + 2 s c M / (d h),   M = m + K d,  m = n + 3
//
// for a beam that falls as cos^n: k^2 + 9 k + 24 and k + 4 for n = 1. On a floor at height h below
// the lamp, that is at most ((M - 1)^2 + m - 1) / h^2 with k = K h, straight below a vertical
// emitter; on any surface at distance d, at most M^2 + m with s = 0. Both sides of an emitter
// together have no more than one, since their c^2 add up to at most 1. A highlight, cos^n of an
// angle that changes by 1/d, has a curvature of n at its top in both directions, and on its flank a
// slope of at most (n/e)^(1/2), which counts twice with the light's own slope M.
double bend_of_light(double k, double n, bool is_floor, double phong_size) {
    const double m = is_floor ? n + 2.0 : n + 3.0;
    const double diffuse = (k + 2.0 * m) * k + m * (m + 1.0);
    const double flank = std::sqrt(phong_size / std::numbers::e);
    return diffuse + 2.0 * phong_size + 2.0 * flank * (k + (n + 3.0));
}

// Places on an emitter, in shares of its sides from its middle.
constexpr std::array<std::array<double, 2>, 5> kCornersAndMiddle{
    {{0.0, 0.0}, {-0.5, -0.5}, {-0.5, 0.5}, {0.5, -0.5}, {0.5, 0.5}}};

// In shares of its sides from its middle.
Vector3d place_on_emitter(const Strobe& strobe, double x, double y) {
    if (!strobe.emitter) return strobe.position_m;
    const StrobeSides sides = sides_about(strobe.axis);
    return strobe.position_m + x * strobe.emitter->across_m * sides.across +
           y * strobe.emitter->along_m * sides.along;
}

}  // namespace

Tracer::Tracer(const Rig& rig, const TraceOptions& options)
    : rig_(rig),
      water_(rig.water),
      options_(options),
      lens_(rig.camera.lens ? std::optional<TracedLens>(*rig.camera.lens) : std::nullopt),
      pixel_rad_(widest_pixel_rad()),
      sight_error_rad_(sight_error_rad(rig.camera)),
      exact_down_(vertical(rig.sled)),
      down_(exact_down_.cast<double>()) {
    for (const Strobe& strobe : rig_.strobes) beams_.emplace_back(strobe.beam, strobe.axis);
    surfaces_.push_back({.reflectance = rig_.seafloor.reflectance,
                         .phong = rig_.seafloor.phong,
                         .phong_size = rig_.seafloor.phong_size});
    for (const Object& object : rig_.objects) {
        surfaces_.push_back({.reflectance = object.reflectance,
                             .phong = object.phong,
                             .phong_size = object.phong_size});
        shapes_.emplace_back(object.shape);
    }
    tabulate_spectra();
    place_lamps();
}

void Tracer::place_lamps() {
    for (std::size_t s = 0; s < rig_.strobes.size(); ++s) {
        const EmitterLamps lamps = lamps_of(s);
        for (int j = 0; j < lamps.along; ++j) {
            for (int i = 0; i < lamps.across; ++i) {
                lamps_.push_back({.strobe = s,
                                  .position_m = place_on_emitter(
                                      rig_.strobes[s],
                                      (2 * i + 1 - lamps.across) / (2.0 * lamps.across),
                                      (2 * j + 1 - lamps.along) / (2.0 * lamps.along))});
            }
        }
        grids_.push_back(lamps);
        lamps_of_strobe_.push_back(static_cast<double>(lamps.across) * lamps.along);
    }
    place_edges();
}

// Small enough for the midpoint rule, whose error is h^2/24 of the second derivative, to achieve
// kEmitterError at distance d: at every plane, and in the signals by each wavelength's share in
// them. The shares are those on the shortest path, since on longer paths wavelengths of stronger
// attenuation have less.
double Tracer::spacing_m(std::size_t s, double d_m, bool is_floor) const {
    double phong_size = 0.0;
    for (const Surface& surface : surfaces_) {
        if (surface.phong > 0.0) phong_size = std::max(phong_size, surface.phong_size);
    }
    const double n = beams_[s].steepness();
    const ArrayXd depth = attenuation_per_m_ * d_m;
    const ArrayXd bend =
        depth.unaryExpr([&](double k) { return bend_of_light(k, n, is_floor, phong_size); });
    const auto grid = static_cast<Eigen::Index>(signal_nodes_);
    // Lamps 3.5 mm apart per metre of distance: the steps of a cone's edge are as fine as the
    // lamps.
    constexpr double kLeastBend = 40.0;
    double most = std::max(kLeastBend, bend_of_light(0.0, n, is_floor, phong_size));
    if (bend.size() > grid) most = std::max(most, bend.tail(bend.size() - grid).maxCoeff());
    const auto take_in = [&](const ArrayXd& light) {
        const ArrayXd left = light.head(grid) * light_left(depth.head(grid));
        for (Eigen::Index c = 0; c < weights_.cols() && grid > 0; ++c) {
            const ArrayXd share = weights_.col(c).abs() * left;
            const double all = share.sum();
            if (all > 0.0) most = std::max(most, (share * bend.head(grid)).sum() / all);
        }
    };
    for (const ArrayXd& light : diffuse_[s]) take_in(light);
    take_in(specular_[s]);
    return d_m * std::sqrt(24.0 * kEmitterError / most);
}

EmitterLamps Tracer::lamps_of(std::size_t s) const {
    const Strobe& strobe = rig_.strobes[s];
    if (!strobe.emitter) return {};
    if (!options_.rendered_lamps.empty()) return options_.rendered_lamps.at(s);
    double height_m = std::numeric_limits<double>::infinity();
    double object_m = std::numeric_limits<double>::infinity();
    for (const auto& [x, y] : kCornersAndMiddle) {
        const Vector3d place_m = place_on_emitter(strobe, x, y);
        height_m = std::min(height_m, this->height_m(place_m));
        for (const TracedShape& shape : shapes_) {
            object_m = std::min(object_m, shape.least_distance_m(place_m));
        }
    }
    double apart_m = height_m > 0.0 ? spacing_m(s, height_m, true) : 0.0;
    if (std::isfinite(object_m)) apart_m = std::min(apart_m, spacing_m(s, object_m, false));
    constexpr double kMostLamps = 1e5;
    const auto along_side = [&](int asked, double side_m) {
        if (asked > 0) return asked;
        if (side_m == 0.0) return 1;
        return static_cast<int>(std::clamp(std::ceil(side_m / apart_m), 1.0, kMostLamps + 1.0));
    };
    const EmitterLamps lamps{.across = along_side(options_.lamps_across, strobe.emitter->across_m),
                             .along = along_side(options_.lamps_along, strobe.emitter->along_m)};
    if (static_cast<double>(lamps.across) * lamps.along > kMostLamps) {
        throw InputError(
            "strobe '{}': its emitter needs {} x {} lamps to trace; allowed: {:.0f}. It is too "
            "large for its distance to the floor or an object, or for its water",
            strobe.name,
            lamps.across,
            lamps.along,
            kMostLamps);
    }
    return lamps;
}

// Given lamps are points, each with its own edges and shadows; otherwise edges are those of the
// whole emitter, which the lamps only sample.
void Tracer::place_edges() {
    if (!options_.rendered_lamps.empty()) {
        rim_lamps_ = lamps_;
        for (const Lamp& lamp : lamps_) {
            apexes_.push_back(
                {.strobe = lamp.strobe, .position_m = lamp.position_m, .reach_m = 0.0});
        }
        return;
    }
    for (std::size_t s = 0; s < rig_.strobes.size(); ++s) {
        const Strobe& strobe = rig_.strobes[s];
        double reach_m = 0.0;
        if (strobe.emitter) {
            reach_m = 0.5 * std::hypot(strobe.emitter->across_m, strobe.emitter->along_m);
            for (const double x : {-0.5, 0.5}) {
                for (const double y : {-0.5, 0.5}) {
                    rim_lamps_.push_back(
                        {.strobe = s, .position_m = place_on_emitter(strobe, x, y)});
                }
            }
        } else {
            rim_lamps_.push_back({.strobe = s, .position_m = strobe.position_m});
        }
        apexes_.push_back({.strobe = s, .position_m = strobe.position_m, .reach_m = reach_m});
    }
}

// The indices of glass and water, relative to air; without a port there is no refraction.
Tracer::Index Tracer::index_at(double lambda_nm) const {
    if (!rig_.camera.port) return {.glass = 1.0, .water = 1.0};
    return {.glass = rig_.camera.port->glass.index(lambda_nm),
            .water = seawater_index(lambda_nm, rig_.water.salinity_psu, rig_.water.temperature_c)};
}

// The lights of this rig: paths from the shortest to the longest that the image sees, with a margin
// on both sides.
std::vector<WeightedWavelength> Tracer::spectrum_in_view() const {
    constexpr int kSteps = 16;
    constexpr double kRoom = 1.05;
    LightFamily family{.sources = {},
                       .water = rig_.water,
                       .shortest_path_m = std::numeric_limits<double>::infinity(),
                       .longest_path_m = 0.0,
                       .tilt = std::nullopt};
    for (const Strobe& strobe : rig_.strobes) {
        for (const Surface& surface : surfaces_) {
            family.sources.push_back({strobe.spectrum, surface.reflectance});
            if (surface.phong > 0.0) family.sources.push_back({strobe.spectrum});
        }
    }
    const double middle_nm = 0.5 * (rig_.camera.range.first_nm + rig_.camera.range.last_nm);
    const Index index = index_at(middle_nm);
    std::vector<Vector3d> places_m;  // possible places of lamps
    for (const Strobe& strobe : rig_.strobes) {
        for (const auto& [x, y] : kCornersAndMiddle) {
            if (x == 0.0 || strobe.emitter) places_m.push_back(place_on_emitter(strobe, x, y));
        }
    }
    // The distance from the point where a ray enters the water to the nearest lamp.
    double nearest_m = std::numeric_limits<double>::infinity();
    const auto take_in = [&](double column, double row) {
        View view;
        const std::optional<WideVector> in_air = sight(column, row);
        if (!in_air) return false;
        const bool sees = look_along(*in_air, index, view);
        for (const Vector3d& place_m : places_m) {
            nearest_m = std::min(nearest_m, (view.ray.origin_m - place_m).norm());
            if (!sees) continue;
            const double path_m = view.distance_m + (view.point_m - place_m).norm();
            family.shortest_path_m = std::min(family.shortest_path_m, path_m / kRoom);
            family.longest_path_m = std::max(family.longest_path_m, path_m * kRoom);
        }
        return sees;
    };
    bool is_all_floor = true;
    for (int j = 0; j <= kSteps; ++j) {
        for (int i = 0; i <= kSteps; ++i) {
            is_all_floor &= take_in(rig_.camera.width_px * i / static_cast<double>(kSteps),
                                    rig_.camera.height_px * j / static_cast<double>(kSteps));
        }
    }
    // Towards the horizon paths grow without bound, and objects may lie between the grid's points,
    // so every pixel is used.
    const bool is_smooth = is_all_floor && shapes_.empty();
    for (int row = 0; row < rig_.camera.height_px && !is_smooth; ++row) {
        for (int column = 0; column < rig_.camera.width_px; ++column) {
            take_in(column + 0.5, row + 0.5);
        }
    }
    if (family.longest_path_m == 0.0) family.shortest_path_m = 0.0;  // nothing in view
    return full_spectrum(rig_.camera.sensor,
                         family,
                         rig_.camera.range,
                         kSpectralError,
                         veil_in_view(family, nearest_m, is_all_floor));
}

// Paths from the lamp nearest to any ray's entry into the water, up to the floor light's longest
// path, or to the range of light if the image sees the horizon.
VeilLights Tracer::veil_in_view(const LightFamily& family,
                                double nearest_m,
                                bool is_all_floor) const {
    constexpr double kRoom = 1.05;
    constexpr double kSpentDepth = 20.0;  // of which kSpectralError / 4 is left
    VeilLights veil;
    if (!water_.scatters()) return veil;
    for (const Strobe& strobe : rig_.strobes) {
        for (std::size_t i = 0; i < water_.phases().size(); ++i)
            veil.sources.push_back({strobe.spectrum, rig_.water.scatterers[i].scattering_per_m});
    }
    double least_per_m = std::numeric_limits<double>::infinity();
    for (const double nm : union_of_knots(rig_.water.curves(), rig_.camera.range))
        least_per_m = std::min(least_per_m, water_.loss_per_m(nm));
    constexpr double kNearest_m = 1e-2;
    veil.shortest_path_m = std::max(nearest_m / kRoom, kNearest_m);
    double longest_m = family.longest_path_m;
    if (least_per_m > 0.0) {
        const double spent_m = kSpentDepth / least_per_m;
        longest_m = is_all_floor ? std::min(longest_m, spent_m) : spent_m;
    }
    veil.longest_path_m = std::max(veil.shortest_path_m, longest_m);
    return veil;
}

void Tracer::tabulate_spectra() {
    std::vector<WeightedWavelength> grid;
    if (options_.signals) grid = spectrum_in_view();
    signal_nodes_ = grid.size();
    for (const WeightedWavelength& w : grid) lambda_nm_.push_back(w.lambda_nm);
    lambda_nm_.insert(lambda_nm_.end(), options_.planes_nm.begin(), options_.planes_nm.end());

    weights_.resize(static_cast<Eigen::Index>(signal_nodes_), kChannels);
    for (std::size_t j = 0; j < signal_nodes_; ++j) {
        for (std::size_t c = 0; c < kChannels; ++c) {
            weights_(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(c)) =
                grid[j].weight[c];
        }
    }
    const auto count = static_cast<Eigen::Index>(lambda_nm_.size());
    attenuation_per_m_.resize(count);
    diffuse_.assign(rig_.strobes.size(), std::vector<ArrayXd>(surfaces_.size(), ArrayXd(count)));
    specular_.assign(rig_.strobes.size(), ArrayXd(count));
    for (Eigen::Index j = 0; j < count; ++j) {
        const double lambda_nm = lambda_nm_[static_cast<std::size_t>(j)];
        attenuation_per_m_(j) = water_.loss_per_m(lambda_nm);
        for (std::size_t s = 0; s < rig_.strobes.size(); ++s) {
            const Strobe& strobe = rig_.strobes[s];
            const double flux = strobe.spectrum.at(lambda_nm) * strobe.power;
            specular_[s](j) = flux / std::numbers::pi;
            for (std::size_t k = 0; k < surfaces_.size(); ++k) {
                diffuse_[s][k](j) = specular_[s](j) * surfaces_[k].reflectance.at(lambda_nm);
            }
        }
        indices_.push_back(index_at(lambda_nm));
    }
    if (water_.scatters()) veil_.emplace(rig_, water_, lambda_nm_);
}

double Tracer::height_m(const Vector3d& point_m) const {
    const WideVector above_m =
        WideVector(0.0L, 0.0L, rig_.sled.altitude_m) - point_m.cast<long double>();
    return static_cast<double>(exact_down_.dot(above_m));
}

std::optional<WideVector> Tracer::sight(double column, double row) const {
    if (lens_) return lens_->direction(column, row);
    const Camera& camera = rig_.camera;
    // Image plane at unit distance: tangents of the ray's slope, up the image and to its right.
    const long double scale =
        static_cast<long double>(camera.pixel_pitch_m) / camera.focal_length_m;
    return WideVector(
        (0.5 * camera.height_px - row) * scale, (column - 0.5 * camera.width_px) * scale, 1.0L);
}

double Tracer::widest_pixel_rad() const {
    const Camera& camera = rig_.camera;
    double widest_rad = camera.pixel_pitch_m / camera.focal_length_m;
    if (!lens_) return widest_rad;
    constexpr int kSteps = 8;
    for (int i = 0; i <= kSteps; ++i) {
        for (int j = 0; j <= kSteps; ++j) {
            const double column = camera.width_px * i / static_cast<double>(kSteps);
            const double row = camera.height_px * j / static_cast<double>(kSteps);
            const auto from = sight(column, row);
            for (const auto& to : {sight(column + 1.0, row), sight(column, row + 1.0)}) {
                if (!from || !to) continue;
                const long double turn = from->cross(*to).norm() / (from->norm() * to->norm());
                widest_rad = std::max(widest_rad, static_cast<double>(std::asin(turn)));
            }
        }
    }
    return widest_rad;
}

// Finds what the point (column, row) of the image sees; false if there is no surface.
bool Tracer::look(double column, double row, const Index& index, View& view) const {
    const std::optional<WideVector> in_air = sight(column, row);
    return in_air && look_along(*in_air, index, view);
}

std::optional<VeilRay> Tracer::ray(double column, double row, double lambda_nm) const {
    View view;
    if (!look(column, row, index_at(lambda_nm), view)) return std::nullopt;
    return view.ray;
}

std::optional<Tracer::Seen> Tracer::seen(double column, double row, double lambda_nm) const {
    View view;
    if (!look(column, row, index_at(lambda_nm), view)) return std::nullopt;
    return Seen{.point_m = view.point_m, .normal = view.normal, .surface = view.surface};
}

bool Tracer::look_along(const WideVector& sight, const Index& index, View& view) const {
    TracedRay ray{.direction = sight};
    if (rig_.camera.port) ray = through_port(*rig_.camera.port, sight, index.glass, index.water);
    const WideVector& wide = ray.direction;
    const Vector3d& origin_m = ray.origin_m;
    Vector3d direction = wide.cast<double>();
    // Near the horizon the ray and the vertical are nearly perpendicular: their product is a small
    // difference, which has few digits in doubles.
    const long double approach = wide.dot(exact_down_) / wide.norm();
    const double depth_m = height_m(origin_m);
    const bool meets_floor = approach > 0.0L && depth_m > 0.0;
    direction.normalize();
    view.ray = {.origin_m = origin_m,
                .direction = direction,
                .length_m = std::numeric_limits<double>::infinity()};
    view.distance_m = meets_floor ? static_cast<double>(depth_m / approach)
                                  : std::numeric_limits<double>::infinity();
    view.normal = -down_;
    view.surface = 0;
    view.face = 0;
    for (std::size_t k = 0; k < shapes_.size() && !view.is_clear; ++k) {
        const auto hit = shapes_[k].first_hit({origin_m, direction}, {0.0, view.distance_m});
        if (!hit) continue;
        view.distance_m = hit->distance_m;
        view.normal = hit->normal.dot(direction) < 0.0 ? hit->normal : Vector3d(-hit->normal);
        view.surface = k + 1;
        view.face = hit->face;
    }
    if (!meets_floor && view.surface == 0) return false;
    view.ray.length_m = view.distance_m;
    view.point_m = origin_m + view.distance_m * direction;
    view.mirrored = direction - 2.0 * direction.dot(view.normal) * view.normal;
    return true;
}

// Whether an object blocks this part of the way from the point to the lamp. A face turned away is
// detected by its normal.
bool Tracer::is_blocked(const Lamp& lamp, const View& view, Stretch stretch) const {
    const Vector3d to_lamp = lamp.position_m - view.point_m;
    const double d = to_lamp.norm();
    stretch.to_m = std::min(stretch.to_m, d);
    for (std::size_t k = 0; k < shapes_.size() && !view.is_clear; ++k) {
        const int skip = view.surface == k + 1 ? view.face : -1;
        if (shapes_[k].first_hit({view.point_m, to_lamp / d}, stretch, skip)) {
            return true;
        }
    }
    return false;
}

Tracer::Contribution Tracer::light(const Lamp& lamp, const View& view) const {
    const Vector3d from_lamp = view.point_m - lamp.position_m;
    const double d2 = from_lamp.squaredNorm();
    const double d = std::sqrt(d2);
    // On the floor from the lamp's height, which is accurate for grazing light.
    const double cos_incidence =
        (view.surface == 0 ? height_m(lamp.position_m) : -from_lamp.dot(view.normal)) / d;
    Contribution found{.diffuse = 0.0, .specular = 0.0, .path_m = d + view.distance_m};
    if (cos_incidence <= 0.0) return found;
    const double intensity = beams_[lamp.strobe].intensity(from_lamp);
    if (intensity == 0.0 || is_blocked(lamp, view)) return found;
    const double arriving = intensity / (lamps_of_strobe_[lamp.strobe] * d2);
    found.diffuse = arriving * cos_incidence;
    const Surface& surface = surfaces_[view.surface];
    if (surface.phong > 0.0) {
        const double alignment = -view.mirrored.dot(from_lamp) / d;
        if (alignment > 0.0) {  // otherwise no highlight, even if phong_size is 0
            found.specular = arriving * surface.phong * std::pow(alignment, surface.phong_size);
        }
    }
    return found;
}

// From the shortest to the longest traced wavelength.
WavelengthRange Tracer::traced_range() const {
    const auto [first, last] = std::ranges::minmax_element(lambda_nm_);
    return {.first_nm = *first, .last_nm = *last};
}

// The radiance along a pixel's ray, at every wavelength.
void Tracer::trace_sight(int column, int row, const WideVector& in_air, ArrayXd& radiance) const {
    View view;
    if (!rig_.camera.port) {
        const bool sees = look_along(in_air, {.glass = 1.0, .water = 1.0}, view);
        if (veil_) radiance += veil_->along(view.ray);
        if (!sees) return;
        for (const Lamp& lamp : lamps_) {
            const Contribution lit = light(lamp, view);
            if (lit.diffuse == 0.0 && lit.specular == 0.0) continue;
            const ArrayXd left = light_left(lit.path_m * attenuation_per_m_);
            if (lit.specular == 0.0) {
                radiance += lit.diffuse * diffuse_[lamp.strobe][view.surface] * left;
            } else {
                radiance += (lit.diffuse * diffuse_[lamp.strobe][view.surface] +
                             lit.specular * specular_[lamp.strobe]) *
                            left;
            }
        }
        return;
    }
    if (lambda_nm_.empty()) return;
    // Holds for all wavelengths, each of which has its own ray.
    view.is_clear = is_clear_of_objects(column + 0.5, row + 0.5, traced_range(), 0.0);
    if (veil_) {
        radiance += veil_->along([&](std::size_t j) {
            static_cast<void>(look_along(in_air, indices_[j], view));  // to the sky as well
            return view.ray;
        });
    }
    for (Eigen::Index j = 0; j < radiance.size(); ++j) {
        if (!look_along(in_air, indices_[static_cast<std::size_t>(j)], view)) continue;
        for (const Lamp& lamp : lamps_) {
            const Contribution lit = light(lamp, view);
            radiance(j) += (lit.diffuse * diffuse_[lamp.strobe][view.surface](j) +
                            lit.specular * specular_[lamp.strobe](j)) *
                           light_left(lit.path_m * attenuation_per_m_(j));
        }
    }
}

// The radiance of one pixel at every wavelength, with vignetting.
void Tracer::trace_pixel(int column, int row, ArrayXd& radiance) const {
    radiance.setZero();
    const std::optional<WideVector> in_air = sight(column + 0.5, row + 0.5);
    if (!in_air) return;
    trace_sight(column, row, *in_air, radiance);
    if (rig_.camera.vignetting)
        radiance *= traced_vignetting(rig_.camera, column + 0.5, row + 0.5, *in_air);
}

bool Tracer::is_on_beam_edge(double column,
                             double row,
                             const std::array<Index, 3>& indices,
                             double within_px) const {
    std::array<View, 3> views;
    for (std::size_t e = 0; e < indices.size(); ++e) {
        if (!look(column, row, indices.at(e), views.at(e))) return false;
    }
    // A pixel covers more of a floor seen obliquely.
    constexpr double kAslant = 1.5;
    return std::ranges::any_of(apexes_, [&](const Apex& apex) {
        std::array<Vector3d, 3> paths_m;
        const double sight_rad =
            (rig_.camera.lens ? kEdgeThroughLensRad : 0.0) + within_px * pixel_rad_;
        // The least spread of a strobe's lamps about the edge.
        double spread_rad = sight_error_rad_;
        for (std::size_t e = 0; e < indices.size(); ++e) {
            paths_m.at(e) = views.at(e).point_m - apex.position_m;
            const double d_m = paths_m.at(e).norm();
            spread_rad = std::max({spread_rad,
                                   kAslant * sight_rad * views.at(e).distance_m / d_m,
                                   std::asin(std::min(1.0, apex.reach_m / d_m))});
        }
        // Dispersion's path is curved: each half deviates from its own chord by a quarter of the
        // middle's deviation from the whole chord; twice that gives a margin.
        const Vector3d first = paths_m[0].normalized();
        const Vector3d last = paths_m[2].normalized();
        const Vector3d off = paths_m[1].normalized() - 0.5 * (first + last);
        if (first != last) {
            const Vector3d along = (last - first).normalized();
            spread_rad = std::max(spread_rad, 0.5 * (off - off.dot(along) * along).norm());
        }
        const TracedBeam& beam = beams_[apex.strobe];
        return rig_.strobes[apex.strobe].power > 0.0 &&
               (beam.is_on_edge({paths_m[0], paths_m[1]}, spread_rad) ||
                beam.is_on_edge({paths_m[1], paths_m[2]}, spread_rad));
    });
}

// Ignores the beam: the lamp is in front of the surface, which is in front of the lamp, and nothing
// is in between.
bool Tracer::shines_on(const Lamp& lamp, const View& view) const {
    const Vector3d from_lamp = view.point_m - lamp.position_m;
    const bool is_ahead = from_lamp.dot(rig_.strobes[lamp.strobe].axis) > 0.0;
    return from_lamp.dot(view.normal) < 0.0 &&
           (is_ahead || beams_[lamp.strobe].shines_backwards()) && !is_blocked(lamp, view);
}

bool Tracer::shows_the_same(const View& a, const View& b) const {
    return a.surface == b.surface && a.face == b.face &&
           std::ranges::all_of(rim_lamps_, [&](const Lamp& lamp) {
               return shines_on(lamp, a) == shines_on(lamp, b);
           });
}

// For the surface in the pixel itself, regardless of its neighbours.
bool Tracer::is_uncertain(const View& view) const {
    const bool is_of_mesh = view.surface > 0 && shapes_[view.surface - 1].is_mesh();
    std::vector<int> lit(rig_.strobes.size(), 0);
    std::vector<int> dark(rig_.strobes.size(), 0);
    const bool has_penumbra = options_.rendered_lamps.empty();
    const auto looks_uncertain = [&](const Lamp& lamp) {
        const Vector3d to_lamp = lamp.position_m - view.point_m;
        const double d = to_lamp.norm();
        const double cos_incidence = to_lamp.dot(view.normal) / d;
        const bool shines = shines_on(lamp, view);
        ++(shines ? lit : dark)[lamp.strobe];
        const bool is_hidden = !shines && cos_incidence > 0.0;
        return (is_of_mesh && std::abs(cos_incidence) < kGrazing) ||
               (is_hidden && is_blocked(lamp, view, {0.0, kNoShadowWithin_m})) ||
               (is_hidden && is_blocked(lamp, view) &&
                !is_blocked(lamp, view, {kNoShadowWithin_m, d - kNoShadowWithin_m})) ||
               (has_penumbra && lit[lamp.strobe] > 0 && dark[lamp.strobe] > 0);
    };
    return std::ranges::any_of(lamps_, looks_uncertain) ||
           std::ranges::any_of(rim_lamps_, looks_uncertain);
}

// Whether the camera's ray, or a lamp's to the surface in view, comes close to an object.
bool Tracer::is_near_an_object(const View& view, double reach_m) const {
    const Vector3d pupil_m = Vector3d::Zero();
    if (view.surface > 0) return true;
    const auto passes = [&](const Eigen::AlignedBox3d& bounds_m, const Vector3d& to_m) {
        Eigen::AlignedBox3d grown_m = bounds_m;
        grown_m.min() -= Vector3d::Constant(reach_m);
        grown_m.max() += Vector3d::Constant(reach_m);
        if (grown_m.contains(view.point_m) || grown_m.contains(to_m)) return true;
        const TracedShape box(Box{.least_m = grown_m.min(), .most_m = grown_m.max()});
        const Vector3d way = to_m - view.point_m;
        return box.first_hit({view.point_m, way.normalized()}, {0.0, way.norm()}).has_value();
    };
    for (const TracedShape& shape : shapes_) {
        const Eigen::AlignedBox3d& bounds_m = shape.bounds_m();
        if (passes(bounds_m, pupil_m)) return true;
        for (const Lamp& lamp : rim_lamps_) {
            if (passes(bounds_m, lamp.position_m)) return true;
        }
    }
    return false;
}

// The logarithm of the change of light, each lamp's weighted by its share.
double Tracer::change_between(const View& from, const View& to, double lambda_nm) const {
    const double K_per_m = water_.loss_per_m(lambda_nm);
    const Surface& surface = surfaces_[from.surface];
    const double reflectance = surface.reflectance.at(lambda_nm);
    double all = 0.0;
    double change = 0.0;
    for (const Lamp& lamp : lamps_) {
        const Strobe& strobe = rig_.strobes[lamp.strobe];
        const double flux = strobe.power * strobe.spectrum.at(lambda_nm);
        const Contribution before = light(lamp, from);
        const Contribution after = light(lamp, to);
        const double left = flux * std::exp(-K_per_m * before.path_m);
        const double left_after = flux * std::exp(-K_per_m * after.path_m);
        all += left * (reflectance * before.diffuse + before.specular);
        change += reflectance * std::abs(left_after * after.diffuse - left * before.diffuse) +
                  std::abs(left_after * after.specular - left * before.specular);
    }
    if (change == 0.0) return 0.0;
    return all > 0.0 ? std::log1p(change / all) : std::numeric_limits<double>::infinity();
}

// Whether everything in view at the image point over the range, and within a number of pixels of
// it, is floor that no object hides from camera or lamp.
bool Tracer::is_clear_of_objects(double column,
                                 double row,
                                 WavelengthRange range,
                                 double within_px) const {
    constexpr double kRoom = 4.0;
    View view;
    if (!look(column, row, index_at(0.5 * (range.first_nm + range.last_nm)), view)) return false;
    double reach_m =
        kNoShadowWithin_m + kRoom * (edge_px() + within_px) * pixel_rad_ * view.distance_m;
    for (const double lambda_nm : {range.first_nm, range.last_nm}) {
        View shifted;
        if (!look(column, row, index_at(lambda_nm), shifted)) return false;
        reach_m += kRoom * (shifted.point_m - view.point_m).norm();
    }
    return !is_near_an_object(view, reach_m);
}

// Whether a lamp's light is so close to its limit on a rounded object, or its beam so steep, that
// the error of POV-Ray's rays matters.
bool Tracer::turns_steeply(double column, double row, const View& view, double lambda_nm) const {
    const double reach_px = sight_error_rad_ / pixel_rad_;
    const Index index = index_at(lambda_nm);
    for (const auto& [x, y] : std::array<std::array<double, 2>, 2>{{{1.0, 0.0}, {0.0, 1.0}}}) {
        View beside;
        if (!look(column + reach_px * x, row + reach_px * y, index, beside) ||
            change_between(view, beside, lambda_nm) > kRoundingChange) {
            return true;
        }
    }
    return false;
}

bool Tracer::is_on_object_edge(double column,
                               double row,
                               WavelengthRange range,
                               double within_px) const {
    constexpr int kSpectralSteps = 8;  // under a pixel each, for the widest dispersion of a port
    const double middle_nm = 0.5 * (range.first_nm + range.last_nm);
    const Index middle = index_at(middle_nm);
    if (is_clear_of_objects(column, row, range, within_px)) return false;
    View view;
    const bool sees = look(column, row, middle, view);
    if (sees && is_uncertain(view)) return true;
    for (const double reach_px : {edge_px(), 0.5 * within_px, within_px}) {
        constexpr int kDirections = 8;
        for (int k = 0; k < kDirections && reach_px > 0.0; ++k) {
            const double turn = 2.0 * std::numbers::pi * k / kDirections;
            View beside;
            const bool sees_beside = look(column + reach_px * std::cos(turn),
                                          row + reach_px * std::sin(turn),
                                          middle,
                                          beside);
            if (sees_beside != sees || (sees && !shows_the_same(view, beside))) return true;
        }
    }
    if (view.surface > 0 && sight_error_rad_ > kEdgeRad &&
        turns_steeply(column, row, view, middle_nm)) {
        return true;
    }
    for (int j = 0; j <= kSpectralSteps && range.first_nm < range.last_nm && rig_.camera.port;
         ++j) {
        const double lambda_nm =
            std::lerp(range.first_nm, range.last_nm, j / static_cast<double>(kSpectralSteps));
        View shifted;
        const bool sees_shifted = look(column, row, index_at(lambda_nm), shifted);
        if (sees_shifted != sees || (sees && !shows_the_same(view, shifted))) return true;
        if (view.surface > 0 && change_between(view, shifted, lambda_nm) > kSteepest) return true;
    }
    return false;
}

bool Tracer::is_on_steep_light(double column, double row, WavelengthRange range) const {
    const double middle_nm = 0.5 * (range.first_nm + range.last_nm);
    View view;
    return look(column, row, index_at(middle_nm), view) &&
           turns_steeply(column, row, view, middle_nm);
}

double Tracer::edge_px() const {
    return std::max(kEdgePx, sight_error_rad_ / pixel_rad_);
}

bool Tracer::is_on_edge(std::size_t pixel,
                        WavelengthRange range,
                        const std::array<Index, 3>& indices,
                        double within_px) const {
    const auto width = static_cast<std::size_t>(rig_.camera.width_px);
    const double column = static_cast<double>(pixel % width) + 0.5;
    const std::size_t rows_above = pixel / width;
    const double row = static_cast<double>(rows_above) + 0.5;
    return is_on_beam_edge(column, row, indices, within_px) ||
           (rig_.camera.lens && is_on_steep_light(column, row, range)) ||
           (!shapes_.empty() && is_on_object_edge(column, row, range, within_px));
}

std::vector<unsigned char> Tracer::on_edges(WavelengthRange range, double within_px) const {
    return on_edges_of(pixels_of(0, rig_.camera.height_px), range, within_px);
}

std::vector<unsigned char> Tracer::on_edges_of(std::span<const std::size_t> which,
                                               WavelengthRange range,
                                               double within_px) const {
    const std::array<Index, 3> indices{index_at(range.first_nm),
                                       index_at(0.5 * (range.first_nm + range.last_nm)),
                                       index_at(range.last_nm)};
    std::vector<unsigned char> marks(which.size());
    parallel_for(
        which.size(), static_cast<std::size_t>(options_.threads), [&](std::size_t i, std::size_t) {
            marks[i] = is_on_edge(which[i], range, indices, within_px) ? 1 : 0;
        });
    return marks;
}

std::size_t Tracer::planes() const {
    return (options_.signals ? kChannels : 0U) + options_.planes_nm.size();
}

void Tracer::write_planes(const ArrayXd& radiance, double* sample, std::size_t stride) const {
    const auto grid = static_cast<Eigen::Index>(signal_nodes_);
    for (int c = 0; options_.signals && c < kChannels; ++c, sample += stride) {
        *sample = (weights_.col(c) * radiance.head(grid)).sum();
    }
    for (Eigen::Index j = grid; j < radiance.size(); ++j, sample += stride) *sample = radiance(j);
}

std::vector<std::size_t> Tracer::pixels_of(int first_row, int count) const {
    const auto width = static_cast<std::size_t>(rig_.camera.width_px);
    std::vector<std::size_t> which(width * static_cast<std::size_t>(count));
    std::iota(which.begin(), which.end(), width * static_cast<std::size_t>(first_row));
    return which;
}

std::vector<double> Tracer::rows(int first_row,
                                 int count,
                                 const std::function<void(double)>& progress) const {
    return pixels(pixels_of(first_row, count), progress);
}

std::vector<double> Tracer::pixels(std::span<const std::size_t> which,
                                   const std::function<void(double)>& progress) const {
    const auto width = static_cast<std::size_t>(rig_.camera.width_px);
    const auto count = static_cast<double>(which.size());
    std::vector<double> samples(planes() * which.size());
    parallel_for(which.size(),
                 static_cast<std::size_t>(options_.threads),
                 [&](std::size_t i, std::size_t thread) {
                     ArrayXd radiance(static_cast<Eigen::Index>(lambda_nm_.size()));
                     trace_pixel(static_cast<int>(which[i] % width),
                                 static_cast<int>(which[i] / width),
                                 radiance);
                     write_planes(radiance, samples.data() + i, which.size());
                     if (progress && thread == 0) progress(static_cast<double>(i + 1) / count);
                 });
    if (progress) progress(1.0);
    return samples;
}

}  // namespace aphotic
