// SPDX-License-Identifier: BSD-3-Clause
#include "survey/camera_numbers.h"

#include "base/error.h"
#include "base/number.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <string_view>
#include <system_error>
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
    if (camera.exposure_by == ExposureBy::Nothing) return camera;
    camera.reference = shot_of(readout);
    if (camera.exposure_by == ExposureBy::Flash) camera.reference.time_s.reset();
    return camera;
}

ShotExposure shot_of(const Readout& readout) {
    constexpr double kMillisecondsPerSecond =
        1e3;  // to divide by: 2.5 ms are 0.0025 s, rounded once
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
    const auto number = [](std::optional<double> told) {
        return told ? nlohmann::ordered_json(*told) : nlohmann::ordered_json();
    };
    json["exposure"] = {{"by", camera.exposure_by == ExposureBy::Exif ? "exif" : "flash"},
                        {"time_s", number(camera.reference.time_s)},
                        {"iso", number(camera.reference.iso)},
                        {"f_number", number(camera.reference.f_number)}};
    return json;
}

}  // namespace aphotic
