// SPDX-License-Identifier: BSD-3-Clause
#include "validation/tracer.h"

#include "spectral/error.h"
#include "spectral/light_family.h"
#include "spectral/refraction.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numbers>
#include <thread>

namespace aphotic {

using Eigen::ArrayXd;
using Eigen::Vector3d;

namespace {

// The world's vertical in the sled's frame: pitch about starboard, then roll about forward,
// both undone.
Vector3d vertical(const Sled& sled) {
    const Eigen::AngleAxisd pitch(sled.pitch_rad, Vector3d::UnitY());
    const Eigen::AngleAxisd roll(sled.roll_rad, Vector3d::UnitX());
    return (pitch * roll).inverse() * Vector3d::UnitZ();
}

// Lamps along one side of an emitter, so that the midpoint rule holds kEmitterError: with h their
// spacing it errs by h^2/24 of the second derivative, which for light on a plane at distance d is
// at most 20/d^2 of the value, shared between the two sides. A highlight, cos^n of an angle that
// turns by h/d, adds n/d^2.
int lamps_for(double side_m, double distance_m, const Seafloor& seafloor) {
    const double curvature = 20.0 + (seafloor.phong > 0.0 ? seafloor.phong_size : 0.0);
    const double spacing_m = distance_m * std::sqrt(0.5 * kEmitterError * 24.0 / curvature);
    return std::max(1, static_cast<int>(std::ceil(side_m / spacing_m)));
}

}  // namespace

Tracer::Tracer(const Rig& rig, const TraceOptions& options)
    : rig_(rig), options_(options), down_(vertical(rig.sled)) {
    for (const Strobe& strobe : rig_.strobes) {
        axial_intensity_.emplace_back();
        cos_edge_.emplace_back();
        for (const Cone& cone : strobe.beam.cones) {
            const double lobe = std::numbers::pi * std::pow(std::sin(cone.half_angle_rad), 2);
            const bool is_flux = strobe.beam.weights == ConeWeights::Flux;
            axial_intensity_.back().push_back(is_flux ? cone.weight / lobe : cone.weight);
            cos_edge_.back().push_back(std::cos(cone.half_angle_rad));
        }
    }
    place_lamps();
    tabulate_spectra();
}

void Tracer::place_lamps() {
    for (std::size_t s = 0; s < rig_.strobes.size(); ++s) {
        const Strobe& strobe = rig_.strobes[s];
        if (!strobe.emitter) {
            lamps_.push_back({.strobe = s, .position_m = strobe.position_m});
            lamps_of_strobe_.push_back(1.0);
            continue;
        }
        const double height_m =
            down_.dot(Vector3d(0.0, 0.0, rig_.sled.altitude_m) - strobe.position_m);
        const int across = options_.lamps_across > 0
                               ? options_.lamps_across
                               : lamps_for(strobe.emitter->across_m, height_m, rig_.seafloor);
        const int along = options_.lamps_along > 0
                              ? options_.lamps_along
                              : lamps_for(strobe.emitter->along_m, height_m, rig_.seafloor);
        constexpr double kMostLamps = 1e5;
        if (static_cast<double>(across) * along > kMostLamps) {
            throw InputError(
                fmt::format("strobe '{}': its emitter takes {} x {} lamps to trace; "
                            "allowed: {:.0f}. It is large for its height over the floor",
                            strobe.name,
                            across,
                            along,
                            kMostLamps));
        }
        // The emitter's own frame: its normal is the axis; forward, as it lies in its plane.
        Vector3d starboard_side = strobe.axis.cross(Vector3d::UnitX());
        if (starboard_side.norm() < 1e-6) starboard_side = strobe.axis.cross(Vector3d::UnitZ());
        starboard_side.normalize();
        const Vector3d forward_side = starboard_side.cross(strobe.axis);
        for (int j = 0; j < along; ++j) {
            for (int i = 0; i < across; ++i) {
                const double x = strobe.emitter->across_m * (2 * i + 1 - across) / (2.0 * across);
                const double y = strobe.emitter->along_m * (2 * j + 1 - along) / (2.0 * along);
                lamps_.push_back(
                    {.strobe = s,
                     .position_m = strobe.position_m + x * starboard_side + y * forward_side});
            }
        }
        lamps_of_strobe_.push_back(static_cast<double>(across) * along);
    }
}

// Of glass and water, relative to air; without a port nothing is bent.
Tracer::Index Tracer::index_at(double lambda_nm) const {
    if (!rig_.camera.port) return {.glass = 1.0, .water = 1.0};
    return {.glass = rig_.camera.port->glass.index(lambda_nm),
            .water = seawater_index(lambda_nm, rig_.water.salinity_psu, rig_.water.temperature_c)};
}

// The family of this rig's light: paths from the shortest to the longest that the image sees,
// with some room on both sides.
std::vector<WeightedWavelength> Tracer::full_spectrum() const {
    constexpr int kSteps = 16;
    constexpr double kRoom = 1.05;
    LightFamily family{.sources = {},
                       .water = rig_.water,
                       .shortest_path_m = std::numeric_limits<double>::infinity(),
                       .longest_path_m = 0.0,
                       .tilt = std::nullopt};
    for (const Strobe& strobe : rig_.strobes) {
        family.sources.push_back({strobe.spectrum, rig_.seafloor.reflectance});
        if (rig_.seafloor.phong > 0.0) family.sources.push_back({strobe.spectrum});
    }
    const double middle_nm = 0.5 * (rig_.camera.range.first_nm + rig_.camera.range.last_nm);
    Index index{.glass = 1.0, .water = 1.0};
    if (rig_.camera.port) {
        index = {
            .glass = rig_.camera.port->glass.index(middle_nm),
            .water = seawater_index(middle_nm, rig_.water.salinity_psu, rig_.water.temperature_c)};
    }
    const auto take_in = [&](double column, double row) {
        View view;
        if (!look(column, row, index, view)) return false;
        for (const Lamp& lamp : lamps_) {
            const double path_m = view.distance_m + (view.point_m - lamp.position_m).norm();
            family.shortest_path_m = std::min(family.shortest_path_m, path_m / kRoom);
            family.longest_path_m = std::max(family.longest_path_m, path_m * kRoom);
        }
        return true;
    };
    bool is_all_floor = true;
    for (int j = 0; j <= kSteps; ++j) {
        for (int i = 0; i <= kSteps; ++i) {
            is_all_floor &= take_in(rig_.camera.width_px * i / static_cast<double>(kSteps),
                                    rig_.camera.height_px * j / static_cast<double>(kSteps));
        }
    }
    // Towards the horizon paths grow without end: ask every pixel.
    for (int row = 0; row < rig_.camera.height_px && !is_all_floor; ++row) {
        for (int column = 0; column < rig_.camera.width_px; ++column) {
            take_in(column + 0.5, row + 0.5);
        }
    }
    if (family.longest_path_m == 0.0) family.shortest_path_m = 0.0;  // no floor in view
    return reference_grid(rig_.camera.sensor, family, rig_.camera.range, kSpectralError);
}

void Tracer::tabulate_spectra() {
    std::vector<WeightedWavelength> grid;
    if (options_.signals) grid = full_spectrum();
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
    diffuse_.assign(rig_.strobes.size(), ArrayXd(count));
    specular_.assign(rig_.strobes.size(), ArrayXd(count));
    for (Eigen::Index j = 0; j < count; ++j) {
        const double lambda_nm = lambda_nm_[static_cast<std::size_t>(j)];
        attenuation_per_m_(j) = rig_.water.attenuation_per_m(lambda_nm);
        for (std::size_t s = 0; s < rig_.strobes.size(); ++s) {
            const Strobe& strobe = rig_.strobes[s];
            const double flux = strobe.spectrum.at(lambda_nm) * strobe.power;
            specular_[s](j) = flux / std::numbers::pi;
            diffuse_[s](j) = specular_[s](j) * rig_.seafloor.reflectance.at(lambda_nm);
        }
        indices_.push_back(index_at(lambda_nm));
    }
}

// What the point (column, row) of the image looks at; false when it is no floor.
bool Tracer::look(double column, double row, const Index& index, View& view) const {
    const Camera& camera = rig_.camera;
    // Image plane at unit distance: tangents of the ray's slope, up the image and to its right.
    const double scale = camera.pixel_pitch_m / camera.focal_length_m;
    const double forward = (0.5 * camera.height_px - row) * scale;
    const double starboard = (column - 0.5 * camera.width_px) * scale;
    Vector3d origin_m = Vector3d::Zero();
    Vector3d direction(forward, starboard, 1.0);
    if (camera.port) {
        // Across the axis, n times the unit direction's components is the same in every medium.
        const double cos_air = 1.0 / direction.norm();
        const double u = forward * cos_air;
        const double v = starboard * cos_air;
        const double glass_z = std::sqrt(index.glass * index.glass - u * u - v * v);
        const double water_z = std::sqrt(index.water * index.water - u * u - v * v);
        const double per_sine =
            camera.port->distance_m / cos_air + camera.port->thickness_m / glass_z;
        origin_m = {u * per_sine, v * per_sine, camera.port->distance_m + camera.port->thickness_m};
        direction = {u, v, water_z};
    }
    direction.normalize();
    const double approach = direction.dot(down_);
    if (approach <= 0.0) return false;
    const double depth_m = down_.dot(Vector3d(0.0, 0.0, rig_.sled.altitude_m) - origin_m);
    if (depth_m <= 0.0) return false;
    view.distance_m = depth_m / approach;
    view.point_m = origin_m + view.distance_m * direction;
    view.mirrored = direction - 2.0 * approach * down_;
    return true;
}

Tracer::Contribution Tracer::light(const Lamp& lamp, const View& view) const {
    const Strobe& strobe = rig_.strobes[lamp.strobe];
    const Vector3d from_lamp = view.point_m - lamp.position_m;
    const double d2 = from_lamp.squaredNorm();
    const double d = std::sqrt(d2);
    const double cos_incidence = from_lamp.dot(down_) / d;
    const double cos_theta = from_lamp.dot(strobe.axis) / d;
    Contribution found{.diffuse = 0.0, .specular = 0.0, .path_m = d + view.distance_m};
    if (cos_incidence <= 0.0 || cos_theta <= 0.0) return found;

    double axial = 0.0;
    for (std::size_t k = 0; k < strobe.beam.cones.size(); ++k) {
        if (cos_theta >= cos_edge_[lamp.strobe][k]) axial += axial_intensity_[lamp.strobe][k];
    }
    const double arriving = axial * cos_theta / (lamps_of_strobe_[lamp.strobe] * d2);
    found.diffuse = arriving * cos_incidence;
    if (rig_.seafloor.phong > 0.0) {
        const double alignment = -view.mirrored.dot(from_lamp) / d;
        if (alignment > 0.0) {  // else none, where phong_size is 0 too
            found.specular =
                arriving * rig_.seafloor.phong * std::pow(alignment, rig_.seafloor.phong_size);
        }
    }
    return found;
}

// The radiance of one pixel at every wavelength.
void Tracer::trace_pixel(int column, int row, ArrayXd& radiance) const {
    radiance.setZero();
    View view;
    if (!rig_.camera.port) {
        if (!look(column + 0.5, row + 0.5, {.glass = 1.0, .water = 1.0}, view)) return;
        for (const Lamp& lamp : lamps_) {
            const Contribution lit = light(lamp, view);
            if (lit.diffuse == 0.0 && lit.specular == 0.0) continue;
            const auto left = (-lit.path_m * attenuation_per_m_).exp();
            if (lit.specular == 0.0) {
                radiance += lit.diffuse * diffuse_[lamp.strobe] * left;
            } else {
                radiance +=
                    (lit.diffuse * diffuse_[lamp.strobe] + lit.specular * specular_[lamp.strobe]) *
                    left;
            }
        }
        return;
    }
    for (Eigen::Index j = 0; j < radiance.size(); ++j) {
        if (!look(column + 0.5, row + 0.5, indices_[static_cast<std::size_t>(j)], view)) continue;
        for (const Lamp& lamp : lamps_) {
            const Contribution lit = light(lamp, view);
            radiance(j) += (lit.diffuse * diffuse_[lamp.strobe](j) +
                            lit.specular * specular_[lamp.strobe](j)) *
                           std::exp(-lit.path_m * attenuation_per_m_(j));
        }
    }
}

std::vector<unsigned char> Tracer::on_cone_edges(WavelengthRange range, double within_px) const {
    const double rounding_rad = rig_.camera.port ? kEdgeBehindPortRad : kEdgeRad;
    const std::array<Index, 2> ends{index_at(range.first_nm), index_at(range.last_nm)};
    // The signed angle from a cone's edge, and how far a strobe's lamps spread about it.
    const auto is_on_edge = [&](const Strobe& strobe,
                                const Cone& cone,
                                const std::array<View, 2>& views) {
        std::array<double, 2> beyond_rad{};
        // A pixel covers more of a floor that is seen aslant.
        constexpr double kAslant = 1.5;
        const double pixel_rad = rig_.camera.pixel_pitch_m / rig_.camera.focal_length_m;
        double spread_rad = rounding_rad;
        for (std::size_t e = 0; e < ends.size(); ++e) {
            const Vector3d path = views[e].point_m - strobe.position_m;
            beyond_rad[e] = std::atan2(path.cross(strobe.axis).norm(), path.dot(strobe.axis)) -
                            cone.half_angle_rad;
            spread_rad = std::max(
                spread_rad, kAslant * within_px * pixel_rad * views[e].distance_m / path.norm());
            if (!strobe.emitter) continue;
            const double reach_m =
                0.5 * std::hypot(strobe.emitter->across_m, strobe.emitter->along_m);
            spread_rad = std::max(spread_rad, std::asin(std::min(1.0, reach_m / path.norm())));
        }
        return std::abs(beyond_rad[0]) <= spread_rad || std::abs(beyond_rad[1]) <= spread_rad ||
               (beyond_rad[0] > 0.0) != (beyond_rad[1] > 0.0);
    };

    std::vector<unsigned char> marks;
    for (int row = 0; row < rig_.camera.height_px; ++row) {
        for (int column = 0; column < rig_.camera.width_px; ++column) {
            std::array<View, 2> views;
            bool is_marked = false;
            const bool sees_floor = look(column + 0.5, row + 0.5, ends[0], views[0]) &&
                                    look(column + 0.5, row + 0.5, ends[1], views[1]);
            for (const Strobe& strobe : rig_.strobes) {
                for (const Cone& cone : strobe.beam.cones) {
                    // A cone of 90 degrees ends where its cosine does: there is no step. Nor is
                    // there one where there is no light.
                    const bool has_step =
                        cone.half_angle_rad < 0.5 * std::numbers::pi - rounding_rad &&
                        cone.weight * strobe.power > 0.0;
                    is_marked =
                        is_marked || (sees_floor && has_step && is_on_edge(strobe, cone, views));
                }
            }
            marks.push_back(is_marked ? 1 : 0);
        }
    }
    return marks;
}

std::size_t Tracer::planes() const {
    return (options_.signals ? kChannels : 0U) + options_.planes_nm.size();
}

std::vector<double> Tracer::rows(int first_row, int count) const {
    const auto width = static_cast<std::size_t>(rig_.camera.width_px);
    const std::size_t plane = width * static_cast<std::size_t>(count);
    std::vector<double> samples(planes() * plane);
    std::atomic<int> next_row = 0;
    const auto work = [&] {
        ArrayXd radiance(static_cast<Eigen::Index>(lambda_nm_.size()));
        const auto grid = static_cast<Eigen::Index>(signal_nodes_);
        for (int row = next_row++; row < count; row = next_row++) {
            for (std::size_t column = 0; column < width; ++column) {
                trace_pixel(static_cast<int>(column), first_row + row, radiance);
                std::size_t at = static_cast<std::size_t>(row) * width + column;
                for (int c = 0; options_.signals && c < kChannels; ++c, at += plane) {
                    samples[at] = (weights_.col(c) * radiance.head(grid)).sum();
                }
                for (Eigen::Index j = grid; j < radiance.size(); ++j, at += plane) {
                    samples[at] = radiance(j);
                }
            }
        }
    };
    std::vector<std::jthread> others;
    for (int t = 1; t < options_.threads; ++t) others.emplace_back(work);
    work();
    others.clear();  // joins
    return samples;
}

}  // namespace aphotic
