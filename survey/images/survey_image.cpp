// SPDX-License-Identifier: BSD-3-Clause
#include "survey/images/survey_image.h"

#include "base/error.h"
#include "image/any_image.h"
#include "image/image_size.h"
#include "image/raw_file.h"
#include "survey/images/image_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <span>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse_channels(const AnyImage& image, std::string_view allowed) {
    throw InputError("found the channels {}; allowed: {}", names_of(image.channels), allowed);
}

// The positions of the wanted channels among the file's.
std::vector<std::size_t> places_of(const AnyImage& image, Mosaic mosaic) {
    if (mosaic != Mosaic::None) {
        if (image.channels.size() != 1) {
            refuse_channels(image, fmt::format("one, with --bayer {}", mosaic_name(mosaic)));
        }
        return {0};
    }
    if (image.channels.size() == 1) {
        throw InputError(
            "found one channel and no --bayer; allowed: R, G, B, a mosaic whose pattern --bayer "
            "names, or --bayer mono");
    }
    std::vector<std::size_t> places;
    for (const std::string_view name : kChannelNames) {
        const auto found = std::ranges::find(image.channels, name);
        if (found == image.channels.end()) {
            refuse_channels(image, "R, G, B");
        }
        places.push_back(static_cast<std::size_t>(found - image.channels.begin()));
    }
    return places;
}

// The planes at these positions, cropped.
std::vector<float> kept_of(std::vector<float> planes,
                           PlaneSize size,
                           const std::vector<std::size_t>& places,
                           const Crop& crop) {
    const Crop whole{.width_px = size.width_px, .height_px = size.height_px};
    const std::size_t width = size_of(size.width_px);
    const std::size_t pixels = width * size_of(size.height_px);
    if (crop == whole && planes.size() == places.size() * pixels &&
        std::ranges::is_sorted(places)) {
        return planes;
    }
    std::vector<float> kept;
    kept.reserve(places.size() * size_of(crop.width_px) * size_of(crop.height_px));
    for (const std::size_t place : places) {
        for (int row = 0; row < crop.height_px; ++row) {
            const auto first = std::span(planes).subspan(
                place * pixels + size_of(crop.top_px + row) * width + size_of(crop.left_px),
                size_of(crop.width_px));
            kept.insert(kept.end(), first.begin(), first.end());
        }
    }
    return kept;
}

void require_expected(const Crop& crop, PlaneSize file, const ExpectedSize& expected) {
    constexpr std::int64_t kFew = std::int64_t{1} << 24U;  // more pixels than the others have
    const auto pixels = [](PlaneSize size) { return std::int64_t{size.width_px} * size.height_px; };
    require_size({.width_px = crop.width_px, .height_px = crop.height_px},
                 expected.image.width_px,
                 expected.image.height_px,
                 expected.as);
    if (pixels(file) <= std::max(pixels(expected.file), pixels(expected.image)) + kFew) return;
    throw InputError("found {} x {} pixels in the file; allowed: about {} x {}, like the others",
                     file.width_px,
                     file.height_px,
                     expected.file.width_px,
                     expected.file.height_px);
}

// Without its samples; the mosaic is that of the whole file.
SurveyImage cropped_image(const CameraNumbers& camera, PlaneSize file, Mosaic mosaic) {
    const Crop crop = crop_of(camera, file);
    if (is_bayer(mosaic) && std::min(crop.width_px, crop.height_px) < 2) {
        throw InputError("found {} x {} pixels; allowed: 2 or more each way, for a mosaic",
                         crop.width_px,
                         crop.height_px);
    }
    if (camera.expected) require_expected(crop, file, *camera.expected);
    return {.raw = {.width_px = crop.width_px,
                    .height_px = crop.height_px,
                    .mosaic = shifted(mosaic, crop.left_px, crop.top_px)},
            .crop = crop,
            .levels = {.black = camera.black_level.value_or(0.0F)},
            .rounding = 0.0,
            .description = {},
            .date_time = {}};
}

// One plane at a time if the file has many channels: it may have any number of others.
std::vector<float> wanted_planes(const AnyImage& image,
                                 PlaneSize size,
                                 const std::vector<std::size_t>& places,
                                 const Crop& crop) {
    constexpr std::size_t kFewChannels = 4;
    if (image.channels.size() <= kFewChannels) return kept_of(image.planes(), size, places, crop);
    std::vector<float> all;
    for (const std::size_t place : places) {
        const std::vector<float> plane = kept_of(image.samples(place), size, {0}, crop);
        all.insert(all.end(), plane.begin(), plane.end());
    }
    return all;
}

