// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/povray_veil.h"

#include "base/degrees.h"
#include "light/dispersion.h"
#include "light/veil.h"
#include "scene_gen/render_plan.h"
#include "spectral/phase_lobes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

namespace aphotic {
namespace {

constexpr int kColumns = 9;
constexpr int kRows = 7;
// Light attenuated by this many e-foldings is negligible.
constexpr double kVeilFoldings = 10.0;

// The pixels examined, including the image's ends.
template <class Look>
void over_the_image(const Rig& rig, const Look& look) {
    for (int i = 0; i < kColumns; ++i) {
        for (int j = 0; j < kRows; ++j) {
            look(rig.camera.width_px * i / (kColumns - 1.0),
                 rig.camera.height_px * j / (kRows - 1.0));
        }
    }
}

double middle_nm(const Rig& rig) {
    return std::midpoint(rig.camera.range.first_nm, rig.camera.range.last_nm);
}

double longest_in_water_m(const Rig& rig) {
    double least_per_m = std::numeric_limits<double>::infinity();
    for (const double nm : union_of_knots(rig.water.curves(), rig.camera.range))
        least_per_m = std::min(least_per_m, rig.water.attenuation_per_m(nm));
    return kVeilFoldings / least_per_m;
}

double shortest_path_m(const Rig& rig, std::span<const LampGrid> lamps) {
    constexpr double kRoom = 0.98;  // for light between the grid's pixels
    double shortest_m = std::numeric_limits<double>::infinity();
    over_the_image(rig, [&](double column, double row) {
        const WaterRay ray = pixel_ray(rig, column, row, middle_nm(rig));
        for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
            for (const Eigen::Vector3d& at_m : lamp_positions_m(rig.strobes[s], lamps[s]))
                shortest_m = std::min(shortest_m, (at_m - ray.origin_m).norm());
        }
    });
    return kRoom * shortest_m;
}

// The scattering angles of the light in the image.
struct Angles {
    double from_rad;
    double to_rad;
};

Angles angles_in_view(const Rig& rig, const PovrayVeilRequest& request) {
    constexpr double kRoom_rad = 2.0 * kRadiansPerDegree;
    using std::numbers::pi;
    if (request.is_user_scene) return {kVeilCut, pi};
    Angles angles{pi, 0.0};
    over_the_image(rig, [&](double column, double row) {
        const VeilSight sight = sight_of(rig, column, row, middle_nm(rig));
        for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
            for (const Eigen::Vector3d& at_m : lamp_positions_m(rig.strobes[s], request.lamps[s])) {
                const auto turned_rad = [&](double t_m) {
                    return angle_between(sight.ray.origin_m + t_m * sight.ray.direction - at_m,
                                         -sight.ray.direction);
                };
                angles.from_rad = std::min(angles.from_rad, turned_rad(0.0));
                angles.to_rad = std::max(
                    angles.to_rad, std::isinf(sight.length_m) ? pi : turned_rad(sight.length_m));
            }
        }
    });
    return {std::clamp(angles.from_rad - kRoom_rad, kVeilCut, pi - kRoom_rad),
            std::min(pi, angles.to_rad + kRoom_rad)};
}

LightFamily veil_family(const Rig& rig,
                        const LightFamily& direct,
                        std::span<const LampGrid> lamps) {
    LightFamily family{.sources = {},
                       .water = rig.water,
                       .shortest_path_m = shortest_path_m(rig, lamps),
                       .longest_path_m = 0.0,
                       .tilt = direct.tilt};
    family.longest_path_m = std::clamp(direct.longest_path_m,
                                       family.shortest_path_m,
                                       family.shortest_path_m + longest_in_water_m(rig));
    for (const Strobe& strobe : rig.strobes) {
        for (const Scatterer& scatterer : rig.water.scatterers)
            family.sources.push_back({strobe.spectrum, scatterer.scattering_per_m});
    }
    return family;
}

// S_m of one wavelength.
std::vector<double> scattering_by_lobe(const Rig& rig, const PhaseLobes& lobes, double lambda_nm) {
    std::vector<double> scattering_per_m(lobes.lobes.size());
    for (std::size_t i = 0; i < lobes.share.size(); ++i) {
        const double b_per_m = rig.water.scattering_per_m(i, lambda_nm);
        for (std::size_t m = 0; m < scattering_per_m.size(); ++m)
            scattering_per_m[m] += b_per_m * lobes.share[i][m];
    }
    return scattering_per_m;
}

struct Sampled {
    double sum = 0.0;
    double parts = 0.0;  // the same, if no lobe cancelled another
};

Sampled sampled_radiance(const Rig& rig,
                         const std::vector<VeilNodes>& nodes,
                         const PlannedWavelength& w) {
    Sampled sampled;
    for (std::size_t s = 0; s < nodes.size(); ++s) {
        const double flux = rig.strobes[s].power * rig.strobes[s].spectrum.at(w.lambda_nm);
        std::vector<double> left;
        for (const double path_m : nodes[s].path_m)
            left.push_back(std::exp(-w.light.attenuation_per_m * path_m));
        for (std::size_t m = 0; m < nodes[s].weight.size(); ++m) {
            const double of_lobe =
                flux * w.veil->scattering_per_m[m] *
                std::inner_product(left.begin(), left.end(), nodes[s].weight[m].begin(), 0.0);
            sampled.sum += of_lobe;
            sampled.parts += std::abs(of_lobe);
        }
    }
    return sampled;
}

