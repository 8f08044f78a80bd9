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

// The index nodes of light in the order of PlaceRays, and those of twice as many; then the weights
// of the first at the last two.
constexpr std::array<std::size_t, kIndexNodes> kNodeOrder{1, 0, 2};
constexpr std::array<std::size_t, kLooks> kLookOrder{2, 0, 4, 1, 3};
constexpr std::array<std::array<double, kIndexNodes>, kLooks - kIndexNodes> kHalfWay{
    {{0.75, 0.375, -0.125}, {0.75, -0.125, 0.375}}};

// As in clear water: of the light that matters to a signal, little is attenuated so much that it
// needs more.
LampGrid grid_of_lamps(const Rig& rig, const Strobe& strobe) {
    constexpr double kMostLamps = 1e5;  // a map adds up the lamps at each pixel
    const LampGrid grid = lamp_grid(rig, strobe, 0.0);
    if (static_cast<double>(grid.across) * grid.along > kMostLamps) {
        throw InputError(
            "strobe '{}': found an emitter that needs {} x {} lamps this close to the floor; "
            "allowed: up to {}",
            strobe.name,
            grid.across,
            grid.along,
            kMostLamps);
    }
    return grid;
}

// add_signal() for lanes whose places lie in one step of the table.
void add_of_step(const std::vector<float>& table,
                 double step,
                 const Lanes& place,
                 const Lanes& factor,
                 LaneLight& light) {
    const float* const cubic = &table[static_cast<std::size_t>(step) * kTableStride];
    for_each_pack([&](std::size_t k) {
        const Pack t = place.pack(k) - step;
        for (std::size_t c = 0; c < kChannels; ++c) {
            const auto of_degree = [&](std::size_t degree) {
                return Pack(static_cast<double>(cubic[c + degree * kTableLanes]));
            };
            const Pack T =
                of_degree(0) + t * (of_degree(1) + t * (of_degree(2) + t * of_degree(3)));
            Lanes& signals = light.signals[c];
            signals.set_pack(k, signals.pack(k) + factor.pack(k) * T);
        }
    });
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
            require_over_floor(sled, strobe, {});  // otherwise no number of lamps is enough
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
    : rig_(rig),
      table_(table),
      rays_(rays),
      floor_(floor_plane(sled)),
      pupil_m_(height_above(floor_, Vector3d::Zero())) {
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

double FloorLight::shine(const LampSignal& signal,
                         std::size_t node,
                         const FloorArrival& arrived,
                         PlaceLight& light) const {
    if (arrived.diffuse == 0.0) return -1.0;
    const double place = place_in_table(arrived.path_m);
    light.is_before |= place < 0.0;
    light.is_beyond |= place >= table_.steps.count;
    if (place < 0.0 || place >= table_.steps.count) return -1.0;
    add_signal(signal.diffuse[node], place, arrived.diffuse, light.signals);
    if (!signal.highlight.empty())
        add_signal(signal.highlight[node], place, arrived.highlight, light.signals);
    return place;
}

LaneRays FloorLight::rays_at(const Lanes& column, const Lanes& row) const {
    LaneRays rays{.direction = rays_.in_air(column, row), .down = {}};
    if (pupil_m_ <= 0.0) return rays;
    for_each_pack([&](std::size_t k) {
        const Pack down = -dot(floor_.normal, pack(rays.direction, k));
        rays.down.set_pack(k, std::experimental::max(down, Pack(0.0)));
    });
    return rays;
}

void FloorLight::add(const FloorLamp& lamp, const LaneRays& rays, LaneLight& light) const {
    const StrobeLight& strobe = strobes_[lamp.strobe];
    LaneVector V;
    Lanes length;
    Lanes diffuse;
    Lanes path_m;
    Lanes along;
    for_each_pack([&](std::size_t k) {
        const PackVector D = pack(rays.direction, k);
        const Pack down = rays.down.pack(k);
        PackVector way;
        for (std::size_t i = 0; i < 3; ++i)
            way[i] = pupil_m_ * D[i] - lamp.position_m(static_cast<Eigen::Index>(i)) * down;
        const Pack d = root(dot(way, way));
        const Arriving<Pack> even = arriving(lamp.floor_m, pupil_m_, down, d);
        set_pack(V, k, way);
        length.set_pack(k, d);
        diffuse.set_pack(k, even.per_area);  // so far
        path_m.set_pack(k, even.path_m);
        along.set_pack(k, dot(D, way));
    });
    const Lanes I = strobe.beam.at(V, length);
    Lanes place;
    for_each_pack([&](std::size_t k) {
        diffuse.set_pack(k, lamp.share * I.pack(k) * diffuse.pack(k));
        place.set_pack(k, (path_m.pack(k) - table_.steps.first_m) * table_.steps.steps_per_m);
    });
    const double step = std::floor(place[0]);
    const bool is_of_one_step =
        step >= 0.0 && step < table_.steps.count &&
        std::ranges::all_of(place.lane, [&](double p) { return p >= step && p < step + 1.0; });
    const LampSignal& signal = *strobe.signal;
    if (is_of_one_step && signal.highlight.empty()) {
        add_of_step(signal.diffuse[0], step, place, diffuse, light);
        return;
    }
    for (std::size_t k = 0; k < kLanes; ++k) {
        FloorArrival arrived{.diffuse = diffuse[k], .path_m = path_m[k]};
        if (rig_.seafloor.phong != 0.0 && arrived.diffuse != 0.0)
            arrived.highlight =
                lamp.share * I[k] *
                highlight_per_area(rig_.seafloor, lamp.floor_m, rays.down[k], along[k], length[k]);
        PlaceLight one;
        shine(signal, 0, arrived, one);
        for (std::size_t c = 0; c < kChannels; ++c) light.signals[c][k] += one.signals[c];
        light.is_before |= one.is_before;
        light.is_beyond |= one.is_beyond;
    }
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
        const std::size_t node = rays_.nodes() > 1 ? kNodeOrder[j] : 0;
        const double place = shine(signal, node, at_nodes[j], light);
        if (place >= 0.0) last_place = place;
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
