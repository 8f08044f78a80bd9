// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/light_paths.h"

#include "scene_gen/floor_light.h"
#include "scene_gen/frame_groups.h"
#include "scene_gen/geometry.h"
#include "scene_gen/solid.h"

#include <boost/math/tools/minima.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace aphotic {

using Eigen::Vector3d;

namespace {

// Bits of an image coordinate: a pixel of the largest image, and more than the path can tell.
constexpr int kBits = 20;
// More than any path, and rising away from the floor, so that a search finds its way back.
constexpr double kNoFloor_m = 1e30;
// An emitter may be larger than its distance to the floor.
constexpr double kLeastPath_m = 1e-6;

// The path by way of the floor point that (column, row) shows at lambda_nm.
double path_m(const Rig& rig, const Strobe& strobe, double column, double row, double lambda_nm) {
    const Plane floor = floor_plane(rig.sled);
    const WaterRay ray = pixel_ray(rig, column, row, lambda_nm);
    const auto distance_m = distance_to(floor, ray);
    if (!distance_m) return kNoFloor_m * (2.0 + floor.normal.dot(ray.direction));
    const Vector3d point_m = ray.origin_m + *distance_m * ray.direction;
    return *distance_m + (point_m - strobe.position_m).norm();
}

double shortest_path_m(const Rig& rig, const Strobe& strobe, double lambda_nm) {
    const auto along_row = [&](double row) {
        return boost::math::tools::brent_find_minima(
                   [&](double column) { return path_m(rig, strobe, column, row, lambda_nm); },
                   0.0,
                   static_cast<double>(rig.camera.width_px),
                   kBits)
            .second;
    };
    return boost::math::tools::brent_find_minima(
               along_row, 0.0, static_cast<double>(rig.camera.height_px), kBits)
        .second;
}

double half_diagonal_m(const Strobe& strobe) {
    return strobe.emitter ? 0.5 * std::hypot(strobe.emitter->across_m, strobe.emitter->along_m)
                          : 0.0;
}

// Where light that falls as exp(-K l) / l^3, no faster than any here, is down to kDarkShare.
double darkest_path_m(const Rig& rig, double shortest_m) {
    double K_per_m = rig.water.uniform_loss_per_m;
    if (rig.water.multiple > 0.0) {
        const auto absorption = rig.water.absorption_per_m.values();
        K_per_m += rig.water.multiple * *std::ranges::min_element(absorption);
    }
    double l_m = shortest_m;
    while (std::exp(-K_per_m * (l_m - shortest_m)) * std::pow(shortest_m / l_m, 3) > kDarkShare) {
        constexpr double kStep = 1.02;
        l_m *= kStep;
    }
    return l_m;
}

// The corners; behind a port, where rays bend, points all along the image's rim.
std::vector<std::array<double, 2>> rim_of(const Camera& camera) {
    const int steps = camera.port ? 512 : 1;
    std::vector<std::array<double, 2>> rim;
    for (int i = 0; i <= steps; ++i) {
        const double share = static_cast<double>(i) / steps;
        const double column = share * camera.width_px;
        const double row = share * camera.height_px;
        rim.push_back({column, 0.0});
        rim.push_back({column, static_cast<double>(camera.height_px)});
        rim.push_back({0.0, row});
        rim.push_back({static_cast<double>(camera.width_px), row});
    }
    return rim;
}

// The shortest path by way of floor that a cone lights; 0 when the grid finds none.
double first_lit_path_m(const Rig& rig) {
    constexpr std::size_t kGrid = 65;
    double first_m = std::numeric_limits<double>::infinity();
    for (const auto& sample : floor_samples(rig, kGrid)) {
        if (!sample) continue;
        for (const Strobe& strobe : rig.strobes) {
            const Vector3d towards = sample->point_m - strobe.position_m;
            const double theta_rad =
                std::acos(std::clamp(strobe.axis.dot(towards.normalized()), -1.0, 1.0));
            const bool is_lit = std::ranges::any_of(strobe.beam.cones, [&](const Cone& cone) {
                return strobe.power * cone.weight > 0.0 && theta_rad <= cone.half_angle_rad;
            });
            if (is_lit) first_m = std::min(first_m, towards.norm() + sample->camera_leg_m);
        }
    }
    return std::isfinite(first_m) ? first_m : 0.0;
}

std::vector<Spectrum> distinct(const std::vector<Spectrum>& curves) {
    std::vector<Spectrum> kept;
    for (const Spectrum& curve : curves) {
        if (std::ranges::none_of(kept,
                                 [&](const Spectrum& k) { return is_same_curve(k, curve); })) {
            kept.push_back(curve);
        }
    }
    return kept;
}

std::vector<std::vector<Spectrum>> sources_of(const Rig& rig,
                                              const std::vector<Spectrum>& lamps,
                                              const std::vector<Spectrum>& materials) {
    std::vector<std::vector<Spectrum>> sources;
    for (const Spectrum& lamp : lamps) {
        for (const Spectrum& material : materials) sources.push_back({lamp, material});
        if (has_highlight(rig)) sources.push_back({lamp});
    }
    return sources;
}

// What one image point gets of each kind of light: diffuse light and highlight of every lamp
// spectrum.
std::vector<double> light_at(const Rig& rig,
                             const std::vector<std::size_t>& lamp_of_strobe,
                             const WaterRay& ray,
                             const Vector3d& cones_at_m,
                             double lambda_nm) {
    const double K_per_m = rig.water.attenuation_per_m(lambda_nm);
    const double reflectance = rig.seafloor.reflectance.at(lambda_nm);
    std::vector<double> kinds(2 * rig.strobes.size());
    for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
        const auto lit = floor_light(rig, rig.strobes[s], ray, cones_at_m);
        if (!lit) return {};
        const double flux =
            rig.strobes[s].spectrum.at(lambda_nm) * std::exp(-K_per_m * lit->path_m);
        kinds[2 * lamp_of_strobe[s]] += flux * reflectance * lit->diffuse_per_m2;
        kinds[2 * lamp_of_strobe[s] + 1] += flux * lit->specular_per_m2;
    }
    return kinds;
}

