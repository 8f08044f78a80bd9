// SPDX-License-Identifier: BSD-3-Clause
#include "survey/local_equalisation.h"

#include "base/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace aphotic {
namespace {

// F at the lower end of each bin, and at the upper end of the last.
using Shares = std::array<double, kBins + 1>;

// A sample's place among the bins, from 0 to kBins.
struct Scale {
    float least = 0.0F;
    float most = 0.0F;

    [[nodiscard]] double place(float sample) const {
        return kBins * (static_cast<double>(sample) - least) / (static_cast<double>(most) - least);
    }
    [[nodiscard]] float sample(double share) const {
        return static_cast<float>(std::lerp(static_cast<double>(least), most, share));
    }
};

std::size_t bin_at(double place) {
    return std::min(static_cast<std::size_t>(place), static_cast<std::size_t>(kBins - 1));
}

// What is cut off falls on all bins alike, those at the limit included, as Zuiderveld has it.
Shares shares_of(const std::array<double, kBins>& counts, double samples, double clip) {
    const double limit = clip * samples / kBins;
    double cut = 0.0;
    for (const double count : counts) cut += std::max(0.0, count - limit);
    Shares shares{};
    for (std::size_t bin = 0; bin < counts.size(); ++bin) {
        const double held = std::min(counts[bin], limit) + cut / kBins;
        shares[bin + 1] = shares[bin] + held / samples;
    }
    return shares;
}

double share_below(const Shares& shares, double place) {
    const std::size_t bin = bin_at(place);
    const double within = place - static_cast<double>(bin);
    return shares[bin] + within * (shares[bin + 1] - shares[bin]);
}

// The two tiles whose centres lie about a pixel, and how far it is from the first to the second.
struct Between {
    std::size_t first = 0;
    std::size_t second = 0;
    double share = 0.0;
};

Between tiles_about(std::size_t pixel, std::size_t pixels, std::size_t tiles) {
    const auto count = static_cast<double>(tiles);
    const double at =
        (static_cast<double>(pixel) + 0.5) / static_cast<double>(pixels) * count - 0.5;
    const double inside = std::clamp(at, 0.0, count - 1.0);
    const auto first = static_cast<std::size_t>(inside);
    return {.first = first,
            .second = std::min(first + 1, tiles - 1),
            .share = inside - static_cast<double>(first)};
}

// Of the tile's samples, by bin: F.
Shares shares_in_tile(std::span<const float> plane,
                      std::size_t width,
                      std::size_t tile,
                      const LocalEqualisation& options,
                      const Scale& scale) {
    const auto tiles = static_cast<std::size_t>(options.tiles);
    const std::size_t height = plane.size() / width;
    const std::size_t across = tile % tiles;
    const std::size_t down = tile / tiles;
    std::array<double, kBins> counts{};
    double samples = 0.0;
    for (std::size_t row = down * height / tiles; row < (down + 1) * height / tiles; ++row) {
        const std::size_t first = across * width / tiles;
        const std::size_t end = (across + 1) * width / tiles;
        for (const float sample : plane.subspan(row * width + first, end - first)) {
            counts[bin_at(scale.place(sample))] += 1.0;
            samples += 1.0;
        }
    }
    return shares_of(counts, samples, options.clip);
}

}  // namespace

std::vector<float> locally_equalised(std::span<const float> plane,
                                     int width_px,
                                     const LocalEqualisation& options) {
    const auto width = static_cast<std::size_t>(width_px);
    const std::size_t height = plane.size() / width;
    const auto tiles = static_cast<std::size_t>(options.tiles);
    if (tiles > std::min(width, height)) {
        throw InputError(
            "local equalisation: found {} tiles; allowed: at most {}, the pixels of the image's "
            "shorter side",
            tiles,
            std::min(width, height));
    }
    const auto ends = std::ranges::minmax(plane);
    const Scale scale{.least = ends.min, .most = ends.max};
    std::vector<float> result(plane.begin(), plane.end());
    if (scale.least == scale.most) return result;
    std::vector<Shares> shares;
    for (std::size_t tile = 0; tile < tiles * tiles; ++tile)
        shares.push_back(shares_in_tile(plane, width, tile, options, scale));

    for (std::size_t row = 0; row < height; ++row) {
        const Between down = tiles_about(row, height, tiles);
        for (std::size_t column = 0; column < width; ++column) {
            const Between across = tiles_about(column, width, tiles);
            float& sample = result[row * width + column];
            const double place = scale.place(sample);
            const auto share_of = [&](std::size_t line) {
                return std::lerp(share_below(shares[line * tiles + across.first], place),
                                 share_below(shares[line * tiles + across.second], place),
                                 across.share);
            };
            const double share = std::lerp(share_of(down.first), share_of(down.second), down.share);
            sample = scale.sample(share);
        }
    }
    return result;
}

}  // namespace aphotic
