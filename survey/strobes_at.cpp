// SPDX-License-Identifier: BSD-3-Clause
#include "survey/strobes_at.h"

#include "light/path_range.h"
#include "lightmap/design.h"
#include "lightmap/planes.h"

#include <map>
#include <memory>
#include <mutex>

namespace aphotic {
namespace {

constexpr int kCoarse_px = 4 * kCells;  // along the longer side
constexpr double kCoarseError = 1e-3;
constexpr double kCoarseVeil = 1e-2;

// Maps of some strobes alone, made when the first image asks for them.
struct LitMaps {
    Rig rig;
    PathRange paths;
    LightmapOptions options;
    std::mutex mutex{};
    std::map<std::uint64_t, std::shared_ptr<const LightmapMaker>> makers{};

    std::shared_ptr<const LightmapMaker> without(std::uint64_t out) {
        const std::scoped_lock lock(mutex);
        std::shared_ptr<const LightmapMaker>& maker = makers[out];
        if (maker) return maker;
        Rig lit = rig;
        lit.strobes.clear();
        for (std::size_t s = 0; s < rig.strobes.size(); ++s)
            if ((out >> s & 1U) == 0) lit.strobes.push_back(rig.strobes[s]);
        maker = std::make_shared<const LightmapMaker>(lit, paths, options);
        return maker;
    }
};

}  // namespace

StrobesAt strobes_of_rig(const Rig& rig,
                         const Navigation& navigation,
                         const std::vector<ImageFile>& files,
                         bool has_veil,
                         double veil_tolerance) {
    if (rig.strobes.size() > kMostStrobes) return {};
    const PathRange paths = paths_of_survey(rig, sleds_of(navigation, files));
    const Rig coarse = with_longer_side(rig, kCoarse_px);
    const auto makers = std::make_shared<std::vector<LightmapMaker>>();
    StrobesAt at;
    for (const RigPart& part : parts_by_strobe(coarse)) {
        at.names.push_back(part.name);
        makers->emplace_back(
            part.rig,
            paths,
            LightmapOptions{
                .error = kCoarseError, .has_veil = has_veil, .veil_tolerance = kCoarseVeil});
    }
    at.cells = [makers,
                side = cells_across(rig.camera.width_px, rig.camera.height_px)](const Sled& sled) {
        std::vector<CellPlane> cells;
        for (const LightmapMaker& maker : *makers) cells.push_back(cells_of(maker.map(sled), side));
        return cells;
    };
    const auto lit = std::make_shared<LitMaps>(
        rig, paths, LightmapOptions{.has_veil = has_veil, .veil_tolerance = veil_tolerance});
    at.map_without = [lit](const Sled& sled, std::uint64_t out) {
        return lit->without(out)->map(sled);
    };
    return at;
}

}  // namespace aphotic
