// SPDX-License-Identifier: BSD-3-Clause
#include "survey/camera_of_files.h"

#include "base/error.h"
#include "image/image_size.h"
#include "rig/lens.h"
#include "survey/survey_image.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>

namespace aphotic {

namespace {

std::optional<PlaneSize> size_if_readable(const ImageFile& file) {
    try {
        return size_in(file.source);
    } catch (const InputError&) {
        return std::nullopt;  // it is said of the image when its turn comes
    }
}

// Of the whole files.
std::optional<PlaneSize> usual_file_size(const std::vector<ImageFile>& files) {
    constexpr std::size_t kFew = 9;
    const std::size_t count = std::min(kFew, files.size());
    std::map<std::pair<int, int>, int> images;  // by size
    for (std::size_t i = 0; i < count; ++i) {
        if (const auto size = size_if_readable(files[i * files.size() / count]))
            ++images[{size->width_px, size->height_px}];
    }
    for (std::size_t i = 0; i < files.size() && images.empty(); ++i) {
        if (const auto size = size_if_readable(files[i])) return size;
    }
    if (images.empty()) return std::nullopt;
    const auto [width_px, height_px] =
        std::ranges::max_element(images, {}, [](const auto& size) { return size.second; })->first;
    return PlaneSize{width_px, height_px};
}

}  // namespace

std::optional<PlaneSize> usual_size(const std::vector<ImageFile>& files,
                                    const CameraNumbers& camera) {
    const std::optional<PlaneSize> file = usual_file_size(files);
    if (!file) return std::nullopt;
    const Crop crop = crop_of(camera, *file);
    return PlaneSize{crop.width_px, crop.height_px};
}

CameraNumbers expecting_usual_size(CameraNumbers camera, const std::vector<ImageFile>& files) {
    const std::optional<PlaneSize> file = usual_file_size(files);
    if (!file) return camera;
    const Crop crop = crop_of(camera, *file);
    camera.expected = ExpectedSize{.image = {crop.width_px, crop.height_px},
                                   .as = "as most of the images looked at have",
                                   .file = *file};
    return camera;
}

CameraNumbers with_reference(CameraNumbers camera, const std::vector<ImageFile>& files) {
    const auto is_told = [](const ShotExposure& shot) {
        return shot.time_s || shot.iso || shot.f_number;
    };
    if (camera.exposure_by == ExposureBy::Nothing || is_told(camera.reference)) return camera;
    for (const ImageFile& file : files) {
        const SharedTags tags = read_image_tags(file.source);
        if (!tags) continue;
        camera.reference = exposure_of(*tags);
        if (camera.exposure_by == ExposureBy::Flash) camera.reference.time_s.reset();
        if (is_told(camera.reference)) return camera;
    }
    throw InputError("--exposure: no image's Exif has {}ISO number or FNumber",
                     camera.exposure_by == ExposureBy::Exif ? "ExposureTime, " : "");
}

void require_whole_view(const std::vector<ImageFile>& files,
                        const CameraNumbers& camera,
                        const Camera& rig) {
    if (!camera.crop) return;
    CameraNumbers uncropped = camera;
    uncropped.crop.reset();
    const std::optional<PlaneSize> file = usual_size(files, uncropped);
    const Crop& crop = *camera.crop;
    if (!file || file->width_px != rig.width_px || file->height_px != rig.height_px) return;
    if (crop.width_px == rig.width_px && crop.height_px == rig.height_px) return;
    throw InputError(
        "--crop: found {} x {} of files that have the rig's {} x {} pixels; allowed: a part that "
        "is the whole image of the rig's camera",
        crop.width_px,
        crop.height_px,
        rig.width_px,
        rig.height_px);
}

std::optional<PlaneSize> fit_to(Camera& camera, PlaneSize images) {
    const PlaneSize rig{camera.width_px, camera.height_px};
    const auto is_same_shape = std::int64_t{rig.width_px} * images.height_px ==
                               std::int64_t{rig.height_px} * images.width_px;
    if (!is_same_shape || rig.width_px == images.width_px) return std::nullopt;
    if (std::max(images.width_px, images.height_px) > kLargestImagePx) return std::nullopt;
    enlarge_pixels(camera,
                   static_cast<double>(rig.width_px) / images.width_px,
                   images.width_px,
                   images.height_px);
    return rig;
}

}  // namespace aphotic
