// SPDX-License-Identifier: BSD-3-Clause
//
// The manifest of an atlas from any text, and the bins about a point that may lie within its axes.
#include "fuzz.h"
#include "lightmap/atlas.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    aphotic::expect_result_or_placed_error("atlas.json", [&] {
        const aphotic::AtlasManifest manifest =
            aphotic::parse_atlas(aphotic::text_of(data, size), "atlas.json");
        for (const aphotic::MapPoint& point : aphotic::points_of(manifest.axes)) {
            static_cast<void>(aphotic::neighbours_of(manifest.axes, point));
        }
    });
    return 0;
}
