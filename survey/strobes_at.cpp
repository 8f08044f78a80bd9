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

// Makers of maps for subsets of the strobes, each created on first use.
template <typename Maker>
struct MakersOfLit {
    using Make = std::function<std::shared_ptr<const Maker>(const Rig& lit)>;
    MakersOfLit(const Rig& whole, Make how) : rig(whole), make(std::move(how)) {}

    Rig rig;
    Make make;
    std::mutex mutex{};
    std::map<std::uint64_t, std::shared_ptr<const Maker>> makers{};

    std::shared_ptr<const Maker> without(std::uint64_t out) {
        const std::scoped_lock lock(mutex);
        std::shared_ptr<const Maker>& maker = makers[out];
        if (maker) return maker;
        Rig lit = rig;
        lit.strobes.clear();
        for (std::size_t s = 0; s < rig.strobes.size(); ++s)
            if ((out >> s & 1U) == 0) lit.strobes.push_back(rig.strobes[s]);
        maker = make(lit);
        return maker;
    }
};

using ReliefMakers = std::vector<std::unique_ptr<const ReliefMapMaker>>;

void add_relief(const Rig& rig,
                const std::vector<RigPart>& parts,
                const LightmapOptions& coarse,
                const LightmapOptions& options,
                StrobesAt& at) {
    const auto makers = std::make_shared<ReliefMakers>();
    for (const RigPart& part : parts)
        makers->push_back(std::make_unique<const ReliefMapMaker>(part.rig, coarse));
    const Camera& camera = parts.front().rig.camera;
    at.relief_cells =
        [makers,
         width_px = camera.width_px,
         height_px = camera.height_px,
         side = cells_across(rig.camera.width_px, rig.camera.height_px)](
            const DepthMap& map, const DepthMaps& as, const std::optional<Sled>& floor) {
            const FloorRelief relief = floor_relief(
                resized(map, width_px, height_px), as.is, as.normals, *makers->front(), floor);
            std::vector<CellPlane> cells;
            for (const auto& maker : *makers)
                cells.push_back(cells_of(maker->map(relief.relief, 0).map, side));
            return cells;
        };
    const auto lit = std::make_shared<MakersOfLit<ReliefMapMaker>>(rig, [options](const Rig& of) {
        return std::make_shared<const ReliefMapMaker>(of, options);
    });
    at.relief_without = [lit](std::uint64_t out) { return lit->without(out); };
}

}  // namespace

StrobesAt strobes_of_rig(const Rig& rig,
                         const std::optional<Navigation>& navigation,
                         const std::vector<ImageFile>& files,
                         bool has_veil,
                         double veil_tolerance,
                         bool has_relief) {
    if (rig.strobes.size() > kMostStrobes) return {};
    const PathRange paths = paths_of_survey(rig, sleds_of(navigation, files));
    const Rig coarse = with_longer_side(rig, kCoarse_px);
    const auto makers = std::make_shared<std::vector<LightmapMaker>>();
    StrobesAt at;
    const std::vector<RigPart> parts = parts_by_strobe(coarse);
    const LightmapOptions as_coarse{
        .error = kCoarseError, .has_veil = has_veil, .veil_tolerance = kCoarseVeil};
    for (const RigPart& part : parts) {
        at.names.push_back(part.name);
        makers->emplace_back(part.rig, paths, as_coarse);
    }
    at.cells = [makers,
                side = cells_across(rig.camera.width_px, rig.camera.height_px)](const Sled& sled) {
        std::vector<CellPlane> cells;
        for (const LightmapMaker& maker : *makers) cells.push_back(cells_of(maker.map(sled), side));
        return cells;
    };
    const LightmapOptions options{.has_veil = has_veil, .veil_tolerance = veil_tolerance};
    const auto lit =
        std::make_shared<MakersOfLit<LightmapMaker>>(rig, [paths, options](const Rig& of) {
            return std::make_shared<const LightmapMaker>(of, paths, options);
        });
    at.map_without = [lit](const Sled& sled, std::uint64_t out) {
        return lit->without(out)->map(sled);
    };
    if (has_relief) add_relief(rig, parts, as_coarse, options, at);
    return at;
}

}  // namespace aphotic
