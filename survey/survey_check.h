// SPDX-License-Identifier: BSD-3-Clause
//
// What looks wrong about a survey, from a few of its images: given numbers that the images
// contradict. A problem is reported only where no correct survey shows the same, so silence proves
// nothing.
//
// white level  Light has no largest number, a sensor has. Where the largest number of all, under
//              the white level, holds a pile of samples, kPile times as many as a number just below
//              it and kPileShare of all, the sensor is saturated there.
// bayer        Both green sites see one light, so their medians agree. Where those that the pattern
//              makes green differ by over kGreen, and the other two by under a fourth of that, the
//              pattern is another. Red and blue that are swapped: log(red / blue) of the images
//              falls over altitude where that of the light rises, and green falls with it.
// altitude     Over the images, log(image) = s log(map) + const with s = 1 whatever the floor's
//              mean, in the green channel. Told where s is off by over kSlope and by five of its
//              standard errors, of kEnoughImages and more at altitudes that differ.
//              Told first where the images' altitudes, by their median, are over kOtherUnit times
//              the rig's own or under 1 / kOtherUnit of it: a unit that makes them alike is named.
// encoding     Numbers that are shown by a gamma of 2.2 have s = 1/2.2, over the images and within
//              each. Told where s is within kGamma of that within images, and about that over
//              them; or where the files say that they are sRGB, as a camera's JPEG is, and no s of
//              kLinear and more denies it.
// corrected    Of images that are even already, s is 0 within each image, by under kEven, where the
//              maps vary by over kFallOff (standard deviation of the logarithm), and over the
//              images too.
// black level  An offset b that all samples have. Of an image's channel let d be the mean of the
//              darkest block, q the median of all blocks, and rho the map's own d/q. Over images
//              and channels d = b + phi_c rho (q - b), with a factor of each channel's floor. Told
//              where b is over five of its standard errors and over kOffset of the largest q, q - b
//              varies kVaried-fold, and b is most of the least d, which it cannot exceed.
// map          Where maps are of light that has travelled another way, their colour is another too:
//              told where the gains of two channels differ by over kGains; as "altitude" where
//              images have one.
// attitude     Tilts that are all under kSmall_deg may be radians. Where maps of these, taken as
//              radians, differ from those of degrees, b = sum x y / sum x x is 1 or 0: over blocks
//              of pixels, x the logarithm of one map over the other, y that of the image over the
//              map of degrees, both less their means in each image. Told where b is over kLikeness
//              and three of its standard errors from 0, and as near to 1.
// depth        Depth maps are taken along the axis, or along rays, or are other images': told as
// for
//              the attitude, by the light of the other convention, and by that of the navigation's
//              plane; or where the correlation of the navigation's altitudes with the maps' median
//              depths is under kLikeAltitudes.
//
// Slopes are least squares over the images, with the standard error from their residuals, which
// floors that differ from image to image widen. If the maps hardly differ there is no slope.
#pragma once

#include "survey/correction.h"
#include "survey/dropouts.h"
#include "survey/images/raw_image.h"

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace aphotic {

// How often an image has its largest number, and the numbers just below it.
struct TopNumber {
    double top = 0.0;
    double at_top = 0.0;      // samples
    double just_below = 0.0;  // samples from 0.9 top up to it
    double numbers = 0.0;     // that lie there: whole ones, or as many as tell a pile from none
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
};
[[nodiscard]] Likeness likeness(const RawImage& raw,
                                const SensorLevels& levels,
                                const Lightmap& map,
                                const Lightmap& other);

// For one image, by the same blocks for each channel, of all samples that are not saturated.
struct FrameLook {
    Likeness to_map;         // of the green channel: x the map's logarithm
    PerChannel darkest{};    // the mean over black of the block that is darkest
    PerChannel median{};     // of all blocks
    PerChannel map_share{};  // darkest over median, of the map
};
[[nodiscard]] FrameLook frame_look(const RawImage& raw,
                                   const SensorLevels& levels,
                                   const Lightmap& map);

// The information from one image.
struct ImageLook {
    std::string name;
    bool is_for_gain = false;  // the survey's gain is taken from it (corrector.h)
    TopNumber top;
    float white = 0.0F;
    Mosaic mosaic = Mosaic::None;                // of the whole file, from its top left
    std::optional<std::array<double, 4>> sites;  // of a Bayer mosaic, as its pattern names them
    // For images with a map.
    std::optional<double> altitude_m;  // empty: one map for all
    PerChannel quotient{};             // middle_quotient()
    PerChannel map_mean{};
    FrameLook frame;
    bool says_srgb = false;  // its file
    LightCells cells{};      // what strobes lit it; where that is judged
    double level = 0.0;      // its own, over the survey's, where images have an exposure each
    std::optional<double> stated_exposure;  // from its Exif, relative to the survey's others
    // Of images with a depth map: its median along the axis, and how like the image is to the map
    // of light by the other convention, and to that on the navigation's plane.
    std::optional<double> depth_m{};
    Likeness as_other_convention{};
    Likeness as_plane{};
    Likeness as_radians;  // of its map to that of the tilts as radians; 0: surely degrees, or alike
};
[[nodiscard]] PerChannel means_of(const Lightmap& map);

// That of the first; None for no images.
[[nodiscard]] Mosaic mosaic_of(std::span<const ImageLook> looks);

// Whether tilts [degrees] look like radians.
inline constexpr double kSmall_deg = 0.6;

// Images with light, for fitting a line.
inline constexpr std::size_t kEnoughImages = 12;

// Warnings about the navigation say nothing of the light.
inline constexpr std::string_view kAboutNavigation = "navigation";

struct Suspicion {
    // "white-level", "bayer", "altitude", "encoding", "corrected", "black-level", "map",
    // "attitude", "navigation", "exposure", "strobes", "depth"
    std::string about;
    std::string what;  // with the number that shows it
};
[[nodiscard]] std::vector<Suspicion> suspicions(std::span<const ImageLook> looks,
                                                Mosaic mosaic,
                                                std::optional<double> rig_altitude_m = {});
[[nodiscard]] nlohmann::ordered_json to_json(const std::vector<Suspicion>& suspicions);

// Of images at altitudes that differ, in the light of a rig that is about right: what runs the
// other way. The green channel's brightness: poses of other images. Where that goes as it should,
// red over blue: these two are swapped.
[[nodiscard]] std::optional<Suspicion> turned_brightness(std::span<const ImageLook> looks);
[[nodiscard]] std::optional<Suspicion> red_for_blue(std::span<const ImageLook> looks,
                                                    Mosaic mosaic);

// Of images with a level each: where their Exif tells other exposures.
[[nodiscard]] std::optional<Suspicion> exposure_doubt(std::span<const ImageLook> looks);

// Why a line through images with altitudes can show none of these; or empty.
[[nodiscard]] std::string not_checked(std::span<const ImageLook> looks);

}  // namespace aphotic
