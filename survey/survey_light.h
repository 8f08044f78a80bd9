// SPDX-License-Identifier: BSD-3-Clause
//
// The light that each image of a survey was taken in: by a rig at the image's own altitude and
// attitude, or one map for all.
#pragma once

#include "image/any_image.h"
#include "lightmap/lightmap.h"
#include "rig/rig.h"
#include "survey/correction.h"
#include "survey/survey_files.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace aphotic {

struct SurveyLight {
    std::string digest;  // of all that the maps depend on, the pose aside
    PlaneSize size;
    bool has_poses = true;  // else one map for all images, and a pose that means nothing
    // An InputError when the image has none that can be corrected.
    std::function<Sled(const std::filesystem::path& image)> pose;
    // These are called from several threads.
    std::function<Lightmap(const Sled& sled)> map;
    std::function<std::vector<std::uint8_t>(const Sled& sled, int within_px)> edges;
    // The map of tilts that the navigation tells in radians instead of degrees; none where that
    // puts a strobe under the floor. Empty where they are surely degrees.
    std::function<std::optional<Lightmap>(const Sled& sled)> map_as_radians;
    std::optional<PerChannel> floor_colour;  // none: nothing is known of the floor
};

// altitudes_m: least and most that are corrected; empty: all.
[[nodiscard]] SurveyLight light_of_rig(const std::string& rig_file,
                                       const std::string& navigation_file,
                                       const std::vector<double>& altitudes_m,
                                       const std::vector<SurveyFile>& files);

// Channels R, G and B of an EXR. What is not finite in it, as where nothing was observed, is dark.
[[nodiscard]] SurveyLight light_of_map(const std::string& map_file);

}  // namespace aphotic
