// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/light_paths.h"

#include "light/dispersion.h"
#include "light/floor_arrival.h"
#include "light/signal_table.h"
#include "rig/geometry.h"
#include "rig/solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

namespace aphotic {

using Eigen::Vector3d;

namespace {

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

// An image point's light by kind: diffuse light and highlight of every lamp spectrum.
std::vector<double> light_at(const Rig& rig,
                             const std::vector<std::size_t>& lamp_of_strobe,
                             const WaterRay& ray,
                             const Vector3d& cones_at_m,
                             double lambda_nm) {
    const double K_per_m = rig.water.attenuation_per_m(lambda_nm);
    const double reflectance = rig.seafloor.reflectance.at(lambda_nm);
    std::vector<double> kinds(2 * rig.strobes.size());
    for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
        const auto lit = arrival_of(rig, rig.strobes[s], ray, cones_at_m);
        if (!lit) return {};
        const double flux =
            rig.strobes[s].spectrum.at(lambda_nm) * std::exp(-K_per_m * lit->path_m);
        kinds[2 * lamp_of_strobe[s]] += flux * reflectance * lit->diffuse;
        kinds[2 * lamp_of_strobe[s] + 1] += flux * lit->highlight;
    }
    return kinds;
}

// The largest change of a point's light between one ray and another: each kind's change, weighted
// by its share.
double change_between(const std::vector<double>& from, const std::vector<double>& to) {
    double all = 0.0;
    double change = 0.0;
    for (std::size_t k = 0; k < from.size() && k < to.size(); ++k) {
        all += from[k];
        change += std::abs(to[k] - from[k]);
    }
    return all > 0.0 ? std::log1p(change / all) : 0.0;
}

// The port's tilt: for each wavelength, the largest such change over the image.
Spectrum port_tilt(const Rig& rig) {
    constexpr int kWavelengths = 25;
    constexpr double kBetween = 1.1;  // for what lies between the places
    const WavelengthRange range = rig.camera.range;
    const double middle_nm = std::midpoint(range.first_nm, range.last_nm);
    // Only strobes of the same lamp spectrum can compensate for each other.
    std::vector<std::size_t> lamps;
    static_cast<void>(lamps_of(rig, lamps));
    std::vector<double> lambda_nm;
    std::vector<double> tilt;
    for (int j = 0; j < kWavelengths; ++j) {
        const double nm = std::lerp(range.first_nm, range.last_nm, j / (kWavelengths - 1.0));
        double worst = 0.0;
        for (const double row : places_along(rig.camera.height_px)) {
            for (const double column : places_along(rig.camera.width_px)) {
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
            .tilt = disperses(rig) ? std::optional(port_tilt(rig)) : std::nullopt};
}

std::vector<Spectrum> lamps_of(const Rig& rig) {
    std::vector<Spectrum> lamps;
    for (const Strobe& strobe : rig.strobes) lamps.push_back(strobe.spectrum);
    return lamps;
}

}  // namespace

std::vector<double> places_along(int pixels) {
    const int count = std::min(pixels, kMostPlaces);
    std::vector<double> places;
    for (int i = 0; i < count; ++i)
        places.push_back(std::lerp(0.5, pixels - 0.5, i / std::max(1.0, count - 1.0)));
    return places;
}

std::vector<Spectrum> materials_of(const Rig& rig) {
    std::vector<Spectrum> materials{rig.seafloor.reflectance};
    materials.insert(materials.end(), rig.materials.begin(), rig.materials.end());
    for (const Object& object : rig.objects) materials.push_back(object.reflectance);
    return materials;
}

SourceLight source_light(const Rig& rig, double lambda_nm) {
    SourceLight light{.attenuation_per_m = rig.water.attenuation_per_m(lambda_nm)};
    for (const Strobe& strobe : rig.strobes) {
        light.flux.push_back(strobe.power * strobe.spectrum.at(lambda_nm));
    }
    light.reflectance.push_back(rig.seafloor.reflectance.at(lambda_nm));
    for (const Spectrum& material : rig.materials) {
        light.reflectance.push_back(material.at(lambda_nm));
    }
    for (const Object& object : rig.objects) {
        light.reflectance.push_back(object.reflectance.at(lambda_nm));
    }
    return light;
}

LightFamily light_family(const Rig& rig) {
    return family_of(rig, sources_of(rig, distinct(lamps_of(rig)), distinct(materials_of(rig))));
}

LightFamily light_family_by_strobe(const Rig& rig) {
    return family_of(rig, sources_of(rig, lamps_of(rig), materials_of(rig)));
}

}  // namespace aphotic
