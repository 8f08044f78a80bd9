// SPDX-License-Identifier: BSD-3-Clause
//
// What the files of a survey tell of its camera before any is corrected: the size of their images,
// and the exposure that the others are brought to. A rig is fitted to that size.
#pragma once

#include "image/any_image.h"
#include "rig/rig.h"
#include "survey/camera_numbers.h"
#include "survey/image_files.h"

#include <optional>
#include <vector>

namespace aphotic {

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
