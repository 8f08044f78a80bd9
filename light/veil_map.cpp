// SPDX-License-Identifier: BSD-3-Clause
#include "light/veil_map.h"

#include "light/dispersion.h"
#include "light/signal_table.h"
#include "light/steep_crease.h"
#include "light/tile_cone.h"
#include "rig/geometry.h"
#include "spectral/light_family.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

namespace aphotic {
namespace {

constexpr double kVeilGridShare = 0.1;
constexpr double kVeilTableShare = 0.5;
// Shares of the tolerance: at edges a polynomial is off by a few times its error elsewhere, and the
// errors of several parts add up.
constexpr double kOffBetween = 0.1;
constexpr double kLastDegrees = 0.3;

// Over the wavelengths that are scattered.
double least_loss_per_m(const Rig& rig) {
    double least = std::numeric_limits<double>::infinity();
    for (const double nm : union_of_knots(rig.water.curves(), rig.camera.range)) {
        for (std::size_t i = 0; i < rig.water.scatterers.size(); ++i) {
            if (rig.water.scattering_per_m(i, nm) > 0.0)
                least = std::min(least, rig.water.attenuation_per_m(nm));
        }
    }
    return least;
}

PathRange veil_paths(const Rig& rig, const PathRange& direct) {
    double shortest_m = std::numeric_limits<double>::infinity();
    for (const Strobe& strobe : rig.strobes) {
        shortest_m = std::min(
            shortest_m, strobe.position_m.norm() - port_reach_m(rig) - emitter_reach_m(strobe));
    }
    PathRange paths{.shortest_m = std::max(0.0, shortest_m), .longest_m = direct.longest_m};
    constexpr double kSome_m = 1.0;
    const double least_per_m = least_loss_per_m(rig);
    if (!std::isfinite(least_per_m)) {
        paths.longest_m = std::max(paths.longest_m, paths.shortest_m + kSome_m);
        return paths;
    }
    const double dark_m = kVeilDepth / least_per_m;
    if (direct.has_horizon || direct.longest_m == 0.0) paths.longest_m = dark_m;
    // However long the paths, the table ends where the light is lost.
    paths.longest_m = std::clamp(
        paths.longest_m, paths.shortest_m + std::min(kSome_m, dark_m), paths.shortest_m + dark_m);
    return paths;
}

VeilGrid grid_of_signals(const Rig& rig, const PathRange& paths, double error) {
    LightFamily family{.sources = {},
                       .water = rig.water,
                       .shortest_path_m = paths.shortest_m,
                       .longest_path_m = paths.longest_m};
    for (const Strobe& strobe : rig.strobes) {
        for (const Scatterer& scatterer : rig.water.scatterers)
            family.sources.push_back({strobe.spectrum, scatterer.scattering_per_m});
    }
    return reference_grid(rig.camera.sensor, family, rig.camera.range, kVeilGridShare * error);
}

}  // namespace

VeilMap::VeilMap(const Rig& rig,
                 const PathRange& direct,
                 double error,
                 unsigned points,
                 std::span<const double> lambda_nm,
                 bool has_signals)
    : rig_(rig), veil_(rig, points) {
    constexpr double kAny_rad = 0.5;
    for (const Strobe& strobe : rig.strobes) {
        for (const Beam& part : parts_of(strobe.beam)) {
            if (!is_dark(part))
                widest_rad_.push_back(std::min(kAny_rad, 2.0 * narrowest_rad(part)));
        }
    }
    const PathRange paths = veil_paths(rig, direct);
    if (has_signals) {
        grids_.push_back(grid_of_signals(rig, paths, error));
        index_nodes_nm_ = place_rays_nm(rig);
        index_nodes_nm_.resize(disperses(rig) ? kIndexNodes : 1);
    } else {
        index_nodes_nm_ = {lambda_nm.front()};
    }
    planes_ = (has_signals ? kChannels : 0) + lambda_nm.size();
    assert(planes_ <= kVeilPlanes);
    for (std::size_t k = 0; k < lambda_nm.size(); ++k) {
        if (k % kChannels == 0) grids_.emplace_back();
        grids_.back().push_back({.lambda_nm = lambda_nm[k]});
        grids_.back().back().weight[k % kChannels] = 1.0;
    }
    tabulate(paths, error);
}

void VeilMap::tabulate(const PathRange& paths, double error) {
    const std::vector<const Spectrum*> lamps = lamps_of(rig_, lamp_of_strobe_);
    const auto for_each_table = [&](const auto& take) {
        for (const Spectrum* lamp : lamps) {
            for (std::size_t i = 0; i < rig_.water.scatterers.size(); ++i) {
                for (const VeilGrid& grid : grids_)
                    take(grid, [&, i](double nm) {
                        return lamp->at(nm) * rig_.water.scattering_per_m(i, nm);
                    });
            }
        }
    };
    for_each_table([&](const VeilGrid& grid, const LightOf& light) {
        const PathSteps steps =
            path_steps(spectral_sum(rig_.water, grid, light), paths, kVeilTableShare * error);
        if (steps.count > steps_.count) steps_ = steps;
    });
    for (std::size_t j = 0; j < index_nodes_nm_.size(); ++j) {
        for_each_table([&](const VeilGrid& grid, const LightOf& light) {
            const SpectralSum sum = spectral_sum(rig_.water, grid, [&](double nm) {
                return index_share(rig_, index_nodes_nm_, j, nm) * light(nm);
            });
            tables_.push_back(path_table(sum, steps_));
        });
    }
}

namespace {

WaterRay water_ray(const FloorRay& ray) {
    return {.origin_m = ray.origin_m, .direction = ray.direction};
}

double to_floor_m(const FloorRay& ray) {
    return ray.sees_floor() ? ray.height_m / ray.down : std::numeric_limits<double>::infinity();
}

}  // namespace

VeilMap::Signal VeilMap::at(const PlaceRays& rays,
                            VeilNodes& nodes,
                            std::optional<double> length_m) const {
    Signal sum{};
    for (std::size_t j = 0; j < index_nodes_nm_.size(); ++j) {
        for (std::size_t part = 0; part < veil_.strobe_of_part().size(); ++part) {
            veil_.nodes(part, water_ray(rays[j]), length_m.value_or(to_floor_m(rays[j])), nodes);
            add(nodes, veil_.strobe_of_part()[part], j, sum);
        }
    }
    return sum;
}

void VeilMap::add(const VeilNodes& nodes, std::size_t strobe, std::size_t ray, Signal& sum) const {
    const std::size_t scatterers = rig_.water.scatterers.size();
    const std::size_t of_ray = tables_.size() / index_nodes_nm_.size();
    const std::vector<float>* const tables =
        &tables_[ray * of_ray + lamp_of_strobe_[strobe] * scatterers * grids_.size()];
    std::array<std::array<float, kTableLanes>, kVeilPlanes / kChannels> lanes{};
    for (std::size_t n = 0; n < nodes.path_m.size(); ++n) {
        const double place = (nodes.path_m[n] - steps_.first_m) * steps_.steps_per_m;
        // Rounding may leave the range slightly. Beyond the horizon's end no light remains.
        if (place > steps_.count + 0.01) continue;
        const int step = std::clamp(static_cast<int>(place), 0, steps_.count - 1);
        const auto t = static_cast<float>(place - step);
        for (std::size_t k = 0; k < scatterers * grids_.size(); ++k) {
            const float* const T = &tables[k][static_cast<std::size_t>(step) * kTableStride];
            const auto weight = static_cast<float>(nodes.weight[k / grids_.size()][n]);
            for (std::size_t c = 0; c < kTableLanes; ++c) {
                const float signal =
                    T[c] + t * (T[kTableLanes + c] +
                                t * (T[2 * kTableLanes + c] + t * T[3 * kTableLanes + c]));
                lanes[k % grids_.size()][c] += weight * signal;
            }
        }
    }
    for (std::size_t c = 0; c < planes_; ++c)
        sum[c] +=
            rig_.strobes[strobe].power * static_cast<double>(lanes[c / kChannels][c % kChannels]);
}

// The class that tile_image.h requires. Pieces are parts of beams.
class VeilTiles : public TileLight {
  public:
    using Piece = std::size_t;
    using Group = std::vector<std::size_t>;
    struct Place {
        PixelPlace at;
        PlaceRays rays;
    };
    struct Found {
        PlaceSignals signals{};
    };

