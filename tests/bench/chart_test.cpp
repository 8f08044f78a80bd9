// SPDX-License-Identifier: BSD-3-Clause
#include "bench/survey/chart.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace aphotic::survey::chart_test {
namespace {

constexpr int kWidth_px = 40;
constexpr int kHeight_px = 20;
constexpr std::size_t kPixels = 800;

CameraImage made_of(const std::function<float(std::size_t channel, int column, int row)>& signal) {
    CameraImage image{.width_px = kWidth_px, .height_px = kHeight_px, .samples = {}};
    for (std::size_t c = 0; c < kChannels; ++c) {
        for (int row = 0; row < kHeight_px; ++row) {
            for (int column = 0; column < kWidth_px; ++column)
                image.samples.push_back(signal(c, column, row));
        }
    }
    return image;
}

// Light that falls off evenly, and half of it from column 30 on, where a cone ends.
float card_signal(std::size_t channel, int column, int /*row*/) {
    const float light = (1.0F + 0.01F * static_cast<float>(column)) * (column < 30 ? 1.0F : 0.5F);
    return light / static_cast<float>(1 + channel);
}

// Light tiles left of column 10, dark ones right of column 20, and something between that is as
// bright as a dark tile in two of the channels.
float truth_signal(std::size_t channel, int column, int row) {
    const float card = card_signal(channel, column, row);
    if (column < 10) return 2.5F * card;
    return column < 20 && channel == 2 ? 1.1F * card : card;
}

TEST(Chart, IsFoundWhereItLiesInFullLight) {
    const std::vector<Tile> chart = find_chart(made_of(truth_signal), made_of(card_signal));
    ASSERT_EQ(chart.size(), kPixels);
    for (int row = 0; row < kHeight_px; ++row) {
        for (int column = 0; column < kWidth_px; ++column) {
            // A pixel from each rim, and two from the pixels 29 and 30 of the step.
            Tile expected = Tile::None;
            if (column < 9) expected = Tile::Light;
            if (column > 20 && (column < 27 || column > 32)) expected = Tile::Dark;
            EXPECT_EQ(chart[static_cast<std::size_t>(row * kWidth_px + column)], expected)
                << column << ", " << row;
        }
    }
}

TEST(Chart, InShadeIsNotFound) {
    const CameraImage shade =
        made_of([](std::size_t c, int x, int y) { return 0.8F * truth_signal(c, x, y); });
    for (const Tile tile : find_chart(shade, made_of(card_signal))) EXPECT_EQ(tile, Tile::None);
}

// Light tiles above, dark ones below; nothing in the last column.
std::vector<Tile> two_halves() {
    std::vector<Tile> tiles(kPixels, Tile::Light);
    for (std::size_t i = kPixels / 2; i < kPixels; ++i) tiles[i] = Tile::Dark;
    for (std::size_t i = kWidth_px - 1; i < kPixels; i += kWidth_px) tiles[i] = Tile::None;
    return tiles;
}

constexpr double kFloatError = 1e-6;  // of 32-bit samples

TEST(Chart, ThatIsFlatScoresNothing) {
    const CameraImage flat = made_of([](std::size_t c, int column, int row) {
        if (column == kWidth_px - 1) return 77.0F;
        return (row < kHeight_px / 2 ? 2.5F : 1.0F) * static_cast<float>(1 + c);
    });
    const ChartScore score = score_chart(flat, two_halves());
    EXPECT_EQ(score.pixels, kPixels - kHeight_px);
    for (std::size_t c = 0; c < kChannels; ++c) {
        EXPECT_NEAR(score.unevenness[c], 0.0, kFloatError);
        EXPECT_NEAR(score.tone[c], 1.0, kFloatError);
        EXPECT_NEAR(score.light[c], 2.5 * static_cast<double>(1 + c), kFloatError);
    }
}

TEST(Chart, IsAsUnevenAsItsPixelsDeviate) {
    // Red by 2 % to either side in both kinds of tile, and without contrast; the others flat.
    const CameraImage image = made_of([](std::size_t c, int column, int row) {
        if (c == 0) return row % 2 == 0 ? 1.02F : 0.98F;
        return column == kWidth_px - 1 ? 5.0F : 1.0F;
    });
    const ChartScore score = score_chart(image, two_halves());
    EXPECT_NEAR(score.unevenness[0], 0.02, kFloatError);
    EXPECT_NEAR(score.unevenness[1], 0.0, kFloatError);
    EXPECT_NEAR(score.tone[0], 2.5, kFloatError);
}

TEST(Chart, SumsUpASurvey) {
    const ChartScore one{.unevenness = {0.01, 0.02, 0.02}, .tone = {1, 1, 1}, .light = {1, 1, 1}};
    const ChartScore two{
        .unevenness = {0.0, 0.0, 0.0}, .tone = {0.5, 0.5, 0.5}, .light = {3, 2, 2}};
    const SurveyScore sum = summed_up(std::vector{one, two});
    EXPECT_EQ(sum.images, 2U);
    EXPECT_NEAR(sum.unevenness, std::sqrt(9e-4 / 6.0), kFloatError);
    EXPECT_NEAR(sum.worst_unevenness, 0.02, kFloatError);
    EXPECT_NEAR(sum.tone, 0.75, kFloatError);
    EXPECT_NEAR(sum.colour_spread, 0.25 / 1.25, kFloatError) << "R/G of 1 and 1.5";
    EXPECT_NEAR(sum.level_spread, 0.5 / 1.5, kFloatError) << "G of 1 and 2";
    // The cosine between 3, 2, 2 and 1, 1, 1 is 7 / sqrt(17 * 3).
    const double off_deg = std::acos(7.0 / std::sqrt(51.0)) * 180.0 / std::numbers::pi;
    EXPECT_NEAR(sum.degrees, off_deg / 2.0, 1e-9) << "and the other none";
}

}  // namespace
}  // namespace aphotic::survey::chart_test
