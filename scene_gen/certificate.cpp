// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/certificate.h"

#include "light/dispersion.h"
#include "light/floor_arrival.h"
#include "scene_gen/light_paths.h"
#include "spectral/panel_quadrature.h"
#include "spectral/quadrature_certificate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace aphotic {
namespace {

// Between these points of the range, the effect of geometry is taken as linear: dispersion varies
// it by a few per cent.
constexpr int kGeometryPoints = 65;
constexpr double kBlackShare = 1e-8;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

struct Node {
    std::size_t point = 0;  // of the geometry; then the share of the way to the next
    double share = 0.0;
    SourceLight light;
    std::array<double, kChannels> response{};  // times the node's width
};

double geometry_nm(WavelengthRange range, std::size_t point) {
    return std::lerp(
        range.first_nm, range.last_nm, static_cast<double>(point) / (kGeometryPoints - 1));
}

double longest_path_m(const Rig& rig) {
    double longest_m = 0.0;
    for (const auto& sample : floor_samples(rig, 2)) {
        if (!sample) continue;
        for (const Strobe& strobe : rig.strobes) {
            longest_m = std::max(
                longest_m, (sample->point_m - strobe.position_m).norm() + sample->camera_leg_m);
        }
    }
    return longest_m;
}

std::vector<Node> nodes_of(const Rig& rig) {
    const WavelengthRange range = rig.camera.range;
    std::vector<const Spectrum*> tables = rig.camera.sensor.curves();
    tables.push_back(&rig.seafloor.reflectance);
    for (const Strobe& strobe : rig.strobes) tables.push_back(&strobe.spectrum);
    std::vector<Node> nodes;
    for (const auto& [lambda_nm, width_nm] : panel_quadrature(
             light_panels(tables, rig.water, 0.0, longest_path_m(rig), nullptr, range))) {
        const double at =
            (lambda_nm - range.first_nm) / (range.last_nm - range.first_nm) * (kGeometryPoints - 1);
        const double point = std::min(std::floor(at), kGeometryPoints - 2.0);
        Node node{.point = static_cast<std::size_t>(point),
                  .share = at - point,
                  .light = source_light(rig, lambda_nm)};
        for (std::size_t c = 0; c < kChannels; ++c) {
            node.response[c] =
                width_nm * rig.camera.sensor.response(static_cast<int>(c), lambda_nm);
        }
        nodes.push_back(std::move(node));
    }
    return nodes;
}

// lit: by the strobe at power 1.
double radiance(const SourceLight& light, std::size_t strobe, const FloorArrival& lit) {
    return light.flux[strobe] * (light.reflectance.front() * lit.diffuse + lit.highlight) *
           std::exp(-light.attenuation_per_m * lit.path_m);
}

FloorArrival between(const FloorArrival& a, const FloorArrival& b, double share) {
    return {.diffuse = std::lerp(a.diffuse, b.diffuse, share),
            .highlight = std::lerp(a.highlight, b.highlight, share),
            .path_m = std::lerp(a.path_m, b.path_m, share)};
}

struct RuleSignals {
    std::array<double, kChannels> right{};
    std::array<double, kChannels> found{};
};

// Empty if the pixel shows no floor.
std::optional<RuleSignals> signals_of(const Rig& rig,
                                      double column,
                                      double row,
                                      std::span<const Node> nodes,
                                      std::span<const PlannedWavelength> rule) {
    const auto ray_at = [&](double nm) { return pixel_ray(rig, column, row, nm); };
    const WaterRay middle = ray_at(geometry_nm(rig.camera.range, kGeometryPoints / 2));
    const auto distance_m = distance_to(floor_plane(rig.sled), middle);
    if (!distance_m) return std::nullopt;
    const Eigen::Vector3d lobes_at_m = middle.origin_m + *distance_m * middle.direction;
    RuleSignals signals;
    for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
        const Strobe& strobe = rig.strobes[s];
        std::vector<FloorArrival> lit;
        for (std::size_t point = 0; point < kGeometryPoints; ++point) {
            const auto light =
                arrival_of(rig, strobe, ray_at(geometry_nm(rig.camera.range, point)), lobes_at_m);
            if (!light) return std::nullopt;
            lit.push_back(*light);
        }
        for (const Node& node : nodes) {
            const double L =
                radiance(node.light, s, between(lit[node.point], lit[node.point + 1], node.share));
            for (std::size_t c = 0; c < kChannels; ++c) signals.right[c] += node.response[c] * L;
        }
        for (const PlannedWavelength& w : rule) {
            const auto light = arrival_of(rig, strobe, ray_at(w.index_nm), lobes_at_m);
            if (!light) return std::nullopt;
            const double L = radiance(w.light, s, *light);
            for (std::size_t c = 0; c < kChannels; ++c) signals.found[c] += w.weight[c] * L;
        }
    }
    return signals;
}

}  // namespace

std::array<double, kChannels> port_error(const Rig& rig, std::span<const PlannedWavelength> rule) {
    const std::vector<Node> nodes = nodes_of(rig);
    Rig at_power_1 = rig;
    for (Strobe& strobe : at_power_1.strobes) strobe.power = 1.0;
    std::vector<RuleSignals> image;
    for (const double row : places_along(rig.camera.height_px)) {
        for (const double column : places_along(rig.camera.width_px)) {
            const auto signals = signals_of(at_power_1, column, row, nodes, rule);
            if (signals) image.push_back(*signals);
        }
    }
    std::array<double, kChannels> error{};
    for (std::size_t c = 0; c < kChannels; ++c) {
        double brightest = 0.0;
        for (const RuleSignals& pixel : image) brightest = std::max(brightest, pixel.right[c]);
        for (const RuleSignals& pixel : image) {
            if (!(pixel.right[c] > kBlackShare * brightest)) continue;
            const double off = std::abs(pixel.found[c] / pixel.right[c] - 1.0);
            // NaN counts as the largest error.
            error[c] = std::isnan(off) ? kInfinite : std::max(error[c], kBetweenPixels * off);
        }
    }
    return error;
}

void certify(const Rig& rig,
             const QuadratureFitter& fitter,
             std::span<const FrameLight> frames,
             std::span<const PlannedWavelength> in_view,
             FittedRule& rule) {
    const auto family = certified_quality(
        rig.camera.sensor, fitter.family(), rig.camera.range, rule.wavelengths, frames);
    std::array<double, kChannels> port{};
    if (disperses(rig) && !in_view.empty()) port = port_error(rig, in_view);
    for (std::size_t c = 0; c < kChannels; ++c) {
        RuleQuality& quality = rule.quality[c];
        const double shape = family[c].amplification > 0.0 ? fitter.tilt_shape_error() : 0.0;
        quality.error = std::max({quality.error, family[c].error + shape, port[c]});
        quality.amplification = std::max(quality.amplification, family[c].amplification);
    }
}

}  // namespace aphotic
