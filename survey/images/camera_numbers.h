// SPDX-License-Identifier: BSD-3-Clause
//
// What the user says of the camera that took a survey: which part of a file is its image, what its
// pixels see, and the numbers for no light and for saturation. What he does not say, the rig's
// [camera] may (Readout in rig/rig.h), and else the file.
//
// Columns and rows of a crop count from 0 at the file's top left. A mosaic's pattern is that of the
// file; an odd crop begins it elsewhere (shifted() in raw_image.h).
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

// By what images are brought to one exposure: by the numbers that each file tells in its Exif. The
// light of a flash does not grow with the time that the shutter is open. By the model: each to its
// own level, whatever its file tells (survey/dropout_check.h).
enum class ExposureBy { Nothing, Exif, Flash, Model };
[[nodiscard]] constexpr bool is_told_by_exif(ExposureBy by) {
    return by == ExposureBy::Exif || by == ExposureBy::Flash;
}

// Of a file that holds the images of two cameras side by side.
enum class Half { Left, Right };

// The size that a survey's images have, as cropped, by its map, its rig or most of its files:
// others are refused by their headers, before a pixel is decoded. A crop says nothing of the file
// around it, which is held to that of the other files.
struct ExpectedSize {
    PlaneSize image{};
    std::string as{};      // "as the map has"
    PlaneSize file{0, 0};  // not known
};

struct CameraNumbers {
    std::optional<Mosaic> mosaic{};      // none: the file's own, or R, G and B
    std::optional<float> black_level{};  // none: the file's own, or 0
    std::optional<float> white_level{};  // none: the file's own, or the largest of its integers
    std::optional<Half> half{};          // of half and crop, one at most
    std::optional<Crop> crop{};
    ExposureBy exposure_by = ExposureBy::Nothing;
    ShotExposure reference{};  // what images are brought to: what it tells counts, nothing else
    std::optional<ExpectedSize> expected{};
};

// Which part of a file of this size is the image. An InputError, with that size, when it has no
// such part.
[[nodiscard]] Crop crop_of(const CameraNumbers& camera, PlaneSize file);

// The same with what the rig's camera says where the user says nothing. An InputError when he says
// mono of a camera of colours, or colours of a mono camera.
[[nodiscard]] CameraNumbers with_rig(CameraNumbers camera, const Camera& rig);

// What the rig's camera tells of its exposure.
[[nodiscard]] ShotExposure shot_of(const Readout& readout);

// The noise of the rig's camera in its numbers, by what it tells of EMVA 1288: electrons to a
// number, 1/K, or 0; and without light sqrt((K read_noise_e)^2 + 1/12), rounding's included, or
// none.
[[nodiscard]] double electrons_per_number(const Readout& readout);
[[nodiscard]] std::optional<double> dark_noise_dn(const Readout& readout);

// How many times as much light as at the reference, of the same scene:
//
//   e = (t / t_0) (S / S_0) (N_0 / N)^2      t: time, S: ISO number, N: f-number
//
// with the factors that the reference has. An InputError when the shot lacks one of them.
[[nodiscard]] double relative_exposure(const ShotExposure& shot, const CameraNumbers& camera);

// "X,Y,WIDTH,HEIGHT"; nothing where the text is none.
[[nodiscard]] std::optional<Crop> crop_named(const std::string& text);

// As settings, under the options' names; null: not told.
[[nodiscard]] nlohmann::ordered_json to_json(const CameraNumbers& camera);

// What the files of a survey tell of its camera before any is corrected: the size of their images,
// and the exposure that the others are brought to. A rig is fitted to that size.

// The size that most of a few images have, spread evenly over the survey, as cropped: of sizes that
// as many have, the smallest, for large ones cost more where they are wrong. Where none of these
// can be read, that of the first that can, if there is one. An InputError when the crop does not
// fit.
[[nodiscard]] std::optional<PlaneSize> usual_size(const std::vector<ImageFile>& files,
                                                  const CameraNumbers& camera);

// With that size expected of every image, where there is one; an InputError as above.
[[nodiscard]] CameraNumbers expecting_usual_size(CameraNumbers camera,
                                                 const std::vector<ImageFile>& files);

// With the exposure of the first image that tells one in place of a reference that nobody gave. An
// InputError when no image does.
[[nodiscard]] CameraNumbers with_reference(CameraNumbers camera,
                                           const std::vector<ImageFile>& files);

// An InputError when a crop is a part of the rig's own image: a rig shows what all of the crop
// does, such as one of two cameras' images in a file.
void require_whole_view(const std::vector<ImageFile>& files,
                        const CameraNumbers& camera,
                        const Camera& rig);

// A camera of the same view with as many pixels, where these have the shape of its own: the size
// that it had. None, and the camera as it was, where they are as many, or have another shape.
[[nodiscard]] std::optional<PlaneSize> fit_to(Camera& camera, PlaneSize images);

}  // namespace aphotic
