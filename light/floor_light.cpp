// SPDX-License-Identifier: BSD-3-Clause
#include "light/floor_light.h"

#include "base/degrees.h"
#include "base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
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

constexpr double kLeastSquare = std::numeric_limits<double>::min();

// That of clear water: light attenuated so much that it needs more contributes little to a signal.
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

// Adds factor * T for lanes whose places lie in one step of the table.
void add_of_step(const std::vector<float>& table,
                 double step,
                 const Lanes& place,
                 const Lanes& factor,
                 LaneSignals& signals) {
    const float* const cubic = &table[static_cast<std::size_t>(step) * kTableStride];
    for_each_pack([&](std::size_t k) {
        const Pack t = place.pack(k) - step;
        for (std::size_t c = 0; c < kChannels; ++c) {
            const auto of_degree = [&](std::size_t degree) {
                return Pack(static_cast<double>(cubic[c + degree * kTableLanes]));
            };
            const Pack T =
                of_degree(0) + t * (of_degree(1) + t * (of_degree(2) + t * of_degree(3)));
            signals[c].set_pack(k, signals[c].pack(k) + factor.pack(k) * T);
        }
    });
}

// The same for any lanes; those without light or past the table's `steps` add nothing.
void add_signals(const std::vector<float>& table,
                 double steps,
                 const Lanes& place,
                 const Lanes& factor,
                 LaneSignals& signals) {
    const double step = std::floor(place[0]);
    if (step >= 0.0 && step < steps &&
        std::ranges::all_of(place.lane, [&](double p) { return p >= step && p < step + 1.0; })) {
        add_of_step(table, step, place, factor, signals);
        return;
    }
    for (std::size_t k = 0; k < kLanes; ++k) {
        if (factor[k] == 0.0 || !(place[k] >= 0.0 && place[k] < steps)) continue;
        const double own_step = std::floor(place[k]);
        const double t = place[k] - own_step;
        const float* const cubic = &table[static_cast<std::size_t>(own_step) * kTableStride];
        for (std::size_t c = 0; c < kChannels; ++c) {
            const double c_0 = cubic[c];
            const double c_1 = cubic[c + kTableLanes];
            const double c_2 = cubic[c + 2 * kTableLanes];
            const double c_3 = cubic[c + 3 * kTableLanes];
            signals[c][k] += factor[k] * (c_0 + t * (c_1 + t * (c_2 + t * c_3)));
        }
    }
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
    if (!disperses(rig)) return index_nodes_nm(rig);
    const std::vector<double> nodes_nm = index_nodes_nm(rig, kLooks);
    std::vector<double> looks;
    for (const std::size_t node : kLookOrder) looks.push_back(nodes_nm[node]);
    return looks;
}

CameraRays::CameraRays(const Rig& rig, int threads)
    : has_port_(disperses(rig)), table_(rig, place_rays_nm(rig), threads) {}

CameraRays::CameraRays(const Rig& rig, double lambda_nm, int threads)
    : has_port_(false), table_(rig, {lambda_nm}, threads) {}

PlaceRays CameraRays::at(double column, double row, const Plane& floor) const {
    std::array<WaterRay, kIndexNodes> found;
    table_.look(column, row, std::span(found).first(nodes()));
    PlaceRays rays;
    for (std::size_t k = 0; k < nodes(); ++k) rays[k] = floor_ray(found[k], floor);
    return rays;
}

LaneRays CameraRays::at(const Lanes& column,
                        const Lanes& row,
                        const LanePlane& floor,
                        bool looks) const {
    LaneRays rays;
    rays.count = looks && has_port_ ? kLooks : nodes();
    const std::span<LaneRay> found = std::span(rays.ray).first(rays.count);
    table_.look(column, row, found);
    for (LaneRay& ray : found) meet(floor, ray);
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
      lane_floor_(every_lane(floor_)) {
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
                              .floor_m = every_lane(height_above(floor_, position_m)),
                              .share = share,
                              .strobe = s});
        }
    }
}

