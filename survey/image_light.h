// SPDX-License-Identifier: BSD-3-Clause
//
// The light in which one image of a survey was taken: on its own relief, if the survey has depth
// maps (relief/floor_relief.h), otherwise on the plane given by the navigation.
#pragma once

#include "survey/survey.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace aphotic {

struct ImageLight {
    Lightmap map;
    std::vector<std::uint8_t> edges;   // by pixel: an edge of light lies within within_px
    std::vector<std::uint8_t> filled;  // its range is a guess; empty on a plane
};

// An InputError for this one image if its pose or depth map is missing or impossible. out: bits of
// the strobes that did not fire.
[[nodiscard]] ImageLight light_of(const Survey& survey,
                                  const ImageFile& file,
                                  int within_px,
                                  std::uint64_t out = 0);

// The floor that it shows, for a survey with depth maps.
[[nodiscard]] FloorRelief relief_of(const Survey& survey, const ImageFile& file);

// In cells, by strobe, for a survey whose light is known strobe by strobe.
[[nodiscard]] std::vector<CellPlane> strobe_cells_of(const Survey& survey, const ImageFile& file);

// From its file, or from the survey's mesh, at this size.
[[nodiscard]] DepthMap depth_map_of(const Survey& survey, const ImageFile& file, PlaneSize size);

// Its pose; empty if it is missing and depth maps replace it.
[[nodiscard]] std::optional<Sled> sled_of(const Survey& survey, const ImageFile& file);

// Everything that its light depends on, except the survey's settings.
[[nodiscard]] std::string light_inputs(const Survey& survey, const ImageFile& file);

// Alternatives against which to check an image with a depth map.
struct OtherDepth {
    double depth_m = 0.0;                         // the median of its map, along the axis
    std::optional<Lightmap> by_other_convention;  // DepthIs; for maps from files
    std::optional<Lightmap> plane;                // the navigation's, if known
};
// Empty without depth maps.
[[nodiscard]] std::optional<OtherDepth> other_depth(const Survey& survey, const ImageFile& file);

}  // namespace aphotic
