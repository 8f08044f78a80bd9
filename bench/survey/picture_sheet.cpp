// SPDX-License-Identifier: BSD-3-Clause
#include "bench/survey/picture_sheet.h"

#include "base/atomic_file.h"
#include "image/preview.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace aphotic::survey {
namespace {

constexpr std::size_t kGap_px = 6;  // white, between pictures

std::uint32_t shown(const CameraImage& image,
                    const std::array<double, kChannels>& scale,
                    std::size_t pixel) {
    const std::size_t pixels = image.samples.size() / kChannels;
    std::uint32_t colour = 0;
    for (std::size_t c = 0; c < kChannels; ++c) {
        const double level = srgb_encoded(scale[c] * image.samples[c * pixels + pixel]);
        colour = colour << 8U | static_cast<std::uint32_t>(std::lround(255.0 * level));
    }
    return colour;
}

}  // namespace

void write_sheet(const std::vector<SheetColumn>& columns, const std::filesystem::path& file) {
    const std::vector<CameraImage>& first = columns.front().images;
    const auto width = static_cast<std::size_t>(first.front().width_px);
    const auto height = static_cast<std::size_t>(first.front().height_px);
    const std::size_t width_px = columns.size() * (width + kGap_px) - kGap_px;
    const std::size_t height_px = first.size() * (height + kGap_px) - kGap_px;
    std::vector<std::uint32_t> sheet(width_px * height_px, 0xFFFFFFU);
    for (std::size_t column = 0; column < columns.size(); ++column) {
        for (std::size_t row = 0; row < first.size(); ++row) {
            for (std::size_t i = 0; i < width * height; ++i) {
                const std::size_t x = column * (width + kGap_px) + i % width;
                const std::size_t y = row * (height + kGap_px) + i / width;
                sheet.at(y * width_px + x) =
                    shown(columns[column].images[row], columns[column].scale, i);
            }
        }
    }
    write_text_file(file, png_of(sheet, static_cast<int>(width_px), static_cast<int>(height_px)));
}

}  // namespace aphotic::survey