FloorLight::LaneArrival FloorLight::arrive(const FloorLamp& lamp,
                                           const LaneRay& ray,
                                           const LaneArrival* from) const {
    LaneArrival found;
    for_each_pack([&](std::size_t k) {
        const PackVector V = towards(lamp.position_m, ray, k);
        // Not 0 even where a floor is seen edge on.
        const Pack length = root(dot(V, V) + kLeastSquare);
        const Arriving<Pack> even =
            arriving(lamp.floor_m.pack(k), ray.height_m.pack(k), ray.down.pack(k), length);
        set_pack(found.towards, k, V);
        found.length.set_pack(k, length);
        found.diffuse.set_pack(k, lamp.share * even.per_area);  // so far
        found.place.set_pack(k, (even.path_m - table_.steps.first_m) * table_.steps.steps_per_m);
    });
    const BeamLight& beam = strobes_[lamp.strobe].beam;
    const Lanes I = from == nullptr
                        ? beam.at(found.towards, found.length)
                        : beam.continued(found.towards, found.length, from->towards, from->length);
    for_each_pack(
        [&](std::size_t k) { found.diffuse.set_pack(k, I.pack(k) * found.diffuse.pack(k)); });
    if (rig_.seafloor.phong == 0.0) return found;
    for (std::size_t k = 0; k < kLanes; ++k) {
        const double along = vector_of_lane(ray.direction, k).dot(vector_of_lane(found.towards, k));
        found.highlight[k] =
            found.diffuse[k] == 0.0
                ? 0.0
                : lamp.share * I[k] *
                      highlight_per_area(
                          rig_.seafloor, lamp.floor_m[k], ray.down[k], along, found.length[k]);
    }
    return found;
}

void FloorLight::add(const FloorLamp& lamp, const LaneRays& rays, LaneLight& light) const {
    const LampSignal& signal = *strobes_[lamp.strobe].signal;
    const double steps = table_.steps.count;
    std::array<LaneArrival, kIndexNodes> at_nodes;
    Lanes last_place = every_lane(-1.0);
    for (std::size_t j = 0; j < rays_.nodes(); ++j) {
        LaneArrival& found = at_nodes[j];
        found = arrive(lamp, rays.ray[j], j == 0 ? nullptr : at_nodes.data());
        for_each_pack([&](std::size_t k) {
            const Pack place = found.place.pack(k);
            const auto is_lit = found.diffuse.pack(k) != 0.0;
            light.is_before |= any_of(is_lit && place < 0.0);
            light.is_beyond |= any_of(is_lit && place >= steps);
            Pack last = last_place.pack(k);
            where(is_lit && place >= 0.0 && place < steps, last) = place;
            last_place.set_pack(k, last);
        });
        const std::size_t node = rays_.nodes() > 1 ? kNodeOrder[j] : 0;
        add_signals(signal.diffuse[node], steps, found.place, found.diffuse, light.signals);
        if (!signal.highlight.empty())
            add_signals(signal.highlight[node], steps, found.place, found.highlight, light.signals);
    }
    if (rays.count == kLooks) look_between(lamp, rays, at_nodes, last_place, light);
}

void FloorLight::look_between(const FloorLamp& lamp,
                              const LaneRays& rays,
                              const std::array<LaneArrival, kIndexNodes>& at_nodes,
                              const Lanes& last_place,
                              LaneLight& light) const {
    const StrobeLight& strobe = strobes_[lamp.strobe];
    Lanes diffuse = every_lane(0.0);
    Lanes highlight = every_lane(0.0);
    for (std::size_t h = 0; h < kHalfWay.size(); ++h) {
        const LaneArrival found = arrive(lamp, rays.ray[kIndexNodes + h], at_nodes.data());
        const auto compare = [&](const auto& of, Lanes& most) {
            for_each_pack([&](std::size_t k) {
                Pack off = of(found).pack(k);
                for (std::size_t j = 0; j < kIndexNodes; ++j)
                    off -= kHalfWay[h][j] * of(at_nodes[j]).pack(k);
                most.set_pack(k, max(most.pack(k), abs(off)));
            });
        };
        compare([](const LaneArrival& one) -> const Lanes& { return one.diffuse; }, diffuse);
        if (rig_.seafloor.phong != 0.0)
            compare([](const LaneArrival& one) -> const Lanes& { return one.highlight; },
                    highlight);
    }
    for (const std::vector<float>& table : strobe.signal->diffuse)
        add_signals(table, table_.steps.count, last_place, diffuse, light.doubts);
    for (const std::vector<float>& table : strobe.signal->highlight)
        add_signals(table, table_.steps.count, last_place, highlight, light.doubts);
    for (std::size_t k = 0; k < kLanes && !strobe.steep.empty(); ++k) {
        const bool sees_all =
            std::ranges::all_of(std::span(rays.ray).first(kIndexNodes),
                                [&](const LaneRay& ray) { return ray.down[k] > 0.0; });
        if (last_place[k] < 0.0 || !sees_all) continue;
        const std::array<Vector3d, kIndexNodes> ways{vector_of_lane(at_nodes[0].towards, k),
                                                     vector_of_lane(at_nodes[1].towards, k),
                                                     vector_of_lane(at_nodes[2].towards, k)};
        light.crosses[k] |= std::ranges::any_of(
            strobe.steep, [&](const Crease& crease) { return crosses(crease, ways); });
    }
}