    VeilTiles(const VeilMap& map,
              const Sled& sled,
              const CameraRays& rays,
              const FloorLight* floor,
              double tolerance)
        : map_(map), rays_(rays), plane_(floor_plane(sled)), floor_(floor), tolerance_(tolerance) {}

    [[nodiscard]] std::size_t planes() const { return map_.planes_; }

    [[nodiscard]] std::vector<Group> split(const Tile& tile,
                                           const Group& parts,
                                           Group& rest) const {
        std::vector<FloorRay> rays;
        for (const auto& [x, y] : tile_places(tile.width, tile.height))
            rays.push_back(rays_.at(tile.column + x + 0.5, tile.row + y + 0.5, plane_)[0]);
        std::vector<Group> groups;
        for (const std::size_t part : parts) {
            const Eigen::Vector3d& lamp_m =
                map_.rig_.strobes[map_.veil_.strobe_of_part()[part]].position_m;
            const TileCone ends = tile_cone(lamp_m, rays);
            const double turn_rad = std::max(plane_cone(lamp_m, rays).radius_rad,
                                             ends.sees_all ? ends.radius_rad : 0.0);
            if (turn_rad <= map_.widest_rad_[part])
                groups.push_back({part});
            else
                rest.push_back(part);
        }
        return groups;
    }

