// SPDX-License-Identifier: BSD-3-Clause
#include "survey/images/raw_image.h"

#include "base/error.h"
#include "image/image_size.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>

namespace aphotic {

namespace {

struct MosaicSites {
    std::string_view name;
    std::array<int, 4> channels;  // top left, top right, bottom left, bottom right
};
// In the order of Mosaic.
constexpr std::array<MosaicSites, 6> kSitesOfMosaics{{{"none", {}},
                                                      {"mono", {}},
                                                      {"RGGB", {0, 1, 1, 2}},
                                                      {"BGGR", {2, 1, 1, 0}},
                                                      {"GRBG", {1, 0, 2, 1}},
                                                      {"GBRG", {1, 2, 0, 1}}}};

constexpr std::array kMosaics{Mosaic::Mono, Mosaic::Rggb, Mosaic::Bggr, Mosaic::Grbg, Mosaic::Gbrg};

const MosaicSites& sites_of(Mosaic mosaic) {
    return kSitesOfMosaics[static_cast<std::size_t>(mosaic)];
}

// The plane with one more pixel all around, mirrored about the outermost ones.
std::vector<float> with_mirrored_rim(std::span<const float> plane, int width_px, int height_px) {
    const auto mirrored = [](int i, int count) {
        return i < 0 ? -i : (i < count ? i : 2 * (count - 1) - i);
    };
    std::vector<float> padded;
    padded.reserve(size_of(width_px + 2) * size_of(height_px + 2));
    for (int row = -1; row <= height_px; ++row) {
        const auto line =
            plane.subspan(size_of(mirrored(row, height_px)) * size_of(width_px), size_of(width_px));
        padded.push_back(line[1]);
        padded.insert(padded.end(), line.begin(), line.end());
        padded.push_back(line[size_of(width_px - 2)]);
    }
    return padded;
}

// The sites that supply a channel: four neighbours of equal weight, repeated where there are only
// two or one.
using Neighbours = std::array<std::ptrdiff_t, 4>;

Neighbours neighbours_of(Mosaic mosaic, int column, int row, int channel, std::ptrdiff_t stride) {
    if (channel_at(mosaic, column, row) == channel) return {0, 0, 0, 0};
    const bool is_beside = channel_at(mosaic, column + 1, row) == channel;
    const bool is_below = channel_at(mosaic, column, row + 1) == channel;
    if (is_beside && is_below) return {-1, 1, -stride, stride};
    if (is_beside) return {-1, 1, -1, 1};
    if (is_below) return {-stride, stride, -stride, stride};
    return {-stride - 1, -stride + 1, stride - 1, stride + 1};
}

}  // namespace

std::optional<Mosaic> mosaic_named(std::string_view name) {
    const auto is_same = [](char a, char b) { return (a & ~0x20) == (b & ~0x20); };  // ASCII's case
    for (const Mosaic mosaic : kMosaics) {
        if (std::ranges::equal(name, mosaic_name(mosaic), is_same)) return mosaic;
    }
    return std::nullopt;
}

Mosaic shifted(Mosaic mosaic, int columns, int rows) {
    const auto begins_alike = [&](Mosaic other) {
        return is_bayer(other) && channel_at(other, 0, 0) == channel_at(mosaic, columns, rows) &&
               channel_at(other, 1, 0) == channel_at(mosaic, columns + 1, rows);
    };
    return is_bayer(mosaic) ? *std::ranges::find_if(kMosaics, begins_alike) : mosaic;
}

std::string_view mosaic_name(Mosaic mosaic) {
    return sites_of(mosaic).name;
}

int channel_at(Mosaic mosaic, int column, int row) {
    return sites_of(mosaic).channels[size_of((row & 1) * 2 + (column & 1))];
}

void require_size(const RawImage& image, int width_px, int height_px, std::string_view as) {
    if (image.width_px == width_px && image.height_px == height_px) return;
    const bool is_double =
        std::int64_t{image.width_px} * height_px == 2 * std::int64_t{width_px} * image.height_px;
    throw InputError("found {} x {} pixels; allowed: {} x {}, {}{}",
                     image.width_px,
                     image.height_px,
                     width_px,
                     height_px,
                     as,
                     is_double ? "; if two cameras' images are side by side, --half" : "");
}

void require_like(const RawImage& image, const RawImage& other, std::string_view as) {
    require_size(image, other.width_px, other.height_px, as);
    if (image.mosaic == other.mosaic) return;
    throw InputError("found the pattern {}; allowed: {}, {}",
                     mosaic_name(image.mosaic),
                     mosaic_name(other.mosaic),
                     as);
}

std::vector<float> demosaiced(std::span<const float> plane,
                              int width_px,
                              int height_px,
                              Mosaic mosaic) {
    assert(width_px >= 2 && height_px >= 2 && is_bayer(mosaic));
    constexpr float kQuarter = 0.25F;
    const std::vector<float> padded = with_mirrored_rim(plane, width_px, height_px);
    const std::ptrdiff_t stride = width_px + 2;
    std::vector<float> planes(plane.size() * size_of(kChannels));
    for (int channel = 0; channel < kChannels; ++channel) {
        for (int row = 0; row < height_px; ++row) {
            const float* const from = padded.data() + (row + 1) * stride + 1;
            float* const to =
                planes.data() + size_of(channel) * plane.size() + size_of(row) * size_of(width_px);
            for (const int first : {0, 1}) {
                const Neighbours at = neighbours_of(mosaic, first, row, channel, stride);
                for (int column = first; column < width_px; column += 2) {
                    const float* const site = from + column;
                    to[column] =
                        kQuarter * ((site[at[0]] + site[at[1]]) + (site[at[2]] + site[at[3]]));
                }
            }
        }
    }
    return planes;
}

namespace {

// Where a plane's sites are in the image's samples.
struct Sites {
    std::size_t step = 1;  // from one to the next, across and down
    std::size_t first_column = 0;
    std::size_t first_row = 0;
    std::size_t origin = 0;  // of the plane that holds them

