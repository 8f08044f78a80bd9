// SPDX-License-Identifier: BSD-3-Clause
#include "survey/images/camera_numbers.h"

#include "base/error.h"
#include "base/number.h"
#include "image/image_size.h"
#include "rig/camera/lens.h"
#include "survey/images/survey_image.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string_view>
#include <utility>

namespace aphotic {

namespace {

Crop half_of(Half half, PlaneSize file) {
    if (file.width_px < 2 || file.width_px % 2 != 0) {
        throw InputError("--half: found an image of {} x {} pixels; allowed: an even width",
                         file.width_px,
                         file.height_px);
    }
    const int width_px = file.width_px / 2;
    return {.left_px = half == Half::Left ? 0 : width_px,
            .width_px = width_px,
            .height_px = file.height_px};
}

std::string text_of(const Crop& crop) {
    return fmt::format("{},{},{},{}", crop.left_px, crop.top_px, crop.width_px, crop.height_px);
}

}  // namespace

Crop crop_of(const CameraNumbers& camera, PlaneSize file) {
    if (camera.half) return half_of(*camera.half, file);
    if (!camera.crop) return {.width_px = file.width_px, .height_px = file.height_px};
    const Crop& crop = *camera.crop;
    if (crop.left_px > file.width_px - crop.width_px ||
        crop.top_px > file.height_px - crop.height_px) {
        throw InputError("--crop {}: reaches beyond the image; allowed: within {} x {} pixels",
                         text_of(crop),
                         file.width_px,
                         file.height_px);
    }
    return crop;
}

CameraNumbers with_rig(CameraNumbers camera, const Camera& rig) {
    const Readout& readout = rig.readout;
    const auto level = [](std::optional<double> dn) {
        return dn ? std::optional(static_cast<float>(*dn)) : std::nullopt;
    };
    const bool is_mono = rig.sensor.is_mono();
    if (camera.mosaic && (*camera.mosaic == Mosaic::Mono) != is_mono) {
        throw InputError("--bayer: found {}, and the rig's camera has {}; allowed: {}",
                         mosaic_name(*camera.mosaic),
                         is_mono ? "one response" : "responses of red, green and blue",
                         is_mono ? "mono" : "RGGB, GRBG, GBRG, BGGR");
    }
    if (!camera.mosaic) camera.mosaic = mosaic_named(readout.bayer);
    if (!camera.black_level) camera.black_level = level(readout.black_level_dn);
    if (!camera.white_level) camera.white_level = level(readout.white_level_dn);
    if (!is_told_by_exif(camera.exposure_by)) return camera;
    camera.reference = shot_of(readout);
    if (camera.exposure_by == ExposureBy::Flash) camera.reference.time_s.reset();
    return camera;
}

ShotExposure shot_of(const Readout& readout) {
    constexpr double kMillisecondsPerSecond =
        1e3;  // as a divisor: 2.5 ms are 0.0025 s, rounded once
    ShotExposure shot{.iso = readout.iso, .f_number = readout.f_number};
    if (readout.exposure_ms) shot.time_s = *readout.exposure_ms / kMillisecondsPerSecond;
    return shot;
}

double electrons_per_number(const Readout& readout) {
    return readout.gain_dn_per_e ? 1.0 / *readout.gain_dn_per_e : 0.0;
}

std::optional<double> dark_noise_dn(const Readout& readout) {
    if (!readout.gain_dn_per_e || !readout.read_noise_e) return std::nullopt;
    return std::sqrt(std::pow(*readout.gain_dn_per_e * *readout.read_noise_e, 2) + 1.0 / 12.0);
}

double relative_exposure(const ShotExposure& shot, const CameraNumbers& camera) {
    const auto ratio =
        [](std::optional<double> found, std::optional<double> reference, std::string_view name) {
            if (!reference) return 1.0;
            if (!found) throw InputError("--exposure: its Exif has no {}", name);
            return *found / *reference;
        };
    const ShotExposure& reference = camera.reference;
    const double stop = ratio(shot.f_number, reference.f_number, "FNumber");
    return ratio(shot.time_s, reference.time_s, "ExposureTime") *
           ratio(shot.iso, reference.iso, "ISO number") / (stop * stop);
}

std::optional<Crop> crop_named(const std::string& text) {
    std::array<int, 4> numbers{};
    std::string_view rest = text;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        if (i > 0) {
            if (!rest.starts_with(',')) return std::nullopt;
            rest.remove_prefix(1);
        }
        const auto number = read_leading_number<int>(rest);
        if (!number) return std::nullopt;
        numbers[i] = *number;
    }
    const auto [left, top, width, height] = numbers;
    if (!rest.empty() || left < 0 || top < 0 || width < 1 || height < 1) return std::nullopt;
    return Crop{.left_px = left, .top_px = top, .width_px = width, .height_px = height};
}

