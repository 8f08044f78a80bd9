// SPDX-License-Identifier: BSD-3-Clause
//
// What looks wrong about a survey, from a few of its images: given numbers that the images
// contradict. A problem is reported only where no correct survey shows the same, so silence proves
// nothing.
//
// white level  Light has no largest number, a sensor does. If the largest number of all, below the
//              white level, has a pile of samples, kPile times as many as a number just below it
//              and kPileShare of all, the sensor saturates there.
// bayer        Both green sites see the same light, so their medians agree. If those that the
//              pattern makes green differ by over kGreenSites, and the other two by less than a
//              fourth of that, the pattern is wrong. Red and blue are swapped if log(red / blue) of
//              the images falls over altitude where that of the light rises, and green varies as
//              the light does.
// altitude     Over the images, log(image) = s log(map) + const with s = 1 whatever the floor's
//              mean, in the green channel. Reported if s is off by over kSlope and by five standard
//              errors, with kEnoughImages or more at different altitudes. Before that, reported
//              if the images' median altitude is over kOtherUnit times the rig's own, or under
//              1 / kOtherUnit of it, with the unit that would make them agree.
// encoding     Numbers encoded with a gamma of 2.2 have s = 1/2.2, over the images and within each.
//              Reported if s is within kGamma of that within images, and within twice that over
//              them; or if the files are tagged as sRGB, as a camera's JPEG is, and no s of kLinear
//              or more contradicts it.
// corrected    In images that are even already, s is 0 within each image, to within kEven, where
//              the maps vary by over kFallOff (standard deviation of the logarithm), and over the
//              images too.
// black level  An offset b common to all samples. For an image's channel let d be the mean of the
//              darkest block, q the median of all blocks, and rho the map's own d/q. Over images
//              and channels d = b + phi_c rho (q - b), with a factor for each channel's floor.
//              Reported if b is over five standard errors and over kOffset of the largest q, q - b
//              varies kVaried-fold, and b is most of the least d, which it cannot exceed. Or it is
//              too high: light is not negative, and blocks average noise out. Reported if in most
//              images some d is below 0 by kOffset of the largest q.
// map          Light that has travelled a different path has a different colour: reported if the
//              gains of two channels differ by over kGains; as "altitude" if images have one.
// attitude     Tilts that are all under kSmall_deg may be radians. If maps for tilts in radians
//              differ from those for degrees, b = sum x y / sum x x is 1 or 0: over blocks of
//              pixels, x is the logarithm of one map over the other, y that of the image over the
//              map for degrees, both less their means in each image. Reported if b is over
//              kLikeness and three standard errors from 0, and as near to 1.
// depth        Depth maps may be along the axis or along rays, or belong to other images: reported
//              as for the attitude, from the light of the other convention and that of the
//              navigation's plane; or if the correlation of the navigation's altitudes with the
//              maps' median depths is under kLikeAltitudes.
// pattern      Corrected images share a fixed pattern that is too large (fixed_pattern.h), and
//              nothing else is reported that may cause it.
//
// Slopes are least squares over the images, with the standard error from their residuals, which
// floors that differ from image to image widen. If the maps hardly differ there is no slope.
#pragma once

