// SPDX-License-Identifier: BSD-3-Clause
#include "light/floor_light.h"

#include "base/degrees.h"
#include "base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aphotic {
namespace {

using Eigen::Vector3d;

// The index nodes of light in the order of PlaceRays, and of the nodes of twice as many; then what
// each of the first counts at the last two.
constexpr std::array<std::size_t, kIndexNodes> kNodeOrder{1, 0, 2};
constexpr std::array<std::size_t, kLooks> kLookOrder{2, 0, 4, 1, 3};
constexpr std::array<std::array<double, kIndexNodes>, kLooks - kIndexNodes> kHalfWay{
    {{0.75, 0.375, -0.125}, {0.75, -0.125, 0.375}}};

// As in clear water: of what a signal counts, little is attenuated so much that it asks for more.
LampGrid grid_of_lamps(const Rig& rig, const Strobe& strobe) {
    constexpr double kMostLamps = 1e5;  // a map adds up the lamps pixel by pixel
    const LampGrid grid = lamp_grid(rig, strobe, 0.0);
    if (static_cast<double>(grid.across) * grid.along > kMostLamps) {
        throw InputError(
            "strobe '{}': found an emitter that takes {} x {} lamps so low over the "
            "floor; allowed: up to {} of them",
            strobe.name,
            grid.across,
            grid.along,
            kMostLamps);
    }
    return grid;
}

}  // namespace

std::string in_words(const Sled& sled) {
    return fmt::format("altitude {:.6g} m, pitch {:.6g}, roll {:.6g} degrees",
                       sled.altitude_m,
                       sled.pitch_rad * kDegreesPerRadian,
                       sled.roll_rad * kDegreesPerRadian);
}

void require_over_floor(const Rig& rig, const Sled& sled) {
    Rig flown = rig;
    flown.sled = sled;
    try {
        for (const Strobe& strobe : flown.strobes) {
            require_over_floor(sled, strobe, {});  // else no number of lamps would do
            require_over_floor(sled, strobe, grid_of_lamps(flown, strobe));
        }
    } catch (const InputError& error) {
        throw InputError("{}: {}", in_words(sled), error.what());
    }
}

std::vector<double> place_rays_nm(const Rig& rig) {
    if (!rig.camera.port) return index_nodes_nm(rig);
    const std::vector<double> nodes_nm = index_nodes_nm(rig, kLooks);
    std::vector<double> looks;
    for (const std::size_t node : kLookOrder) looks.push_back(nodes_nm[node]);
    return looks;
}

CameraRays::CameraRays(const Rig& rig, int threads)
    : has_port_(rig.camera.port.has_value()), table_(rig, place_rays_nm(rig), threads) {}

CameraRays::CameraRays(const Rig& rig, double lambda_nm, int threads)
    : has_port_(false), table_(rig, {lambda_nm}, threads) {}

PlaceRays CameraRays::at(double column, double row, const Plane& floor, bool looks) const {
    std::array<WaterRay, kLooks> found;
    const std::size_t count = looks && has_port_ ? kLooks : nodes();
    table_.look(column, row, std::span(found).first(count));
    PlaceRays rays;
    for (std::size_t k = 0; k < count; ++k) rays[k] = floor_ray(found[k], floor);
    return rays;
}

FloorLight::FloorLight(const Rig& rig,
                       const Sled& sled,
                       const SignalTable& table,
                       const CameraRays& rays)
    : rig_(rig), table_(table), rays_(rays), floor_(floor_plane(sled)) {
    require_over_floor(rig, sled);
    if (table.lamps.empty()) return;
    Rig flown = rig;
    flown.sled = sled;
    for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
        const Strobe& strobe = rig.strobes[s];
        const BeamFrame frame = frame_about(strobe.axis);
        strobes_.push_back(
            {.beam = BeamLight(strobe.beam, strobe.axis),
             .creases = creases_of(strobe.beam, frame),
             .steep = has_port() ? steep_creases(strobe.beam, frame) : std::vector<Crease>{},
             .signal = &table.lamps[table.lamp_of_strobe[s]]});
        if (strobe.power == 0.0) continue;
        const auto positions_m = lamp_positions_m(strobe, grid_of_lamps(flown, strobe));
        const double share =
            strobe.power / (std::numbers::pi * static_cast<double>(positions_m.size()));
        for (const Vector3d& position_m : positions_m) {
            lamps_.push_back({.position_m = position_m,
                              .floor_m = height_above(floor_, position_m),
                              .share = share,
                              .strobe = s});
        }
    }
}

FloorArrival FloorLight::arrive(const FloorLamp& lamp,
                                const FloorRay& ray,
                                const Vector3d* from) const {
    const BeamLight& beam = strobes_[lamp.strobe].beam;
    return arrival(rig_.seafloor,
                   lamp.position_m,
                   lamp.floor_m,
                   lamp.share,
                   ray,
                   [&](const Vector3d& towards) {
                       return from != nullptr ? beam.continued(towards, *from) : beam.at(towards);
                   });
}

