// SPDX-License-Identifier: BSD-3-Clause
//
// The light that one image of a survey was taken in: on its own relief, where the survey has depth
// maps (relief/floor_relief.h), or else on the plane that the navigation tells.
#pragma once

#include "survey/survey.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace aphotic {

struct ImageLight {
    Lightmap map;
    std::vector<std::uint8_t> edges;   // by pixel: an edge of light comes within so many pixels
    std::vector<std::uint8_t> filled;  // its range is a guess; empty on a plane
};

// An InputError of this one image where its pose or its depth map is missing or cannot be.
// out: strobes that did not fire, by their bits.
[[nodiscard]] ImageLight light_of(const Survey& survey,
                                  const ImageFile& file,
                                  int within_px,
                                  std::uint64_t out = 0);

// The floor that it shows, of a survey with depth maps.
[[nodiscard]] FloorRelief relief_of(const Survey& survey, const ImageFile& file);

// In cells, by strobe: of a survey that knows its light strobe by strobe.
[[nodiscard]] std::vector<CellPlane> strobe_cells_of(const Survey& survey, const ImageFile& file);

// Of its file, or of the survey's mesh, at this size.
[[nodiscard]] DepthMap depth_map_of(const Survey& survey, const ImageFile& file, PlaneSize size);

// Its pose; none where depth maps do without.
[[nodiscard]] std::optional<Sled> sled_of(const Survey& survey, const ImageFile& file);

// All that its light depends on, but for the survey's settings.
[[nodiscard]] std::string light_inputs(const Survey& survey, const ImageFile& file);

// What to hold an image with a depth map against.
struct OtherDepth {
    double depth_m = 0.0;                         // the median of its map, along the axis
    std::optional<Lightmap> by_other_convention;  // DepthIs; of maps from files
    std::optional<Lightmap> plane;                // of the navigation, where there is one
};
// None without depth maps.
[[nodiscard]] std::optional<OtherDepth> other_depth(const Survey& survey, const ImageFile& file);

}  // namespace aphotic