// kLanes wavelengths at a time.
Signals FloorLight::dispersed(std::span<const FloorLamp* const> lamps,
                              double column,
                              double row) const {
    std::array<LaneRay, kRayNodes> nodes;
    for (std::size_t j = 0; j < kRayNodes; ++j) {
        const WaterRay ray = pixel_ray(rig_, column, row, table_.ray_nodes_nm[j]);
        nodes[j].origin_m = every_lane(ray.origin_m);
        nodes[j].direction = every_lane(ray.direction);
    }
    meet(lane_floor_, nodes[kRayNodes / 2]);
    std::vector<LaneArrival> middle;
    for (const FloorLamp* lamp : lamps)
        middle.push_back(arrive(*lamp, nodes[kRayNodes / 2], nullptr));
    Signals sum{};
    const std::size_t wavelengths = table_.ray_shares.size();
    for (std::size_t first = 0; first < wavelengths; first += kLanes) {
        const std::size_t count = std::min(kLanes, wavelengths - first);
        LaneRay ray{.origin_m = every_lane(Vector3d::Zero()),
                    .direction = every_lane(Vector3d::Zero()),
                    .down = {},
                    .height_m = {}};
        for (std::size_t j = 0; j < kRayNodes; ++j) {
            Lanes share;
            for (std::size_t k = 0; k < kLanes; ++k)
                share[k] = table_.ray_shares[first + std::min(k, count - 1)][j];
            for_each_pack([&](std::size_t k) {
                const auto add_share = [&](LaneVector& v, const LaneVector& of_node) {
                    for (std::size_t i = 0; i < v.size(); ++i)
                        v[i].set_pack(k, v[i].pack(k) + share.pack(k) * of_node[i].pack(k));
                };
                add_share(ray.origin_m, nodes[j].origin_m);
                add_share(ray.direction, nodes[j].direction);
            });
        }
        meet(lane_floor_, ray);
        for (std::size_t l = 0; l < lamps.size(); ++l) {
            const LampSignal& signal = *strobes_[lamps[l]->strobe].signal;
            const LaneArrival found = arrive(*lamps[l], ray, &middle[l]);
            for (std::size_t k = 0; k < count; ++k) {
                const double place = found.place[k];
                if (found.diffuse[k] == 0.0 || place < 0.0 || place >= table_.steps.count) continue;
                const double path_m = table_.steps.first_m + place / table_.steps.steps_per_m;
                const auto wavelength = static_cast<Eigen::Index>(first + k);
                const double left =
                    std::exp(-signal.dispersed_diffuse.K_per_m(wavelength) * path_m);
                for (std::size_t c = 0; c < kChannels; ++c) {
                    const auto channel = static_cast<Eigen::Index>(c);
                    sum[c] += left * found.diffuse[k] *
                              signal.dispersed_diffuse.weights(wavelength, channel);
                    if (signal.highlight.empty()) continue;
                    sum[c] += left * found.highlight[k] *
                              signal.dispersed_highlight.weights(wavelength, channel);
                }
            }
        }
    }
    return sum;
}

}  // namespace aphotic
