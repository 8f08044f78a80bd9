// SPDX-License-Identifier: BSD-3-Clause
#include "cli/survey_image.h"

#include "spectral/error.h"
#include "spectral/exr.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace aphotic::cli {

namespace {

// The order in which the file has its channels.
std::vector<std::size_t> wanted_channels(const AnyImage& image, Mosaic mosaic) {
    if (mosaic != Mosaic::None) {
        if (image.channels.size() == 1) return {0};
        throw InputError(fmt::format("found the channels {}; allowed with --bayer: one",
                                     fmt::join(image.channels, ", ")));
    }
    std::vector<std::size_t> order;
    for (const std::string_view name : kChannelNames) {
        const auto found = std::ranges::find(image.channels, name);
        if (found == image.channels.end()) {
            throw InputError(
                fmt::format("found the channels {}; allowed: R, G, B, or one of a mosaic that "
                            "--bayer names",
                            fmt::join(image.channels, ", ")));
        }
        order.push_back(static_cast<std::size_t>(found - image.channels.begin()));
    }
    return order;
}

std::vector<std::string> channel_names(const RawImage& image) {
    if (image.mosaic != Mosaic::None) return {"Y"};
    return {kChannelNames.begin(), kChannelNames.end()};
}

}  // namespace

SurveyImage read_survey_image(const std::filesystem::path& file,
                              PlaneSize size,
                              const CameraNumbers& camera) {
    const AnyImage image = open_any_image(file);
    if (image.width_px != size.width_px || image.height_px != size.height_px) {
        throw InputError(fmt::format("found {} x {} pixels; allowed: {} x {}, as the map has",
                                     image.width_px,
                                     image.height_px,
                                     size.width_px,
                                     size.height_px));
    }
    const std::vector<std::size_t> order = wanted_channels(image, camera.mosaic);
    const std::vector<float> planes = image.planes();
    const auto scale = static_cast<float>(image.full_scale > 0.0 ? image.full_scale : 1.0);
    SurveyImage taken{.raw = {.width_px = size.width_px,
                              .height_px = size.height_px,
                              .mosaic = camera.mosaic,
                              .samples = {}},
                      .levels = {.black = camera.black_level},
                      .description = image.description,
                      .date_time = image.date_time};
    const std::size_t pixels = taken.raw.pixels();
    taken.raw.samples.reserve(order.size() * pixels);
    for (const std::size_t channel : order) {
        for (std::size_t i = channel * pixels; i < (channel + 1) * pixels; ++i) {
            taken.raw.samples.push_back(planes[i] * scale);
        }
    }
    if (image.full_scale > 0.0) {
        taken.levels.white = scale;
        taken.rounding = 1.0 / std::sqrt(12.0);  // of whole numbers
    }
    if (camera.white_level) taken.levels.white = *camera.white_level;
    return taken;
}

void write_corrected(const std::filesystem::path& file,
                     const RawImage& image,
                     const SurveyImage& source) {
    if (file.extension() == ".exr") {
        ExrAttributes attributes{{"aphotic:version", APHOTIC_VERSION}};
        if (!source.description.empty()) attributes.emplace_back("comments", source.description);
        if (!source.date_time.empty()) attributes.emplace_back("capDate", source.date_time);
        ExrWriter writer(file, image.width_px, image.height_px, channel_names(image), attributes);
        writer.write_rows(image.height_px, image.samples);
        writer.finish();
        return;
    }
    write_any_image(file,
                    {.width_px = image.width_px,
                     .height_px = image.height_px,
                     .channels = channel_names(image),
                     .planes = image.samples,
                     .type = SampleType::Bits16,
                     .description = source.description,
                     .date_time = source.date_time});
}

void write_mask(const std::filesystem::path& file, const CorrectedImage& image) {
    constexpr float kByte = 255.0F;
    std::vector<float> plane;
    plane.reserve(image.doubts.size());
    for (const std::uint8_t doubt : image.doubts) {
        plane.push_back(static_cast<float>(doubt) / kByte);
    }
    write_any_image(file,
                    {.width_px = image.image.width_px,
                     .height_px = image.image.height_px,
                     .channels = {"Y"},
                     .planes = std::move(plane),
                     .type = SampleType::Bits8,
                     .description = "",
                     .date_time = ""});
}

}  // namespace aphotic::cli