// Whole numbers have a limit; levels beyond it belong to other files.
void require_levels(const SensorLevels& levels, double most) {
    if (levels.white > most) {
        throw InputError("white level: found {}; allowed: up to {}, the file's largest number",
                         levels.white,
                         most);
    }
    if (levels.black >= levels.white) {
        throw InputError("black level: found {}; allowed: less than the white level, {}",
                         levels.black,
                         levels.white);
    }
}

constexpr double kRounding = 0.28867513459481287;  // 1 / sqrt(12): of whole numbers

SurveyImage survey_image_of(const AnyImage& image, const CameraNumbers& camera) {
    const Mosaic mosaic = camera.mosaic.value_or(Mosaic::None);
    const std::vector<std::size_t> places = places_of(image, mosaic);
    const PlaneSize size{image.width_px, image.height_px};
    SurveyImage taken = cropped_image(camera, size, mosaic);
    taken.description = image.description;
    taken.date_time = image.date_time;
    taken.raw.samples = wanted_planes(image, size, places, taken.crop);
    if (image.full_scale > 0.0) {
        const double scale = image.full_scale;
        for (float& sample : taken.raw.samples) sample = static_cast<float>(sample * scale);
        taken.levels.white = static_cast<float>(scale);
        taken.rounding = kRounding;
    }
    if (camera.white_level) taken.levels.white = *camera.white_level;
    require_levels(
        taken.levels,
        image.full_scale > 0.0 ? image.full_scale : std::numeric_limits<double>::infinity());
    return taken;
}

Mosaic mosaic_of(const RawFile& file, const CameraNumbers& camera) {
    const Mosaic mosaic = mosaic_named(file.pattern).value_or(Mosaic::None);
    if (!camera.mosaic || *camera.mosaic == mosaic) return mosaic;
    throw InputError("--bayer, or the rig's: found {}; allowed: {}, as the raw file says",
                     mosaic_name(*camera.mosaic),
                     mosaic == Mosaic::None ? "none, for R, G and B" : mosaic_name(mosaic));
}

SurveyImage survey_image_of(const RawFile& file, const CameraNumbers& camera) {
    const PlaneSize size{file.width_px, file.height_px};
    SurveyImage taken = cropped_image(camera, size, mosaic_of(file, camera));
    const std::vector<std::size_t> all{0, 1, 2};
    taken.raw.samples =
        kept_of(file.samples(), size, {all.begin(), all.begin() + taken.raw.planes()}, taken.crop);
    taken.rounding = kRounding;
    taken.levels.black = camera.black_level.value_or(static_cast<float>(file.black));
    taken.levels.white = camera.white_level.value_or(static_cast<float>(file.white));
    require_levels(taken.levels, std::numeric_limits<double>::infinity());
    return taken;
}

// The result of read(), whose messages lose the file's name.
template <typename Read>
auto without_name(const fs::path& file, const Read& read) {
    require_file(file);
    try {
        return read();
    } catch (const InputError& error) {
        const std::string_view words = error.what();
        const std::string name = file.string() + ": ";
        throw InputError(std::string(words.starts_with(name) ? words.substr(name.size()) : words));
    }
}

}  // namespace

SurveyImage read_survey_image(const fs::path& file, const CameraNumbers& camera) {
    return without_name(file, [&] {
        SurveyImage taken = is_raw_name(file) ? survey_image_of(open_raw_file(file), camera)
                                              : survey_image_of(open_any_image(file), camera);
        taken.tags = read_image_tags(file);
        if (is_told_by_exif(camera.exposure_by)) {
            const ShotExposure shot = taken.tags ? exposure_of(*taken.tags) : ShotExposure{};
            taken.exposure = relative_exposure(shot, camera);
        }
        return taken;
    });
}

PlaneSize size_in(const fs::path& file) {
    return without_name(file, [&] {
        const auto size = [](const auto& image) {
            return PlaneSize{image.width_px, image.height_px};
        };
        return is_raw_name(file) ? size(open_raw_file(file)) : size(open_any_image(file));
    });
}

void take_off_black(SurveyImage& taken) {
    const auto share = static_cast<float>(1.0 / taken.exposure);
    for (float& sample : taken.raw.samples) sample = share * (sample - taken.levels.black);
    taken.levels = {.black = 0.0F, .white = share * (taken.levels.white - taken.levels.black)};
}

}  // namespace aphotic
