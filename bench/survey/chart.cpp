// SPDX-License-Identifier: BSD-3-Clause
#include "bench/survey/chart.h"

#include "spectral/colour_difference.h"

#include <algorithm>
#include <cmath>

namespace aphotic::survey {

namespace {

// The half floats of two frames differ by up to 1e-3, and a tile lies 0.2 mm nearer than the card,
// 3e-4 of the light; no material of the scenes is grey to this.
constexpr double kSameLight = 3e-3;

// Light over a floor varies over many pixels; at the end of a cone, it steps from one to the next
// by at least a few percent.
constexpr double kStep = 0.01;

struct Grid {
    int width_px = 0;
    int height_px = 0;

    [[nodiscard]] std::size_t pixels() const { return at(0, height_px); }
    [[nodiscard]] std::size_t at(int column, int row) const {
        return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_px) +
               static_cast<std::size_t>(column);
    }
    // Whether any pixel within reach, the image's own only, is so.
    template <typename Is>
    [[nodiscard]] bool any_near(int column, int row, int reach, const Is& is) const {
        for (int y = std::max(0, row - reach); y <= std::min(height_px - 1, row + reach); ++y) {
            for (int x = std::max(0, column - reach); x <= std::min(width_px - 1, column + reach);
                 ++x) {
                if (is(at(x, y))) return true;
            }
        }
        return false;
    }
};

bool near(double a, double b) {
    return std::abs(a / b - 1.0) < kSameLight;
}

Tile tile_of(const CameraImage& truth,
             const CameraImage& card,
             std::size_t pixel,
             std::size_t pixels) {
    std::array<double, kChannels> ratio{};
    for (std::size_t c = 0; c < kChannels; ++c) {
        ratio[c] = truth.samples[c * pixels + pixel] / card.samples[c * pixels + pixel];
    }
    const auto all = [&](double value) {
        return std::all_of(ratio.begin(), ratio.end(), [&](double r) { return near(r, value); });
    };
    if (all(1.0)) return Tile::Dark;
    return all(kLightOverDark) ? Tile::Light : Tile::None;
}

// The pixels where the card's green is more curved than smooth light, along a row or a column.
std::vector<bool> steps_of(const CameraImage& card, const Grid& grid) {
    std::vector<bool> is_step(grid.pixels(), false);
    const float* green = &card.samples[grid.pixels()];
    const auto bends = [&](std::size_t before, std::size_t here, std::size_t after) {
        return std::abs(green[before] - 2.0F * green[here] + green[after]) > kStep * green[here];
    };
    for (int row = 1; row + 1 < grid.height_px; ++row) {
        for (int column = 1; column + 1 < grid.width_px; ++column) {
            const std::size_t here = grid.at(column, row);
            is_step[here] = bends(here - 1, here, here + 1) ||
                            bends(grid.at(column, row - 1), here, grid.at(column, row + 1));
        }
    }
    return is_step;
}

double mean_of(std::span<const double> values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

// Standard deviation over the mean.
double spread_of(std::span<const double> values) {
    const double mean = mean_of(values);
    double squares = 0.0;
    for (const double value : values) squares += (value / mean - 1.0) * (value / mean - 1.0);
    return std::sqrt(squares / static_cast<double>(values.size()));
}

}  // namespace

std::vector<Tile> find_chart(const CameraImage& truth, const CameraImage& card) {
    const Grid grid{.width_px = truth.width_px, .height_px = truth.height_px};
    std::vector<Tile> tiles(grid.pixels());
    for (std::size_t i = 0; i < tiles.size(); ++i) tiles[i] = tile_of(truth, card, i, tiles.size());
    const std::vector<bool> steps = steps_of(card, grid);

    std::vector<Tile> chart(grid.pixels(), Tile::None);
    for (int row = 0; row < grid.height_px; ++row) {
        for (int column = 0; column < grid.width_px; ++column) {
            const Tile tile = tiles[grid.at(column, row)];
            const bool at_rim =
                grid.any_near(column, row, 1, [&](std::size_t i) { return tiles[i] != tile; });
            const bool at_edge =
                grid.any_near(column, row, kEdgeReach_px, [&](std::size_t i) { return steps[i]; });
            if (!at_rim && !at_edge) chart[grid.at(column, row)] = tile;
        }
    }
    return chart;
}

ChartScore score_chart(const CameraImage& corrected, std::span<const Tile> tiles) {
    ChartScore score;
    for (std::size_t c = 0; c < kChannels; ++c) {
        const float* plane = &corrected.samples[c * tiles.size()];
        std::array<double, 3> sum{};
        std::array<double, 3> squares{};
        std::array<double, 3> count{};
        for (std::size_t i = 0; i < tiles.size(); ++i) {
            const auto kind = static_cast<std::size_t>(tiles[i]);
            sum[kind] += plane[i];
            squares[kind] += static_cast<double>(plane[i]) * plane[i];
            count[kind] += 1.0;
        }
        double deviations = 0.0;
        double pixels = 0.0;
        std::array<double, 3> mean{};
        for (const Tile tile : {Tile::Dark, Tile::Light}) {
            const auto kind = static_cast<std::size_t>(tile);
            if (count[kind] == 0.0) continue;
            mean[kind] = sum[kind] / count[kind];
            deviations += std::max(0.0, squares[kind] / (mean[kind] * mean[kind]) - count[kind]);
            pixels += count[kind];
        }
        const double dark = mean[static_cast<std::size_t>(Tile::Dark)];
        const double light = mean[static_cast<std::size_t>(Tile::Light)];
        score.unevenness[c] = std::sqrt(deviations / pixels);
        score.tone[c] = kLightOverDark * dark / light;
        score.light[c] = light;
        score.pixels = static_cast<std::size_t>(pixels);
    }
    return score;
}

SurveyScore summed_up(std::span<const ChartScore> scores) {
    SurveyScore total{.images = scores.size()};
    std::vector<double> squares;
    std::vector<double> tones;
    std::vector<double> red;
    std::vector<double> blue;
    std::vector<double> level;
    std::vector<double> degrees;
    for (const ChartScore& score : scores) {
        for (std::size_t c = 0; c < kChannels; ++c) {
            squares.push_back(score.unevenness[c] * score.unevenness[c]);
            tones.push_back(score.tone[c]);
            total.worst_unevenness = std::max(total.worst_unevenness, score.unevenness[c]);
        }
        red.push_back(score.light[0] / score.light[1]);
        blue.push_back(score.light[2] / score.light[1]);
        level.push_back(score.light[1]);
        degrees.push_back(degrees_from_grey(score.light));
    }
    total.unevenness = std::sqrt(mean_of(squares));
    total.tone = mean_of(tones);
    total.colour_spread = std::max(spread_of(red), spread_of(blue));
    total.level_spread = spread_of(level);
    total.degrees = mean_of(degrees);
    return total;
}

}  // namespace aphotic::survey