    static const Group& all_of(const Group& parts) { return parts; }
    static void give_back(const Group& parts, Group& rest) { rest.push_back(parts.front()); }

    [[nodiscard]] Place place(const std::array<PixelPlace, 1>& at, bool /*is_exact*/) const {
        return {.at = at[0], .rays = rays_.at(at[0][0], at[0][1], plane_)};
    }

    [[nodiscard]] Found find(const Group& parts, const Place& place, bool /*is_exact*/) {
        Found found;
        for (std::size_t j = 0; j < map_.index_nodes_nm_.size(); ++j) {
            const FloorRay& ray = place.rays[j];
            for (const std::size_t part : parts) {
                map_.veil_.nodes(part, water_ray(ray), to_floor_m(ray), nodes_);
                map_.add(nodes_, map_.veil_.strobe_of_part()[part], j, found.signals);
            }
        }
        return found;
    }

    void beside(const Place& place, PlaceSignals& signals) const {
        if (floor_ == nullptr) return;
        LaneLight light;
        const LaneRays rays =
            floor_->rays_at(every_lane(place.at[0]), every_lane(place.at[1]), false);
        for (const FloorLamp& lamp : floor_->lamps()) floor_->add(lamp, rays, light);
        std::ranges::copy(light.of_lane(0).signals, signals.begin());
    }

    [[nodiscard]] bool is_right(const Found& found, const TileCheck& check) const {
        for (std::size_t c = 0; c < map_.planes_; ++c) {
            const double most = tolerance_ * check.signals[c];
            if (!(std::abs(check.interpolated[c] - found.signals[c]) <= kOffBetween * most &&
                  check.last_degrees[c] <= kLastDegrees * most))
                return false;
        }
        return true;
    }

  private:
    const VeilMap& map_;
    const CameraRays& rays_;
    Plane plane_;
    const FloorLight* floor_;
    double tolerance_;
    VeilNodes nodes_;
};

void VeilMap::paint(const Sled& sled,
                    const CameraRays& rays,
                    const FloorLight* floor,
                    double tolerance,
                    int threads,
                    const ImageRows& rows) const {
    std::vector<std::size_t> parts;
    for (std::size_t part = 0; part < veil_.strobe_of_part().size(); ++part)
        if (rig_.strobes[veil_.strobe_of_part()[part]].power > 0.0) parts.push_back(part);
    std::vector<VeilTiles> by_thread(static_cast<std::size_t>(threads),
                                     VeilTiles(*this, sled, rays, floor, tolerance));
    const auto quarter_px = static_cast<unsigned>(std::max(rows.width_px, rows.height_px)) / 4;
    const int tile_px = static_cast<int>(std::bit_floor(quarter_px));
    paint_tiles(by_thread, parts, std::clamp(tile_px, kLeastVeilTile_px, kVeilTile_px), rows);
}

}  // namespace aphotic
