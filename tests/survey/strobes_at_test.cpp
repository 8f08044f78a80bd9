// SPDX-License-Identifier: BSD-3-Clause
#include "survey/strobes_at.h"
#include "support/scene_text.h"

#include "rig/file/rig_reader.h"

#include <gtest/gtest.h>

#include <cmath>

namespace aphotic {
namespace {

// Light adds up: that of each strobe is what the whole map has more than that of the others.
TEST(StrobesAt, IsWhatTheMapHasMoreThanThatOfTheOthers) {
    const Rig rig = read_rig(scene_file("survey/smooth.toml"));
    const Sled sled{.altitude_m = 2.0, .pitch_rad = 0.05, .roll_rad = -0.03};
    const Navigation navigation("flown", {{.image = "a", .sled = sled}});
    const std::vector<ImageFile> files{{.source = "a.tif", .name = "a.tif"}};
    const StrobesAt strobes = strobes_of_rig(rig, navigation, files);
    ASSERT_EQ(strobes.names, (std::vector<std::string>{"fore", "aft", "port", "starboard"}));
    const std::vector<CellPlane> cells = strobes.cells(sled);
    const LightmapMaker maker(rig, paths_of(rig, {sled}), {});
    const CellPlane all = cells_of(maker.map(sled), kCells);
    constexpr double kCoarse = 5e-3;  // the middles of 4 x 3 coarse pixels for a cell's own
    for (std::size_t s = 0; s < 4; ++s) {
        const CellPlane rest = cells_of(strobes.map_without(sled, 1U << s), kCells);
        for (std::size_t k = 0; k < all.size(); ++k)
            ASSERT_NEAR(all[k] - rest[k], cells[s][k], kCoarse * all[k]) << s << " " << k;
    }
}

}  // namespace
}  // namespace aphotic