// How much the light of a point may err for its way from one ray to another: each kind's change, by
// its share of all.
double change_between(const std::vector<double>& from, const std::vector<double>& to) {
    double all = 0.0;
    double change = 0.0;
    for (std::size_t k = 0; k < from.size() && k < to.size(); ++k) {
        all += from[k];
        change += std::abs(to[k] - from[k]);
    }
    return all > 0.0 ? std::log1p(change / all) : 0.0;
}

// Strobes of one lamp spectrum may make up for each other, others may not.
std::vector<std::size_t> lamps_by_strobe(const Rig& rig) {
    std::vector<std::size_t> lamps;
    for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
        std::size_t first = 0;
        while (!is_same_curve(rig.strobes[first].spectrum, rig.strobes[s].spectrum)) ++first;
        lamps.push_back(first);
    }
    return lamps;
}

// The port's tilt: for each wavelength, the largest such change over the image.
Spectrum port_tilt(const Rig& rig) {
    constexpr int kGrid = 33;
    constexpr int kWavelengths = 25;
    constexpr double kBetween = 1.1;  // for what lies between the grid's points
    const WavelengthRange range = rig.camera.range;
    const double middle_nm = std::midpoint(range.first_nm, range.last_nm);
    const std::vector<std::size_t> lamps = lamps_by_strobe(rig);
    std::vector<double> lambda_nm;
    std::vector<double> tilt;
    for (int j = 0; j < kWavelengths; ++j) {
        const double nm = std::lerp(range.first_nm, range.last_nm, j / (kWavelengths - 1.0));
        double worst = 0.0;
        for (int v = 0; v < kGrid; ++v) {
            for (int u = 0; u < kGrid; ++u) {
                const double column = rig.camera.width_px * (u / (kGrid - 1.0));
                const double row = rig.camera.height_px * (v / (kGrid - 1.0));
                const WaterRay middle = pixel_ray(rig, column, row, middle_nm);
                const auto distance_m = distance_to(floor_plane(rig.sled), middle);
                if (!distance_m) continue;
                const Vector3d point_m = middle.origin_m + *distance_m * middle.direction;
                worst = std::max(
                    worst,
                    change_between(
                        light_at(rig, lamps, middle, point_m, nm),
                        light_at(rig, lamps, pixel_ray(rig, column, row, nm), point_m, nm)));
            }
        }
        if (!rig.objects.empty()) {
            const double blue_px = corner_shift_px(rig, range.first_nm, middle_nm);
            const double red_px = corner_shift_px(rig, range.last_nm, middle_nm);
            worst = std::max(
                worst,
                kObjectTilt * corner_shift_px(rig, nm, middle_nm) / std::max(blue_px, red_px));
        }
        lambda_nm.push_back(nm);
        tilt.push_back(kBetween * (nm < middle_nm ? -worst : worst));
    }
    return {"change of light over a port's dispersion", std::move(lambda_nm), std::move(tilt)};
}