// Also records the brightness of the veil.
double measured_error(const Rig& rig,
                      const PovrayVeil& povray,
                      const PovrayVeilRequest& request,
                      std::span<PlannedWavelength> wavelengths) {
    struct Pair {
        Sampled found;
        double wanted;
    };
    const Veil veil(rig);
    std::vector<std::vector<Pair>> pairs(wavelengths.size());
    std::vector<std::pair<double, double>> pixels;
    over_the_image(rig, [&](double x, double y) { pixels.emplace_back(x, y); });
    for (const auto& [column, row] : pixels) {
        double index_nm = 0.0;
        VeilSight sight;
        std::vector<VeilNodes> nodes;
        for (std::size_t j = 0; j < wavelengths.size(); ++j) {
            const PlannedWavelength& w = wavelengths[j];
            if (j == 0 || (disperses(rig) && w.index_nm != index_nm)) {
                index_nm = w.index_nm;
                sight = sight_of(rig, column, row, index_nm);
                nodes =
                    media_samples(rig, request.lamps, povray.sampling, sight.ray, sight.length_m);
            }
            pairs[j].push_back({sampled_radiance(rig, nodes, w),
                                veil.radiance(sight.ray, sight.length_m, w.lambda_nm)});
        }
    }
    double worst = 0.0;
    for (std::size_t j = 0; j < wavelengths.size(); ++j) {
        double most = 0.0;
        for (const Pair& pair : pairs[j]) most = std::max(most, pair.wanted);
        wavelengths[j].veil->radiance_bound = most;
        for (const Pair& pair : pairs[j]) {
            const double scale = std::max(pair.wanted, kDimVeilShare * most);
            if (scale == 0.0) continue;
            const double cancelled = std::max(0.0, pair.found.parts - pair.found.sum) / scale;
            worst = std::max(
                worst,
                std::abs(pair.found.sum - pair.wanted) / scale + cancelled * request.frame_error);
        }
    }
    return worst;
}

// Short enough for the samples to resolve nearby light. If the cut might be in glass, it is beyond
// all lit water.
double first_piece_m(const Rig& rig,
                     const LightFamily& direct,
                     const LightFamily& of_veil,
                     const PovrayVeilRequest& request) {
    if (rig.camera.port || request.is_user_scene || !(direct.shortest_path_m > 0.0))
        return of_veil.longest_path_m;
    return std::min(of_veil.longest_path_m, direct.shortest_path_m);
}

}  // namespace

PovrayVeil plan_povray_veil(const Rig& rig,
                            const LightFamily& family,
                            const PovrayVeilRequest& request,
                            std::span<PlannedWavelength> wavelengths) {
    std::vector<PhaseFunction> phases;
    for (const Scatterer& scatterer : rig.water.scatterers) phases.push_back(scatterer.phase);
    const Angles angles = angles_in_view(rig, request);
    const PhaseLobes lobes = lobes_of(phases, angles.from_rad, angles.to_rad);
    const LightFamily of_veil = veil_family(rig, family, request.lamps);

    const QuadratureFitter fitter(rig.camera.sensor, of_veil, rig.camera.range);
    const std::vector<FrameLight> frames = frames_light(fitter, wavelengths);
    std::vector<WeightedWavelength> rule;
    for (const PlannedWavelength& w : wavelengths)
        rule.push_back({.lambda_nm = w.lambda_nm, .weight = w.weight});
    FittedRule fitted = request.fits_weights ? fitter.fit(frames, request.frame_error)
                                             : FittedRule{.wavelengths = rule,
                                                          .quality = fitter.judge(rule, frames)};
    for (std::size_t j = 0; j < wavelengths.size(); ++j) {
        PlannedWavelength& w = wavelengths[j];
        w.veil = PlannedVeil{.scattering_per_m = scattering_by_lobe(rig, lobes, w.lambda_nm),
                             .weight = fitted.wavelengths[j].weight};
    }
    PovrayVeil veil{.sampling = {.lobes = lobes.lobes,
                                 .samples = request.samples,
                                 .sight_m = first_piece_m(rig, family, of_veil, request),
                                 .most_m = longest_in_water_m(rig),
                                 .cuts_edges = !request.is_user_scene},
                    .quality = fitted.quality};
    veil.error = measured_error(rig, veil, request, wavelengths);
    return veil;
}

std::array<RuleQuality, kChannels> with_povray_veil(std::array<RuleQuality, kChannels> quality,
                                                    const PovrayVeil& veil) {
    for (std::size_t c = 0; c < kChannels; ++c) {
        const RuleQuality& of_veil = veil.quality[c];
        quality[c].error =
            std::max(quality[c].error, of_veil.error + of_veil.amplification * veil.error);
        quality[c].amplification = std::max(quality[c].amplification, of_veil.amplification);
    }
    return quality;
}

}  // namespace aphotic
