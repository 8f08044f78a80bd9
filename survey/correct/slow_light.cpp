// SPDX-License-Identifier: BSD-3-Clause
#include "survey/correct/slow_light.h"

#include "base/error.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace aphotic {

namespace {

constexpr int kBoxes = 5;

using ImagePlane = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// 2 radius + 1 samples of weight 1, and one of weight `end` on either side of them.
struct BoxFilter {
    int radius = 0;
    double end = 0.0;

    [[nodiscard]] double weight() const { return 2.0 * radius + 1.0 + 2.0 * end; }
};

// The longest box of whole samples whose variance is not above the wanted one, (L^2 - 1) / 12; its
// ends provide the rest.
BoxFilter box_of(double variance) {
    BoxFilter box{.radius = static_cast<int>((std::sqrt(12.0 * variance + 1.0) - 1.0) / 2.0)};
    const double r = box.radius;
    box.end = (2.0 * r + 1.0) * (r * (r + 1.0) - 3.0 * variance) /
              (6.0 * (variance - (r + 1.0) * (r + 1.0)));
    return box;
}

// The index in the line itself of sample `at` of the mirrored line.
std::ptrdiff_t mirrored(std::ptrdiff_t at, std::ptrdiff_t length) {
    const std::ptrdiff_t in_period = ((at % (2 * length)) + 2 * length) % (2 * length);
    return in_period < length ? in_period : 2 * length - 1 - in_period;
}

void smooth_line(std::span<double> line, const BoxFilter& box, std::vector<double>& padded) {
    const auto length = static_cast<std::ptrdiff_t>(line.size());
    const std::ptrdiff_t pad = box.radius + 1;
    padded.resize(static_cast<std::size_t>(length + 2 * pad));
    for (std::ptrdiff_t i = -pad; i < length + pad; ++i)
        padded[static_cast<std::size_t>(i + pad)] =
            line[static_cast<std::size_t>(mirrored(i, length))];
    const auto width = static_cast<std::size_t>(2 * pad);
    double sum = std::accumulate(padded.begin() + 1, padded.begin() + 2 * pad, 0.0);
    for (std::size_t i = 0; i < line.size(); ++i) {
        line[i] = (sum + box.end * (padded[i] + padded[i + width])) / box.weight();
        sum += padded[i + width] - padded[i + 1];
    }
}

void smooth_rows(ImagePlane& plane, const BoxFilter& box) {
    std::vector<double> padded;
    for (Eigen::Index row = 0; row < plane.rows(); ++row) {
        const std::span line(plane.row(row).data(), static_cast<std::size_t>(plane.cols()));
        for (int pass = 0; pass < kBoxes; ++pass) smooth_line(line, box, padded);
    }
}

}  // namespace

std::vector<float> gaussian_blur(std::span<const float> plane, int width_px, double sigma_px) {
    using FloatPlane = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Eigen::Index height = static_cast<Eigen::Index>(plane.size()) / width_px;
    const BoxFilter box = box_of(sigma_px * sigma_px / kBoxes);
    ImagePlane smooth = Eigen::Map<const FloatPlane>(plane.data(), height, width_px).cast<double>();
    smooth_rows(smooth, box);
    ImagePlane turned = smooth.transpose();
    smooth_rows(turned, box);
    std::vector<float> result(plane.size());
    Eigen::Map<FloatPlane>(result.data(), height, width_px) = turned.transpose().cast<float>();
    return result;
}

double mean_of(std::span<const float> plane) {
    return std::accumulate(plane.begin(), plane.end(), 0.0) / static_cast<double>(plane.size());
}

std::vector<float> divided_by_pattern(std::span<const float> plane,
                                      std::span<const float> pattern) {
    assert(plane.size() == pattern.size());
    const double mean = mean_of(pattern);
    std::vector<float> result(plane.begin(), plane.end());
    if (!(mean > 0.0)) return result;  // no light, no pattern
    for (std::size_t i = 0; i < plane.size(); ++i) {
        const double light = std::max<double>(pattern[i], kLeastShare * mean);
        result[i] = static_cast<float>(plane[i] / light * mean);
    }
    return result;
}

std::vector<float> illumination_reflectance(std::span<const float> plane,
                                            int width_px,
                                            double sigma_px) {
    return divided_by_pattern(plane, gaussian_blur(plane, width_px, sigma_px));
}

std::vector<float> homomorphic(std::span<const float> plane,
                               int width_px,
                               const Homomorphic& filter) {
    std::vector<float> result = logarithms(plane);
    const double mean = mean_of(result);
    const std::vector<float> slow = gaussian_blur(result, width_px, filter.sigma_px);
    for (std::size_t i = 0; i < plane.size(); ++i) {
        const double log_out =
            mean + filter.low * (slow[i] - mean) + filter.high * (result[i] - slow[i]);
        result[i] = static_cast<float>(std::exp(log_out));
    }
    return result;
}

std::vector<float> logarithms(std::span<const float> plane) {
    const double black = kBlackShare * mean_of(plane);
    std::vector<float> logs(plane.size(), 0.0F);
    if (!(black > 0.0)) return logs;
    std::ranges::transform(plane, logs.begin(), [&](float sample) {
        return static_cast<float>(std::log(std::max<double>(sample, black)));
    });
    return logs;
}

std::vector<float> exponentials(std::span<const float> plane) {
    std::vector<float> result(plane.size());
    std::ranges::transform(plane, result.begin(), [](float log) { return std::exp(log); });
    return result;
}

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

// The excess is spread over all bins equally, including those at the limit, as in Zuiderveld.
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

// The two tiles whose centres enclose a pixel, and its position between them.
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

// F of the tile's samples, by bin.
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
