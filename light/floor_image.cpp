// SPDX-License-Identifier: BSD-3-Clause
#include "light/floor_image.h"

#include "light/tile_cone.h"

#include <cmath>
#include <vector>

namespace aphotic {
namespace {

// A lamp and one of its creases that enters a tile; no crease: its light is too steep for the tile.
struct LampCrease {
    const FloorLamp* lamp = nullptr;
    const Crease* crease = nullptr;
};

bool is_in_doubt(const PlaceLight& light, const Signals& signals) {
    bool is = light.crosses;
    for (std::size_t c = 0; c < kChannels; ++c) is |= light.doubts[c] > kMostDoubt * signals[c];
    return is;
}

// The class that tile_image.h requires.
class FloorTiles : public TileLight {
  public:
    using Piece = LampCrease;
    using Group = std::vector<const FloorLamp*>;
    using Place = LaneRays;
    using Found = LaneLight;
    static constexpr std::size_t kLanes = aphotic::kLanes;

    explicit FloorTiles(const FloorLight& light) : light_(light) {}

    [[nodiscard]] const Outside& outside() const { return outside_; }

    static std::size_t planes() { return kChannels; }

    [[nodiscard]] std::vector<Group> split(const Tile& tile,
                                           const std::vector<LampCrease>& lamps,
                                           std::vector<LampCrease>& rest) const;

    static Group all_of(const std::vector<LampCrease>& lamps) {
        Group all;
        for (const LampCrease& one : lamps)
            if (all.empty() || all.back() != one.lamp) all.push_back(one.lamp);
        return all;
    }

    static void give_back(const Group& lamps, std::vector<LampCrease>& rest) {
        for (const FloorLamp* lamp : lamps) rest.push_back({.lamp = lamp});
    }

    [[nodiscard]] LaneRays place(const std::array<PixelPlace, kLanes>& at, bool is_exact) const {
        Lanes column;
        Lanes row;
        for (std::size_t k = 0; k < kLanes; ++k) {
            column[k] = at[k][0];
            row[k] = at[k][1];
        }
        return light_.rays_at(column, row, is_exact);
    }

    [[nodiscard]] LaneLight find(const Group& lamps,
                                 const LaneRays& rays,
                                 bool /*is_exact*/) const {
        LaneLight found;
        for (const FloorLamp* lamp : lamps) light_.add(*lamp, rays, found);
        return found;
    }

    static PlaceLight of_lane(const LaneLight& found, std::size_t k) { return found.of_lane(k); }

    static bool is_within(const PlaceLight& light) { return !light.is_before && !light.is_beyond; }

    static bool is_right(const PlaceLight& light, const TileCheck& check) {
        if (is_in_doubt(light, light.signals)) return false;
        for (std::size_t c = 0; c < kChannels; ++c) {
            if (!(std::abs(check.interpolated[c] - light.signals[c]) <=
                  kTileError / 3.0 * light.signals[c]))
                return false;
        }
        return true;
    }

    void settle(const Group& lamps,
                double column,
                double row,
                const LaneRays& /*rays*/,
                const PlaceSignals& signals,
                PlaceLight& light) {
        outside_.is_before |= light.is_before;
        outside_.is_beyond |= light.is_beyond;
        Signals all = light.signals;
        for (std::size_t c = 0; c < kChannels; ++c) all[c] += signals[c];
        if (is_in_doubt(light, all)) light.signals = light_.dispersed(lamps, column, row);
    }

  private:
    const FloorLight& light_;
    Outside outside_;
};

// The rays of a tile's places at all nodes, the middle one first.
std::vector<FloorRay> rays_of(const FloorLight& light, const Tile& tile) {
    std::vector<FloorRay> rays;
    for (const auto& [x, y] : tile_places(tile.width, tile.height)) {
        const PlaceRays all = light.rays_at(tile.column + x + 0.5, tile.row + y + 0.5);
        rays.insert(rays.end(), all.begin(), all.begin() + (light.has_port() ? kIndexNodes : 1));
    }
    return rays;
}

std::vector<FloorTiles::Group> FloorTiles::split(const Tile& tile,
                                                 const std::vector<LampCrease>& lamps,
                                                 std::vector<LampCrease>& rest) const {
    const std::vector<FloorRay> rays = rays_of(light_, tile);
    Group smooth;
    for (std::size_t k = 0; k < lamps.size();) {
        const FloorLamp* const lamp = lamps[k].lamp;
        const TileCone cone = tile_cone(lamp->position_m, rays);
        const std::size_t before = rest.size();
        if (cone.sees_any && !cone.sees_all) rest.push_back({.lamp = lamp});
        for (; k < lamps.size() && lamps[k].lamp == lamp; ++k) {
            const bool is_near = lamps[k].crease != nullptr && cone.sees_any &&
                                 (!cone.sees_all || comes_into(cone, *lamps[k].crease));
            if (is_near) rest.push_back(lamps[k]);
        }
        if (cone.sees_all && rest.size() == before) smooth.push_back(lamp);
    }
    return smooth.empty() ? std::vector<Group>{} : std::vector<Group>{smooth};
}

}  // namespace

Outside paint_floor(const FloorLight& light, int threads, const ImageRows& rows) {
    std::vector<LampCrease> lamps;
    for (const FloorLamp& lamp : light.lamps()) {
        lamps.push_back({.lamp = &lamp});
        for (const Crease& crease : light.creases(lamp))
            lamps.push_back({.lamp = &lamp, .crease = &crease});
    }
    std::vector<FloorTiles> by_thread(static_cast<std::size_t>(threads), FloorTiles(light));
    paint_tiles(by_thread, lamps, kFloorTile_px, rows);
    Outside all;
    for (const FloorTiles& one : by_thread) {
        all.is_before |= one.outside().is_before;
        all.is_beyond |= one.outside().is_beyond;
    }
    return all;
}

}  // namespace aphotic