    // Calls visit(index in the plane, index in the image) for each, row by row.
    template <typename Visit>
    void for_each(const RawImage& image, const Visit& visit) const {
        const std::size_t width = size_of(image.width_px);
        std::size_t site = 0;
        for (std::size_t row = first_row; row < size_of(image.height_px); row += step) {
            for (std::size_t column = first_column; column < width; column += step)
                visit(site++, origin + row * width + column);
        }
    }
};

Sites sites_of_plane(const RawImage& image, std::size_t plane) {
    if (!is_bayer(image.mosaic)) return {.origin = plane * image.pixels()};
    return {.step = 2, .first_column = plane % 2, .first_row = plane / 2};
}

}  // namespace

std::vector<SitePlane> site_planes(const RawImage& image) {
    std::vector<SitePlane> planes(is_bayer(image.mosaic) ? 4 : size_of(image.planes()));
    for (std::size_t p = 0; p < planes.size(); ++p) {
        const Sites sites = sites_of_plane(image, p);
        const auto count = [&](int pixels, std::size_t first) {
            return static_cast<int>((size_of(pixels) - first + sites.step - 1) / sites.step);
        };
        planes[p].width_px = count(image.width_px, sites.first_column);
        planes[p].height_px = count(image.height_px, sites.first_row);
        planes[p].samples.resize(size_of(planes[p].width_px) * size_of(planes[p].height_px));
        sites.for_each(image, [&](std::size_t site, std::size_t at) {
            planes[p].samples[site] = image.samples[at];
        });
    }
    return planes;
}

void put_site_planes(const std::vector<SitePlane>& planes, RawImage& image) {
    for (std::size_t p = 0; p < planes.size(); ++p) {
        const auto put = [&](std::size_t site, std::size_t at) {
            image.samples[at] = planes[p].samples[site];
        };
        sites_of_plane(image, p).for_each(image, put);
    }
}

}  // namespace aphotic