LightFamily family_of(const Rig& rig, std::vector<std::vector<Spectrum>> sources) {
    const PathRange paths = path_range(rig);
    return {.sources = std::move(sources),
            .water = rig.water,
            .shortest_path_m = paths.shortest_m,
            .longest_path_m = paths.longest_m,
            .tilt = rig.camera.port ? std::optional(port_tilt(rig)) : std::nullopt};
}

std::vector<Spectrum> lamps_of(const Rig& rig) {
    std::vector<Spectrum> lamps;
    for (const Strobe& strobe : rig.strobes) lamps.push_back(strobe.spectrum);
    return lamps;
}

double farthest_m(const Eigen::AlignedBox3d& box, const Vector3d& from_m) {
    return (box.max() - from_m).cwiseAbs().cwiseMax((box.min() - from_m).cwiseAbs()).norm();
}

void widen_by(const Rig& rig, const Object& object, PathRange& paths) {
    const Eigen::AlignedBox3d box = bounds_m(object.shape);
    const double port_m = port_reach_m(rig);
    const Vector3d pupil_m = Vector3d::Zero();
    const double nearest_leg_m = std::max(0.0, box.exteriorDistance(pupil_m) - port_m);
    const double farthest_leg_m = farthest_m(box, pupil_m) + port_m;
    for (const Strobe& strobe : rig.strobes) {
        const double room_m = half_diagonal_m(strobe);
        const double shortest_m = box.exteriorDistance(strobe.position_m) + nearest_leg_m - room_m;
        const double longest_m = farthest_m(box, strobe.position_m) + farthest_leg_m + room_m;
        paths.shortest_m = std::min(paths.shortest_m, std::max(kLeastPath_m, shortest_m));
        paths.longest_m = std::max(paths.longest_m, longest_m);
    }
}

// Of the floor alone; infinity and 0 when the image sees none.
PathRange floor_path_range(const Rig& rig) {
    const Camera& camera = rig.camera;
    std::vector<double> wavelengths{std::midpoint(camera.range.first_nm, camera.range.last_nm)};
    if (camera.port) {
        wavelengths.insert(wavelengths.end(), {camera.range.first_nm, camera.range.last_nm});
    }
    PathRange paths{.shortest_m = std::numeric_limits<double>::infinity()};
    for (const Strobe& strobe : rig.strobes) {
        const double room_m = half_diagonal_m(strobe);
        for (const double nm : wavelengths) {
            const double shortest_m = shortest_path_m(rig, strobe, nm);
            if (shortest_m >= kNoFloor_m) continue;
            paths.shortest_m = std::min(paths.shortest_m, shortest_m - room_m);
            for (const auto& [column, row] : rim_of(camera)) {
                const double rim_m = path_m(rig, strobe, column, row, nm);
                paths.has_horizon |= rim_m >= kNoFloor_m;
                if (rim_m < kNoFloor_m) paths.longest_m = std::max(paths.longest_m, rim_m + room_m);
            }
        }
    }
    if (paths.shortest_m == std::numeric_limits<double>::infinity()) return paths;
    paths.shortest_m = std::max(kLeastPath_m, paths.shortest_m / kPathRoom);
    paths.longest_m *= kPathRoom;
    // No farther than light comes from, with the horizon in view or nearly so.
    const double darkest_m = darkest_path_m(rig, std::max(paths.shortest_m, first_lit_path_m(rig)));
    if (paths.has_horizon || darkest_m < paths.longest_m) paths.longest_m = darkest_m;
    return paths;
}

}  // namespace

PathRange path_range(const Rig& rig) {
    PathRange paths = floor_path_range(rig);
    for (const Object& object : rig.objects) {
        if (may_be_in_view(rig, object)) widen_by(rig, object, paths);
    }
    if (paths.shortest_m == std::numeric_limits<double>::infinity()) return {};
    return paths;
}

std::vector<Spectrum> materials_of(const Rig& rig) {
    std::vector<Spectrum> materials{rig.seafloor.reflectance};
    materials.insert(materials.end(), rig.materials.begin(), rig.materials.end());
    for (const Object& object : rig.objects) materials.push_back(object.reflectance);
    return materials;
}

LightFamily light_family(const Rig& rig) {
    return family_of(rig, sources_of(rig, distinct(lamps_of(rig)), distinct(materials_of(rig))));
}

LightFamily light_family_by_strobe(const Rig& rig) {
    return family_of(rig, sources_of(rig, lamps_of(rig), materials_of(rig)));
}

}  // namespace aphotic