nlohmann::ordered_json to_json(const CameraNumbers& camera) {
    nlohmann::ordered_json json{{"bayer", mosaic_name(camera.mosaic.value_or(Mosaic::None))},
                                {"half", nullptr},
                                {"crop", nullptr},
                                {"black_level", nullptr},
                                {"white_level", nullptr},
                                {"exposure", nullptr}};
    if (camera.half) json["half"] = *camera.half == Half::Left ? "left" : "right";
    if (camera.crop) json["crop"] = text_of(*camera.crop);
    if (camera.black_level) json["black_level"] = *camera.black_level;
    if (camera.white_level) json["white_level"] = *camera.white_level;
    if (camera.exposure_by == ExposureBy::Nothing) return json;
    if (camera.exposure_by == ExposureBy::Model) {
        json["exposure"] = {{"by", "model"}};
        return json;
    }
    const auto number = [](std::optional<double> value) {
        return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json();
    };
    json["exposure"] = {{"by", camera.exposure_by == ExposureBy::Exif ? "exif" : "flash"},
                        {"time_s", number(camera.reference.time_s)},
                        {"iso", number(camera.reference.iso)},
                        {"f_number", number(camera.reference.f_number)}};
    return json;
}

namespace {

std::optional<PlaneSize> size_if_readable(const ImageFile& file) {
    try {
        return size_in(file.source);
    } catch (const InputError&) {
        return std::nullopt;  // the image is reported when its turn comes
    }
}

// For whole files.
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

CameraNumbers expecting_usual_size(CameraNumbers camera, const std::vector<ImageFile>& files) {
    const std::optional<PlaneSize> file = usual_file_size(files);
    if (!file) return camera;
    const Crop crop = crop_of(camera, *file);
    camera.expected = ExpectedSize{.image = {crop.width_px, crop.height_px},
                                   .as = "like most of the images examined",
                                   .file = *file};
    return camera;
}

void expect(CameraNumbers& camera, PlaneSize image, std::string as) {
    const PlaneSize file = camera.expected ? camera.expected->file : PlaneSize{};
    camera.expected = {.image = image, .as = std::move(as), .file = file};
}

CameraNumbers with_reference(CameraNumbers camera, const std::vector<ImageFile>& files) {
    const auto is_told = [](const ShotExposure& shot) {
        return shot.time_s || shot.iso || shot.f_number;
    };
    if (!is_told_by_exif(camera.exposure_by) || is_told(camera.reference)) return camera;
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

void require_whole_view(const CameraNumbers& camera, const Camera& rig) {
    if (!camera.crop || !camera.expected) return;
    const PlaneSize file = camera.expected->file;
    const Crop& crop = *camera.crop;
    if (file.width_px != rig.width_px || file.height_px != rig.height_px) return;
    if (crop.width_px == rig.width_px && crop.height_px == rig.height_px) return;
    throw InputError(
        "--crop: found {} x {} of files that have the rig's {} x {} pixels; allowed: a part that "
        "is the whole image of the rig's camera",
        crop.width_px,
        crop.height_px,
        rig.width_px,
        rig.height_px);
}

std::optional<PlaneSize> fit_to(const CameraNumbers& camera, Camera& rig) {
    if (!camera.expected) return std::nullopt;
    const PlaneSize images = camera.expected->image;
    const PlaneSize own{rig.width_px, rig.height_px};
    if (own.width_px == images.width_px) return std::nullopt;
    if (std::max(images.width_px, images.height_px) > kLargestImagePx) return std::nullopt;
    Camera scaled = rig;
    scale_to_width(scaled, images.width_px);
    if (scaled.height_px != images.height_px) return std::nullopt;
    rig = std::move(scaled);
    return own;
}

}  // namespace aphotic
