// SPDX-License-Identifier: BSD-3-Clause
//
// The user's data on the camera that took a survey: the part of a file that is its image, the
// channels of its pixels, and the numbers for no light and for saturation. Values that the user
// omits come from the rig's [camera] (Readout in rig/rig.h), and otherwise from the file.
//
// Columns and rows of a crop count from 0 at the file's top left. A mosaic's pattern is that of the
// file; with an odd crop it begins elsewhere (shifted() in raw_image.h).
#pragma once

#include "image/any_image.h"
#include "image/image_tags.h"
#include "rig/rig.h"
#include "survey/images/image_files.h"
#include "survey/images/raw_image.h"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace aphotic {

struct Crop {
    int left_px = 0;
    int top_px = 0;
    int width_px = 0;
    int height_px = 0;

    bool operator==(const Crop&) const = default;
};

// How images are brought to one exposure. By Exif: from the numbers in each file. Flash: the same
// without the shutter time, which does not change a flash's light. By the model: from each image's
// own level, whatever its file states (survey/dropout_check.h).
enum class ExposureBy { Nothing, Exif, Flash, Model };
[[nodiscard]] constexpr bool is_told_by_exif(ExposureBy by) {
    return by == ExposureBy::Exif || by == ExposureBy::Flash;
}

// For a file with two cameras' images side by side.
enum class Half { Left, Right };

// The size of a survey's images, after cropping, from its map, its rig or most of its files: others
// are rejected from their headers, before a pixel is decoded. A crop does not fix the size of the
// file around it, which is compared with the other files'.
struct ExpectedSize {
    PlaneSize image{};
    std::string as{};      // "like the map"
    PlaneSize file{0, 0};  // 0: unknown
};

struct CameraNumbers {
    std::optional<Mosaic> mosaic{};      // empty: the file's own, or R, G and B
    std::optional<float> black_level{};  // empty: the file's own, or 0
    std::optional<float> white_level{};  // empty: the file's own, or its largest integer
    std::optional<Half> half{};          // at most one of half and crop
    std::optional<Crop> crop{};
    ExposureBy exposure_by = ExposureBy::Nothing;
    ShotExposure
        reference{};  // the exposure that images are brought to: only its known numbers count
    std::optional<ExpectedSize> expected{};
};

// The part of a file of this size that is the image. An InputError, with that size, if the file has
// no such part.
[[nodiscard]] Crop crop_of(const CameraNumbers& camera, PlaneSize file);

// The same, completed from the rig's camera where the user gave nothing. An InputError for mono
// with a colour camera, or colours with a mono camera.
[[nodiscard]] CameraNumbers with_rig(CameraNumbers camera, const Camera& rig);

// The rig camera's exposure.
[[nodiscard]] ShotExposure shot_of(const Readout& readout);

// The noise of the rig's camera in raw numbers, from its EMVA 1288 data: electrons per number, 1/K,
// or 0; and without light sqrt((K read_noise_e)^2 + 1/12), including rounding, or empty.
[[nodiscard]] double electrons_per_number(const Readout& readout);
[[nodiscard]] std::optional<double> dark_noise_dn(const Readout& readout);

// The light relative to the reference, for the same scene:
//
//   e = (t / t_0) (S / S_0) (N_0 / N)^2      t: time, S: ISO number, N: f-number
//
// with the factors that the reference has. An InputError if the shot lacks one of them.
[[nodiscard]] double relative_exposure(const ShotExposure& shot, const CameraNumbers& camera);

// "X,Y,WIDTH,HEIGHT"; otherwise empty.
[[nodiscard]] std::optional<Crop> crop_named(const std::string& text);

// As settings, under the options' names; null: unknown.
[[nodiscard]] nlohmann::ordered_json to_json(const CameraNumbers& camera);

// What a survey's files state about its camera before any is corrected: the size of their images,
// and the exposure to which the others are brought. A rig is scaled to that size.

// Expecting of every image the most common size after cropping among a few images, evenly spread
// over the survey; in a tie the smallest, since a wrong large one costs more. If none of these can
// be read, the size of the first readable image, if any. An InputError if the crop does not fit.
[[nodiscard]] CameraNumbers expecting_usual_size(CameraNumbers camera,
                                                 const std::vector<ImageFile>& files);

// This size instead, as that of a map or a rig.
void expect(CameraNumbers& camera, PlaneSize image, std::string as);

// With the exposure of the first image that has one, if no reference was given. An InputError if no
// image has one.
[[nodiscard]] CameraNumbers with_reference(CameraNumbers camera,
                                           const std::vector<ImageFile>& files);

// An InputError if a crop is only a part of the rig's own image: a rig describes everything in the
// crop, such as one of two cameras' images in a file.
void require_whole_view(const CameraNumbers& camera, const Camera& rig);

// Changes a rig camera's number of pixels to that expected of images, but not its view, if the
// shape is the same to the nearest row, as after --scale, and returns its former size. Empty, and
// the rig's camera unchanged, if the number is the same or unknown, or the shape differs.
std::optional<PlaneSize> fit_to(const CameraNumbers& camera, Camera& rig);

}  // namespace aphotic
