// SPDX-License-Identifier: BSD-3-Clause
#include "survey/dropouts.h"

#include "base/upper_median.h"
#include "image/image_size.h"
#include "survey/fixed_pattern.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace aphotic {
namespace {

constexpr double kUnseen = std::numeric_limits<double>::quiet_NaN();
constexpr double kMedianOfT4 = 0.7407;  // of the absolute value
constexpr double kPeakOfT4 = 0.375;     // density at 0
constexpr double kLeastScale = 0.02;    // poses and maps are no better than this
constexpr double kFewDetail = 0.1;      // the least for few images

// Means over cells of samples that arrive row by row.
class CellMeans {
  public:
    CellMeans(int side, int width_px, int height_px)
        : side_(size_of(side)), height_(size_of(height_px)), cells_(side_ * side_) {
        for (std::size_t column = 0; column < size_of(width_px); ++column)
            across_.push_back(column * side_ / size_of(width_px));
    }
    void begin_row(std::size_t row) { row_ = &cells_[row * side_ / height_ * side_]; }
    void add(std::size_t column, double sample, bool is_saturated) {
        Cell& cell = row_[across_[column]];
        cell.sum += sample;
        cell.count += 1;
        cell.saturated += is_saturated ? 1 : 0;
    }
    [[nodiscard]] CellPlane means() const {
        constexpr std::size_t kOneIn = 100;
        CellPlane means;
        for (const Cell& cell : cells_) {
            const bool is_seen = cell.count > 0 && kOneIn * cell.saturated <= cell.count;
            means.push_back(is_seen ? cell.sum / static_cast<double>(cell.count) : kUnseen);
        }
        return means;
    }

  private:
    struct Cell {
        double sum = 0.0;
        std::size_t count = 0;
        std::size_t saturated = 0;
    };
    std::size_t side_;
    std::size_t height_;
    std::vector<Cell> cells_;
    std::vector<std::size_t> across_;
    Cell* row_ = nullptr;
};

// use(size, d): for cells of 2 x 2, then of 4 x 4 and so on.
template <typename Use>
void for_details(CellPlane z, std::size_t side, const Use& use) {
    for (std::size_t size = 0; side > 1; ++size, side /= 2) {
        CellPlane coarser;
        for (std::size_t k = 0; k < side * side / 4; ++k) {
            const std::size_t first = (k / (side / 2) * side + k % (side / 2)) * 2;
            const double a = z[first];
            const double b = z[first + 1];
            const double c = z[first + side];
            const double d = z[first + side + 1];
            double sum = 0.0;
            int seen = 0;
            for (const double one : {a, b, c, d}) {
                if (!std::isfinite(one)) continue;
                sum += one;
                ++seen;
            }
            coarser.push_back(seen >= 2 ? sum / seen : kUnseen);
            if (seen < 4) continue;
            use(size, (a - b + c - d) / 2.0);
            use(size, (a + b - c - d) / 2.0);
            use(size, (a - b - c + d) / 2.0);
        }
        z = std::move(coarser);
    }
}

// An image's cells that count, and its stray light.
struct View {
    const LightCells& image;
    double brightest;

