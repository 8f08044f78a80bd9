// SPDX-License-Identifier: BSD-3-Clause
//
// The light that an image of a survey was taken in: by a rig at the image's own altitude and
// attitude, or one map for all.
#pragma once

#include "image/any_image.h"
#include "lightmap/lightmap.h"
#include "lightmap/relief_map.h"
#include "rig/rig.h"
#include "spectral/camera_to_srgb.h"
#include "survey/correction.h"
#include "survey/images/image_files.h"
#include "survey/navigation/navigation.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace aphotic {

struct LightAt {
    std::string title{};  // of the rig, and its file; empty: no rig
    std::string toml{};
    std::string digest;           // of all that the maps depend on, the pose aside
    std::string camera_digest{};  // of its response alone; empty: the camera is not known
    std::optional<double> rig_altitude_m{};  // its own
    PlaneSize size;
    std::optional<PlaneSize> rig_size{};  // where the rig has another than its images, scaled
    bool is_grey = false;                 // the maps have R, G and B alike: of a mono camera
    // Whether the maps have the veil; none: the water does not scatter, as far as is known.
    std::optional<bool> has_veil{};
    std::optional<double> veil_tolerance{};  // where they have one of the rig's
    // These are called from several threads.
    std::function<Lightmap(const Sled& sled)> map;
    std::function<std::vector<std::uint8_t>(const Sled& sled, int within_px)> edges;
    // The same on a relief, of a rig.
    std::shared_ptr<const ReliefMapMaker> relief{};
    // The map of tilts that the navigation tells in radians instead of degrees; none where that
    // puts a strobe under the floor. Empty where they are surely degrees.
    std::function<std::optional<Lightmap>(const Sled& sled)> map_as_radians{};
    // To show what is divided by the maps; empty: the camera is not known.
    std::function<CameraToSrgb()> to_srgb{};
    std::optional<PerChannel> floor_colour{};           // none: nothing is known of the floor
    std::optional<PerChannel> floor_colour_in_water{};  // by the light that images were taken in
};

// What a correction's veil is off by at most, of the signal: under what images' noise and the model
// are.
inline constexpr double kVeilOfCorrection = 1e-3;

// The poses of these images: those that have none are passed over here, as without a navigation all
// have; and the paths that they see, which maps are to serve.
[[nodiscard]] std::vector<Sled> sleds_of(const std::optional<Navigation>& navigation,
                                         const std::vector<ImageFile>& files);
[[nodiscard]] PathRange paths_of_survey(const Rig& rig, const std::vector<Sled>& sleds);

// For the poses of these images.
[[nodiscard]] LightAt light_of_rig(const Rig& rig,
                                   const std::optional<Navigation>& navigation,
                                   const std::vector<ImageFile>& files,
                                   bool has_veil = true,
                                   double veil_tolerance = kVeilOfCorrection,
                                   bool has_relief = false);

// An InputError unless its maps are for such an image: of its size, and grey for a mono camera.
void require_light_for(const RawImage& raw, const LightAt& light);

// One map, whatever the pose: channels R, G and B of an EXR, and where it has them veil.R, veil.G
// and veil.B. What is not finite in it, as where nothing was observed, is dark. An
// InputError when it is far larger than the images that it is for, where their size is told.
[[nodiscard]] LightAt light_of_map(const std::filesystem::path& map_file,
                                   bool has_veil = true,
                                   std::optional<PlaneSize> images = std::nullopt);

// Of the rig's floor: how much of the lamps' own light, without water, it gives back to each
// channel:  int sum_s P_s Phi_s rho Q_c dlambda / int sum_s P_s Phi_s Q_c dlambda.
[[nodiscard]] PerChannel floor_colour(const Rig& rig);

// Of the rig's camera, in the light of its lamps after the way to the floor and back at the rig's
// own altitude.
[[nodiscard]] CameraToSrgb camera_to_srgb(const Rig& rig);

// The floor's colour in that light.
[[nodiscard]] PerChannel floor_colour_in_water(const Rig& rig);

}  // namespace aphotic