void FloorLight::add(const FloorLamp& lamp,
                     const PlaceRays& rays,
                     bool looks,
                     PlaceLight& light) const {
    const StrobeLight& strobe = strobes_[lamp.strobe];
    const LampSignal& signal = *strobe.signal;
    std::array<FloorArrival, kIndexNodes> at_nodes;
    double last_place = -1.0;
    const Vector3d* const middle = rays[0].sees_floor() ? &at_nodes[0].towards : nullptr;
    for (std::size_t j = 0; j < rays_.nodes(); ++j) {
        at_nodes[j] = arrive(lamp, rays[j], j == 0 ? nullptr : middle);
        if (at_nodes[j].diffuse == 0.0) continue;
        const double place = place_in_table(at_nodes[j].path_m);
        light.is_before |= place < 0.0;
        light.is_beyond |= place >= table_.steps.count;
        if (place < 0.0 || place >= table_.steps.count) continue;
        last_place = place;
        const std::size_t node = rays_.nodes() > 1 ? kNodeOrder[j] : 0;
        add_signal(signal.diffuse[node], place, at_nodes[j].diffuse, light.signals);
        if (signal.highlight.empty()) continue;
        add_signal(signal.highlight[node], place, at_nodes[j].highlight, light.signals);
    }
    if (!looks || last_place < 0.0) return;
    double diffuse = 0.0;
    double highlight = 0.0;
    for (std::size_t h = 0; h < kHalfWay.size(); ++h) {
        const FloorArrival found = arrive(lamp, rays[kIndexNodes + h], middle);
        double told_diffuse = 0.0;
        double told_highlight = 0.0;
        for (std::size_t j = 0; j < kIndexNodes; ++j) {
            told_diffuse += kHalfWay[h][j] * at_nodes[j].diffuse;
            told_highlight += kHalfWay[h][j] * at_nodes[j].highlight;
        }
        diffuse = std::max(diffuse, std::abs(found.diffuse - told_diffuse));
        highlight = std::max(highlight, std::abs(found.highlight - told_highlight));
    }
    for (const std::vector<float>& table : signal.diffuse)
        add_signal(table, last_place, diffuse, light.doubts);
    for (const std::vector<float>& table : signal.highlight)
        add_signal(table, last_place, highlight, light.doubts);
    const std::array<Vector3d, kIndexNodes> ways{
        at_nodes[0].towards, at_nodes[1].towards, at_nodes[2].towards};
    const bool sees_all =
        std::ranges::none_of(ways, [](const Vector3d& V) { return V.isZero(0.0); });
    light.crosses |= sees_all && std::ranges::any_of(strobe.steep, [&](const Crease& crease) {
                         return crosses(crease, ways);
                     });
}

Signals FloorLight::dispersed(std::span<const FloorLamp* const> lamps,
                              double column,
                              double row,
                              const PlaceRays& rays) const {
    std::array<WaterRay, kRayNodes> nodes;
    for (std::size_t j = 0; j < kRayNodes; ++j)
        nodes[j] = pixel_ray(rig_, column, row, table_.ray_nodes_nm[j]);
    Signals sum{};
    for (std::size_t k = 0; k < table_.ray_shares.size(); ++k) {
        WaterRay mixed{.origin_m = Vector3d::Zero(), .direction = Vector3d::Zero()};
        for (std::size_t j = 0; j < kRayNodes; ++j) {
            mixed.origin_m += table_.ray_shares[k][j] * nodes[j].origin_m;
            mixed.direction += table_.ray_shares[k][j] * nodes[j].direction;
        }
        const FloorRay ray = floor_ray(mixed, floor_);
        const auto wavelength = static_cast<Eigen::Index>(k);
        for (const FloorLamp* lamp : lamps) {
            const LampSignal& signal = *strobes_[lamp->strobe].signal;
            const Vector3d middle = towards(lamp->position_m, rays[0]);
            const FloorArrival light = arrive(*lamp, ray, rays[0].sees_floor() ? &middle : nullptr);
            const double place = place_in_table(light.path_m);
            if (light.diffuse == 0.0 || place < 0.0 || place >= table_.steps.count) continue;
            const double left =
                std::exp(-signal.dispersed_diffuse.K_per_m(wavelength) * light.path_m);
            for (std::size_t c = 0; c < kChannels; ++c) {
                const auto channel = static_cast<Eigen::Index>(c);
                sum[c] +=
                    left * light.diffuse * signal.dispersed_diffuse.weights(wavelength, channel);
                if (signal.highlight.empty()) continue;
                sum[c] += left * light.highlight *
                          signal.dispersed_highlight.weights(wavelength, channel);
            }
        }
    }
    return sum;
}

}  // namespace aphotic