    explicit View(const LightCells& of) : image(of), brightest(std::ranges::max(of.light)) {}
    [[nodiscard]] bool counts(std::size_t k) const {
        return std::isfinite(image.signal[k]) && image.light[k] > 0.0 &&
               image.light[k] >= kDarkestCell * brightest;
    }
    [[nodiscard]] CellPlane light_without(std::uint64_t out) const {
        CellPlane light = image.light;
        for (std::size_t s = 0; s < image.strobes.size(); ++s) {
            if ((out >> s & 1U) == 0) continue;
            for (std::size_t k = 0; k < light.size(); ++k) light[k] -= image.strobes[s][k];
        }
        return light;
    }
    // The median of signal over light; NaN if no cell counts.
    [[nodiscard]] double quotient(const CellPlane& lit) const {
        std::vector<double> quotients;
        for (std::size_t k = 0; k < lit.size(); ++k)
            if (counts(k) && lit[k] >= kDarkestCell * brightest)
                quotients.push_back(image.signal[k] / lit[k]);
        return upper_median(quotients);
    }
    // All signal over all light: a single lamp in a corner still contributes.
    [[nodiscard]] double brightness() const {
        double signal = 0.0;
        double light = 0.0;
        for (std::size_t k = 0; k < image.light.size(); ++k) {
            if (!counts(k)) continue;
            signal += image.signal[k];
            light += image.light[k];
        }
        return signal / light;
    }
    [[nodiscard]] CellPlane residual(const CellPlane& lit, double exposure) const {
        const double stray = kStray * brightest;
        CellPlane z;
        for (std::size_t k = 0; k < lit.size(); ++k) {
            const double signal = std::max(image.signal[k] / exposure, 0.0);
            z.push_back(counts(k) ? std::log((signal + stray) / (std::max(lit[k], 0.0) + stray))
                                  : kUnseen);
        }
        return z;
    }
    [[nodiscard]] double share_without(std::uint64_t out) const {
        const CellPlane light = light_without(out);
        double on = 0.0;
        double all = 0.0;
        for (std::size_t k = 0; k < light.size(); ++k) {
            if (!counts(k)) continue;
            on += light[k];
            all += image.light[k];
        }
        return on / all;
    }
};

struct Hypothesis {
    std::uint64_t out = 0;
    bool is_dim = false;
    double likelihood = 0.0;  // the logarithm
    double prior = 0.0;       // log odds against "all fired"
    double level = 0.0;
};

// The first is "all fired".
std::vector<Hypothesis> hypotheses_of(std::size_t strobes, bool has_level) {
    std::vector<Hypothesis> all(1);
    if (has_level) all.push_back({.is_dim = true});
    if (strobes > 1 && strobes <= kMostSubsets) {
        for (std::uint64_t out = 1; out + 1 < std::uint64_t{1} << strobes; ++out)
            all.push_back({.out = out});
    } else if (strobes > kMostSubsets) {
        for (std::size_t i = 0; i < strobes; ++i)
            for (std::size_t j = i; j < strobes; ++j)
                all.push_back({.out = std::uint64_t{1} << i | std::uint64_t{1} << j});
    }
    const double sets = static_cast<double>(all.size()) - (has_level ? 2.0 : 1.0);
    for (std::size_t h = 1; h < all.size(); ++h) {
        const Hypothesis& one = all[h];
        all[h].prior = std::log(0.5 * kRare / (one.is_dim ? 1.0 : sets)) -
                       std::log(10.0) * std::max(0, std::popcount(one.out) - 1);
    }
    return all;
}

bool has_level(const DropoutScales& scales) {
    return std::isfinite(scales.spread);
}

// With the likelihood of each.
std::vector<Hypothesis> weighed(const View& view, const DropoutScales& scales) {
    std::vector<Hypothesis> all = hypotheses_of(view.image.strobes.size(), has_level(scales));
    for (Hypothesis& one : all) {
        const CellPlane lit = view.light_without(one.out);
        const double quotient = view.quotient(lit);
        one.level = std::log(quotient) - scales.level;
        if (!(quotient > 0.0) || (one.is_dim && one.level >= 0.0)) {
            one.likelihood = -std::numeric_limits<double>::infinity();
            continue;
        }
        for_details(
            view.residual(lit, quotient), size_of(view.image.side), [&](auto size, double d) {
                const double off = d / scales.detail[size];
                one.likelihood -= 1.5 * std::log1p(off * off / 2.0) / kDetailDispersion;
            });
        if (!has_level(scales)) continue;
        const double off = one.level / scales.spread;
        one.likelihood += one.is_dim ? std::log(scales.spread / (kPeakOfT4 * -std::log(kUnlit)))
                                     : -2.5 * std::log1p(off * off / 4.0);
    }
    return all;
}

const Hypothesis& likeliest(const std::vector<Hypothesis>& all) {
    return *std::ranges::max_element(
        all, {}, [](const Hypothesis& one) { return one.likelihood + one.prior; });
}

// The median of images with any light, valid even if nine of ten images are dark.
double first_level(std::span<const LightCells> images) {
    std::vector<double> quotients;
    for (const LightCells& image : images) {
        const double quotient = View(image).quotient(image.light);
        if (quotient > 0.0) quotients.push_back(quotient);
    }
    std::ranges::sort(quotients);
    if (quotients.empty()) return kUnseen;
    const double bright = quotients[(quotients.size() - 1) * 9 / 10];
    std::erase_if(quotients, [&](double one) { return one < kUnlit * bright; });
    return std::log(upper_median(quotients));
}

}  // namespace

int cells_across(int width_px, int height_px) {
    constexpr int kLeast_px = 4;  // of a cell: two of each mosaic site along either side
    int side = kCells;
    while (side > 1 && side * kLeast_px > std::min(width_px, height_px)) side /= 2;
    return side;
}

CellPlane cells_of(const SurveyImage& taken, int side) {
    constexpr int kGreen = 1;
    const RawImage& raw = taken.raw;
    CellMeans cells(side, raw.width_px, raw.height_px);
    const std::size_t width = size_of(raw.width_px);
    const std::size_t step = is_bayer(raw.mosaic) ? 2 : 1;
    const float* samples =
        raw.samples.data() + (raw.mosaic == Mosaic::None ? raw.pixels() : std::size_t{0});
    for (int row = 0; row < raw.height_px; ++row, samples += width) {
        cells.begin_row(size_of(row));
        const std::size_t first =
            is_bayer(raw.mosaic) && channel_at(raw.mosaic, 0, row) != kGreen ? 1 : 0;
        for (std::size_t column = first; column < width; column += step) {
            const float sample = samples[column];
            cells.add(column, sample, !(sample < taken.levels.white));
        }
    }
    CellPlane means = cells.means();
    for (double& mean : means) mean = (mean - double{taken.levels.black}) / taken.exposure;
    return means;
}

