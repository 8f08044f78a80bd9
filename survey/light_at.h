// SPDX-License-Identifier: BSD-3-Clause
//
// The light in which an image of a survey was taken: from a rig at the image's own altitude and
// attitude, of all its strobes or each; or one map for all.
#pragma once

#include "image/any_image.h"
#include "lightmap/lightmap.h"
#include "lightmap/relief_map.h"
#include "rig/rig.h"
#include "spectral/camera_to_srgb.h"
#include "survey/correction.h"
#include "survey/dropouts.h"
#include "survey/images/image_files.h"
#include "survey/navigation/navigation.h"
#include "survey/relief/floor_relief.h"

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
    std::string digest;           // of everything that the maps depend on except the pose
    std::string camera_digest{};  // of its response only; empty: the camera is unknown
    std::optional<double> rig_altitude_m{};  // its own
    PlaneSize size;
    std::optional<PlaneSize> rig_size{};  // if the rig's size was scaled to its images'
    bool is_grey = false;                 // the maps have equal R, G and B: a mono camera
    // Whether the maps include the veil; empty: the water is not known to scatter.
    std::optional<bool> has_veil{};
    std::optional<double> veil_tolerance{};  // if they include a rig's
    // These are called from several threads.
    std::function<Lightmap(const Sled& sled)> map;
    std::function<std::vector<std::uint8_t>(const Sled& sled, int within_px)> edges;
    // The same on a relief, for a rig.
    std::shared_ptr<const ReliefMapMaker> relief{};
    // The map with the navigation's tilts taken as radians instead of degrees; empty if that puts a
    // strobe below the floor, or if they are surely degrees.
    std::function<std::optional<Lightmap>(const Sled& sled)> map_as_radians{};
    // To show the images divided by the maps; empty: the camera is unknown.
    std::function<CameraToSrgb()> to_srgb{};
    std::optional<PerChannel> floor_colour{};           // empty: the floor is unknown
    std::optional<PerChannel> floor_colour_in_water{};  // in the light at the camera
};

// The largest error of a correction's veil, relative to the signal: below the images' noise and the
// model's error.
inline constexpr double kVeilOfCorrection = 1e-3;

// The poses of these images, without those that have none, and empty without navigation; and the
// paths that they see, which maps must cover.
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

// The light of each strobe of a rig: in cells (survey/dropouts.h), from small lightmaps, to detect
// which strobes fired; and for those that did, at every pixel. The light of strobes adds up, so
// that of one strobe is the lightmap of a rig that has no other.
struct StrobesAt {
    std::vector<std::string> names{};
    // These are called from several threads.
    std::function<std::vector<CellPlane>(const Sled& sled)> cells{};  // by strobe; empty: unknown
    // Without the strobes whose bits are set, at most all but one.
    std::function<Lightmap(const Sled& sled, std::uint64_t out)> map_without{};
    // The same for images with depth maps.
    std::function<std::vector<CellPlane>(
        const DepthMap&, const DepthMaps&, const std::optional<Sled>&)>
        relief_cells{};
    std::function<std::shared_ptr<const ReliefMapMaker>(std::uint64_t out)> relief_without{};
};

// For the poses of these images, as in light_of_rig(). Empty for a rig of more than kMostStrobes.
[[nodiscard]] StrobesAt strobes_of_rig(const Rig& rig,
                                       const std::optional<Navigation>& navigation,
                                       const std::vector<ImageFile>& files,
                                       bool has_veil = true,
                                       double veil_tolerance = kVeilOfCorrection,
                                       bool has_relief = false);

// An InputError unless its maps match such an image: its size, and grey for a mono camera.
void require_light_for(const RawImage& raw, const LightAt& light);

// One map, whatever the pose: channels R, G and B of an EXR, and veil.R, veil.G and veil.B if
// present. Samples that are not finite, as where nothing was observed, are dark. An InputError if
// it is far larger than the survey's images, if their size is known.
[[nodiscard]] LightAt light_of_map(const std::filesystem::path& map_file,
                                   bool has_veil = true,
                                   std::optional<PlaneSize> images = std::nullopt);

// The share of the lamps' light, after a path l through the water, that the rig's floor returns to
// each channel:
//   int sum_s P_s Phi_s exp(-K l) rho Q_c dlambda / int sum_s P_s Phi_s exp(-K l) Q_c dlambda.
// Without a path, it is that of their own light.
[[nodiscard]] PerChannel floor_colour(const Rig& rig, double path_m = 0.0);

// For the rig's camera, in the light of its lamps after the path to the floor and back at the rig's
// own altitude.
[[nodiscard]] CameraToSrgb camera_to_srgb(const Rig& rig);

}  // namespace aphotic
