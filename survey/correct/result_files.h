// SPDX-License-Identifier: BSD-3-Clause
//
// The files made from an image: the image itself in one of three formats, and on request a mask of
// its doubtful pixels. Linear, with the source's metadata.
//
//   tiff, png  16 bits, 65535 for 1; what does not fit is clipped, and marked
//   exr        32-bit floats, which clip nothing
//
// On request, the viewable image next to them.
//
// In a mask each pixel's 8 bits are its doubts (correction.h), 0 is good.
#pragma once

#include "base/work_folder.h"
#include "image/any_image.h"
#include "image/exr.h"
#include "spectral/camera_to_srgb.h"
#include "survey/correction.h"
#include "survey/images/image_files.h"
#include "survey/images/survey_image.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace aphotic {

// Corrected images for viewers, annotation platforms and photogrammetry: encoded as sRGB, in a
// folder of their own beside the linear ones, with the same names.
//
//   shown = sRGB( e M b v ),     e = 2^stops kMiddleGrey / luminance(M b middle)
//
// v       corrected image, linear
// b       balance of the channels, near 1: if the middle is the colour of the rig's floor under the
//         lamps, the floor's colour in the light that reaches the camera over that
// M       the camera's matrix (camera_to_srgb.h); the identity if the camera is unknown
// middle  value of the survey's median (corrector.h); if only a gain is known, e = 2^stops
// e       one exposure for the whole survey, so that its images can be compared
// For baselines (baseline.h), neither colours nor the middle are known: b makes the survey's median
// in each channel kMiddleGrey, M is the identity, and e = 2^stops.
//
// sRGB    transfer curve of IEC 61966-2-1; clipped to 0..1
//
// luminance is that of IEC 61966-2-1: 0.2126 R + 0.7152 G + 0.0722 B.

inline constexpr double kMiddleGrey = 0.2;

struct SrgbFormat {
    std::string format = "jpeg";  // or png, tiff
    int bits = 8;                 // or 16, except for jpeg
    int quality = 95;             // of jpeg, 1 to 100
    double stops = 0.0;           // brighter by 2^stops
};
[[nodiscard]] nlohmann::ordered_json to_json(const SrgbFormat& format);

struct SrgbEncoding {
    std::optional<CameraToSrgb> camera{};  // empty: the identity
    double exposure = 1.0;
    PerChannel balance{1.0, 1.0, 1.0};  // of the channels, applied first

    [[nodiscard]] Eigen::Matrix3d matrix() const;
};
[[nodiscard]] nlohmann::ordered_json to_json(const SrgbEncoding& encoding);

// middle: empty if it is unknown.
[[nodiscard]] SrgbEncoding srgb_encoding(std::optional<CameraToSrgb> camera,
                                         const std::optional<PerChannel>& middle,
                                         double stops);

// Planes R, G, B of 0 to 1, encoded; for a mono image its one plane, grey. Not for mosaics.
[[nodiscard]] std::vector<float> srgb_planes(const RawImage& image, const Eigen::Matrix3d& matrix);

// Their names.
[[nodiscard]] std::vector<std::string> shown_channels(const RawImage& image);

// Below the folder of results: srgb/NAME.jpg.
[[nodiscard]] std::filesystem::path srgb_file_of(const ImageFile& file, const SrgbFormat& format);

// A mosaic is demosaiced first. The file is tagged as sRGB.
void write_srgb(const std::filesystem::path& folder,
                const ImageFile& file,
                const CorrectedImage& result,
                const SurveyImage& source,
                const SrgbEncoding& encoding,
                const SrgbFormat& format);

struct ResultFormat {
    std::string format = "tiff";
    bool mask = false;
    Compression compression = Compression::Fast;
    std::optional<SrgbFormat> srgb{};  // empty: linear only

    [[nodiscard]] bool clips() const { return format != "exr"; }
};

inline const std::map<std::string, Compression> kCompressions{
    {"none", Compression::None}, {"fast", Compression::Fast}, {"small", Compression::Small}};

// The files made from an image, below the folder of results: NAME.tif, NAME.mask.png.
[[nodiscard]] std::vector<std::filesystem::path> results_of(const ImageFile& file,
                                                            const ResultFormat& format);

// Writes them, except the one in sRGB, and returns how many pixels have each doubt. more:
// attributes of an EXR.
Counts write_results(const std::filesystem::path& folder,
                     const ImageFile& file,
                     CorrectedImage result,
                     const SurveyImage& source,
                     const ResultFormat& format,
                     const ExrAttributes& more = {});

}  // namespace aphotic