CellPlane cells_of(const Lightmap& map, int side) {
    // Pixels of coarse maps are split, since a cell's border may pass through them.
    constexpr int kFine_px = 256;
    const int split = std::max(1, kFine_px / std::max(map.width_px, map.height_px));
    CellMeans cells(side, split * map.width_px, split * map.height_px);
    const std::size_t fine_width = size_of(split * map.width_px);
    const std::size_t plane = map.samples.size() / kChannels;
    for (std::size_t row = 0; row < size_of(split * map.height_px); ++row) {
        cells.begin_row(row);
        for (std::size_t column = 0; column < fine_width; ++column) {
            const std::size_t i =
                plane + row / size_of(split) * size_of(map.width_px) + column / size_of(split);
            const double veil = map.veil.empty() ? 0.0 : double{map.veil[i]};
            const double signal = double{map.samples[i]} + veil;
            if (signal > 0.0) cells.add(column, signal, false);
        }
    }
    CellPlane means = cells.means();
    for (double& mean : means) mean = std::isfinite(mean) ? mean : 0.0;
    return means;
}

CellPlane residual_of(const LightCells& image) {
    const View view(image);
    return view.residual(image.light, view.quotient(image.light));
}

DropoutScales learned(std::span<const LightCells> images, bool level_is_free) {
    constexpr int kRounds = 4;
    DropoutScales scales{.level = first_level(images), .spread = kFloorSpread};
    if (!std::isfinite(scales.level)) return {};
    const bool are_few = images.size() < kEnoughToLearn;
    if (are_few && !images.front().has_map) return {};
    if (level_is_free) scales.spread = kUnseen;
    scales.detail.assign(std::bit_width(unsigned{kCells}) - 1, kFewDetail);
    for (int round = 0; round < kRounds; ++round) {
        std::vector<double> levels;
        std::vector<std::vector<double>> details(scales.detail.size());
        for (const LightCells& image : images) {
            const View view(image);
            if (!(view.brightness() >= kUnlit * std::exp(scales.level))) continue;
            const std::vector<Hypothesis> all = weighed(view, scales);
            const Hypothesis& best = likeliest(all);
            if (!std::isfinite(best.likelihood)) continue;
            if (!best.is_dim) levels.push_back(best.level);
            const CellPlane lit = view.light_without(best.out);
            for_details(view.residual(lit, view.quotient(lit)),
                        size_of(image.side),
                        [&](std::size_t size, double d) { details[size].push_back(std::abs(d)); });
        }
        if (levels.empty()) return {};
        scales.images = levels.size();
        const double middle = upper_median(levels);
        for (double& level : levels) level = std::abs(level - middle);
        scales.level += middle;
        if (!level_is_free)
            scales.spread =
                std::max(are_few ? kFloorSpread : kLeastScale, upper_median(levels) / kMedianOfT4);
        for (std::size_t size = 0; size < details.size(); ++size) {
            if (details[size].empty()) continue;
            scales.detail[size] = std::max(are_few ? kFewDetail : kLeastScale,
                                           upper_median(details[size]) / kMedianOfT2);
        }
    }
    return scales;
}

std::string words_of(const MarkedImage& marked) {
    std::string of_light = fmt::format("lit by {:.2g} of the survey's light", marked.share);
    if (marked.strobes.empty()) return of_light;
    return fmt::format("strobe{} {} did not fire: {}",
                       marked.strobes.size() > 1 ? "s" : "",
                       fmt::join(marked.strobes, ", "),
                       of_light);
}

nlohmann::ordered_json to_json(const std::vector<MarkedImage>& marked) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const MarkedImage& one : marked)
        json.push_back({{"image", one.image}, {"share", one.share}, {"strobes", one.strobes}});
    return json;
}

Dropout judged(const LightCells& image, const DropoutScales& scales) {
    if (scales.images == 0) return {};
    const View view(image);
    const double brightness = view.brightness() / std::exp(scales.level);
    if (!std::isfinite(brightness)) return {};
    if (brightness < kUnlit) return {.is_dark = true, .share = std::max(brightness, 0.0)};
    const std::vector<Hypothesis> all = weighed(view, scales);
    const Hypothesis& best = likeliest(all);
    Dropout found{.out = best.out,
                  .log_ratio = best.likelihood - all.front().likelihood,
                  .level = best.level};
    if (best.is_dim) found.share = std::exp(best.level);
    if (best.out != 0) found.share = view.share_without(best.out);
    return found;
}

}  // namespace aphotic
