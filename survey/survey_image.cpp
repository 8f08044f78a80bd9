// SPDX-License-Identifier: BSD-3-Clause
#include "survey/survey_image.h"

#include "base/error.h"
#include "image/any_image.h"
#include "survey/image_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse_channels(const AnyImage& image, std::string_view allowed) {
    throw InputError(
        "found the channels {}; allowed: {}", fmt::join(image.channels, ", "), allowed);
}

// Where those that are wanted stand among the file's.
std::vector<std::size_t> places_of(const AnyImage& image, Mosaic mosaic) {
    if (mosaic != Mosaic::None) {
        if (image.channels.size() != 1) refuse_channels(image, "one, with --bayer");
        return {0};
    }
    if (image.channels.size() == 1) {
        throw InputError(
            "found one channel and no --bayer; allowed: R, G, B, or a mosaic whose pattern --bayer "
            "names");
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

void keep_planes(std::vector<float>& planes,
                 std::size_t pixels,
                 const std::vector<std::size_t>& places) {
    std::vector<float> kept;
    kept.reserve(places.size() * pixels);
    for (const std::size_t place : places) {
        const auto first = planes.begin() + static_cast<std::ptrdiff_t>(place * pixels);
        kept.insert(kept.end(), first, first + static_cast<std::ptrdiff_t>(pixels));
    }
    planes = std::move(kept);
}

SurveyImage survey_image_of(const AnyImage& image, const CameraNumbers& camera) {
    const std::vector<std::size_t> places = places_of(image, camera.mosaic);
    if (camera.mosaic != Mosaic::None && std::min(image.width_px, image.height_px) < 2) {
        throw InputError("found {} x {} pixels; allowed: 2 or more each way, of a mosaic",
                         image.width_px,
                         image.height_px);
    }
    const bool is_whole_numbers = image.full_scale > 0.0;
    const double scale = is_whole_numbers ? image.full_scale : 1.0;
    SurveyImage taken{
        .raw = {.width_px = image.width_px, .height_px = image.height_px, .mosaic = camera.mosaic},
        .levels = {.black = camera.black_level},
        .description = image.description,
        .date_time = image.date_time};
    taken.raw.samples = image.planes();
    if (image.channels.size() > 1) keep_planes(taken.raw.samples, taken.raw.pixels(), places);
    for (float& sample : taken.raw.samples) sample = static_cast<float>(sample * scale);
    if (is_whole_numbers) {
        taken.levels.white = static_cast<float>(scale);
        taken.rounding = 1.0 / std::sqrt(12.0);
    }
    if (camera.white_level) taken.levels.white = *camera.white_level;
    return taken;
}

}  // namespace

SurveyImage read_survey_image(const fs::path& file, const CameraNumbers& camera) {
    require_file(file);
    try {
        return survey_image_of(open_any_image(file), camera);
    } catch (const InputError& error) {
        const std::string_view words = error.what();
        const std::string name = file.string() + ": ";
        throw InputError(std::string(words.starts_with(name) ? words.substr(name.size()) : words));
    }
}

void take_off_black(SurveyImage& taken) {
    for (float& sample : taken.raw.samples) sample -= taken.levels.black;
}

}  // namespace aphotic
