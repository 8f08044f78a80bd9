// SPDX-License-Identifier: BSD-3-Clause
#include "validation/report_pictures.h"

#include "image/preview.h"
#include "validation/comparison.h"

#include <algorithm>
#include <cmath>

namespace aphotic {
namespace {

int blocks(int pixels, int side) {
    return (pixels + side - 1) / side;
}

// Calls visit(index of the block, index of the sample) for every sample.
template <typename Visit>
void for_each_in_blocks(int width_px, int height_px, int side_px, const Visit& visit) {
    const auto width = static_cast<std::size_t>(width_px);
    const auto height = static_cast<std::size_t>(height_px);
    const auto side = static_cast<std::size_t>(side_px);
    const std::size_t across = (width + side - 1) / side;
    for (std::size_t row = 0; row < height; ++row) {
        for (std::size_t column = 0; column < width; ++column)
            visit(row / side * across + column / side, row * width + column);
    }
}

std::uint32_t colour_of(double e, double scale) {
    constexpr int kMost = (kColourSteps - 1) / 2;
    const double step = std::clamp(e / scale, -1.0, 1.0) * kMost;
    return error_colour(static_cast<int>(std::lround(step)));
}

}  // namespace

int block_side(int width_px, int height_px) {
    return blocks(std::max(width_px, height_px), kLargestPicture_px);
}

std::vector<double> block_means(std::span<const float> samples,
                                int width_px,
                                int side,
                                std::span<const unsigned char> marks) {
    const int height_px = static_cast<int>(samples.size()) / width_px;
    const auto size = static_cast<std::size_t>(blocks(width_px, side)) *
                      static_cast<std::size_t>(blocks(height_px, side));
    std::vector<double> means(size, 0.0);
    std::vector<double> counts(size, 0.0);
    for_each_in_blocks(width_px, height_px, side, [&](std::size_t block, std::size_t i) {
        if (!marks.empty() && marks[i] == kUnobserved) return;
        means[block] += samples[i];
        counts[block] += 1.0;
    });
    for (std::size_t block = 0; block < size; ++block) means[block] /= counts[block];
    return means;
}

CameraImage block_means(const CameraImage& image, int side) {
    CameraImage result{.width_px = blocks(image.width_px, side),
                       .height_px = blocks(image.height_px, side),
                       .samples = {}};
    const std::size_t pixels = image.samples.size() / kChannels;
    for (std::size_t c = 0; c < kChannels; ++c) {
        const auto plane = std::span(image.samples).subspan(c * pixels, pixels);
        for (const double mean : block_means(plane, image.width_px, side))
            result.samples.push_back(static_cast<float>(mean));
    }
    return result;
}

std::uint32_t colour_between(std::span<const std::uint32_t> stops, double share) {
    const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(stops.size() - 1);
    const auto stop = std::min(static_cast<std::size_t>(place), stops.size() - 2);
    std::uint32_t colour = 0;
    for (const unsigned shift : {16U, 8U, 0U}) {
        const double from = stops[stop] >> shift & 0xFFU;
        const double to = stops[stop + 1] >> shift & 0xFFU;
        const double level = std::lerp(from, to, place - static_cast<double>(stop));
        colour |= static_cast<std::uint32_t>(std::lround(level)) << shift;
    }
    return colour;
}

// Through a paler tone between white and the ends, so that small errors show too.
std::uint32_t error_colour(int step) {
    static constexpr std::array<std::uint32_t, 4> kBlues{0xFBFAF8, 0xBBD6EA, 0x3F86BD, 0x0B3166};
    static constexpr std::array<std::uint32_t, 4> kReds{0xFBFAF8, 0xF6CDB6, 0xD4594A, 0x6E0A1E};
    return colour_between(step < 0 ? kBlues : kReds, 2.0 * std::abs(step) / (kColourSteps - 1));
}

ErrorMap error_map(std::span<const float> errors,
                   std::span<const float> a,
                   std::span<const float> b,
                   int width_px,
                   double scale,
                   int least_side) {
    const int height_px = static_cast<int>(errors.size()) / width_px;
    ErrorMap map{.side = std::max(block_side(width_px, height_px), least_side)};
    map.width_px = blocks(width_px, map.side);
    map.height_px = blocks(height_px, map.side);

    const auto size =
        static_cast<std::size_t>(map.width_px) * static_cast<std::size_t>(map.height_px);
    std::vector<float> largest(size, 0.0F);
    std::vector<char> has_error(size, 0);
    std::vector<char> is_bad(size, 0);
    for_each_in_blocks(width_px, height_px, map.side, [&](std::size_t block, std::size_t i) {
        if (!std::isfinite(a[i]) || !std::isfinite(b[i])) {
            is_bad[block] = 1;
        } else if (!std::isnan(errors[i])) {
            has_error[block] = 1;
            if (std::abs(errors[i]) > std::abs(largest[block])) largest[block] = errors[i];
        }
    });

    std::vector<std::uint32_t> pixels(size, kEdgeColour);
    for (std::size_t i = 0; i < size; ++i) {
        if (has_error[i] != 0) pixels[i] = colour_of(largest[i], scale);
        if (is_bad[i] != 0) pixels[i] = kNotFiniteColour;
    }
    map.png = png_of(pixels, map.width_px, map.height_px);
    return map;
}

}  // namespace aphotic