#include "survey/correction.h"
#include "survey/dropouts.h"
#include "survey/images/camera_numbers.h"
#include "survey/images/raw_image.h"

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace aphotic {

// The frequency of an image's largest number, and of the numbers just below it.
struct TopNumber {
    double top = 0.0;
    double at_top = 0.0;      // samples
    double just_below = 0.0;  // samples from 0.9 top up to it
    double numbers = 0.0;     // distinct ones there: whole numbers, or else kFewNumbers
    double samples = 0.0;     // of the image
};
[[nodiscard]] TopNumber top_of(const RawImage& raw, bool is_whole_numbers);

// The medians of a mosaic's four sites above black, named row by row.
[[nodiscard]] std::array<double, 4> site_medians(const RawImage& raw, float black);

// For one image, by blocks of its green samples that are neither black nor saturated.
struct Likeness {
    double xx = 0.0;
    double xy = 0.0;
    std::size_t blocks = 0;
    double yy = 0.0;
};
[[nodiscard]] Likeness likeness(const RawImage& raw,
                                const SensorLevels& levels,
                                const Lightmap& map,
                                const Lightmap& other);

// For one image, by the same blocks for each channel, from all samples that are not saturated.
struct FrameLook {
    Likeness to_map;         // of the green channel: x the map's logarithm
    PerChannel darkest{};    // mean over black of the darkest block
    PerChannel median{};     // of all blocks
    PerChannel map_share{};  // darkest over median, of the map
};
[[nodiscard]] FrameLook frame_look(const RawImage& raw,
                                   const SensorLevels& levels,
                                   const Lightmap& map);

// The information from one image.
struct ImageLook {
    std::string name;
    bool is_for_gain = false;  // it contributes to the survey's gain (corrector.h)
    TopNumber top;
    float white = 0.0F;
    Mosaic mosaic = Mosaic::None;                // of the whole file, from its top left
    std::optional<std::array<double, 4>> sites;  // for a Bayer mosaic, in its pattern's order
    // For images with a map.
    std::optional<double> altitude_m;  // empty: one map for all
    PerChannel quotient{};             // middle_quotient()
    PerChannel map_mean{};
    FrameLook frame;
    bool says_srgb = false;  // from its file
    LightCells cells{};      // for judging the strobes
    double level = 0.0;      // relative to the survey, if images have an exposure each
    std::optional<double> stated_exposure;  // from its Exif, relative to the survey's others
    // For images with a depth map: its median along the axis, and the likeness of the image to the
    // map of light by the other convention, and to that on the navigation's plane.
    std::optional<double> depth_m{};
    Likeness as_other_convention{};
    Likeness as_plane{};
    Likeness as_radians;  // tilts as radians; 0: surely degrees, or no difference
};
[[nodiscard]] PerChannel means_of(const Lightmap& map);

// That of the first image; None without images.
[[nodiscard]] Mosaic mosaic_of(std::span<const ImageLook> looks);

// Tilts [degrees] that are all below this may be radians.
inline constexpr double kSmall_deg = 0.6;

// Images with light that fitting a line needs.
inline constexpr std::size_t kEnoughImages = 12;

// Warnings about the navigation do not concern the light.
inline constexpr std::string_view kAboutNavigation = "navigation";
inline constexpr std::string_view kAboutPattern = "pattern";

struct Suspicion {
    // "white-level", "bayer", "altitude", "encoding", "corrected", "black-level", "map",
    // "attitude", "navigation", "exposure", "strobes", "depth", "pattern"
    std::string about;
    std::string what;  // with the number that shows it
};
[[nodiscard]] std::vector<Suspicion> suspicions(std::span<const ImageLook> looks,
                                                Mosaic mosaic,
                                                std::optional<double> rig_altitude_m = {});
[[nodiscard]] nlohmann::ordered_json to_json(const std::vector<Suspicion>& suspicions);

// For images at different altitudes in the light of a nearly correct rig: what varies the opposite
// way. If the green channel's brightness does, the poses belong to other images. If it does not,
// but red over blue does, these two are swapped.
[[nodiscard]] std::optional<Suspicion> turned_brightness(std::span<const ImageLook> looks);
[[nodiscard]] std::optional<Suspicion> red_for_blue(std::span<const ImageLook> looks,
                                                    Mosaic mosaic);

// If the exposures in the images' Exif contradict the levels that the images have each; or if these
// are not to be used, and their brightness follows them all the same.
[[nodiscard]] std::optional<Suspicion> exposure_doubt(std::span<const ImageLook> looks,
                                                      ExposureBy by);

// Why a line through images with altitudes can show none of these; or empty.
[[nodiscard]] std::string not_checked(std::span<const ImageLook> looks);

}  // namespace aphotic
