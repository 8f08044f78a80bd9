// SPDX-License-Identifier: BSD-3-Clause
//
// The quality of a corrected image of a simulated survey, measured on the grey chart in it.
//
// The chart's pixels are found from POV-Ray's images alone, one of which shows the same floor as a
// bare grey card: if truth over card is 1 in all three channels, a pixel is a dark tile, if it is
// 2.5, a light one, in full light. Shaded tiles and everything else have another ratio. A pixel
// counts if its eight neighbours are of the same tile, and if no cone of light ends within
// kEdgeReach_px of it: pixels on edges mix two levels of light.
//
// Of a corrected image C, with M_t the mean of C over the pixels of the tiles of kind t,
//
//   unevenness   rms over all of the chart's pixels of C / M_t - 1      0: perfectly flat
//   tone         2.5 M_dark / M_light                                   1: contrast is kept
//   colour       M_light of R over that of G, and of B over that of G
//
// Tone distinguishes a correction that removes all contrast from one that removes the light's
// pattern.
#pragma once

#include "image/camera_image.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace aphotic::survey {

inline constexpr double kLightOverDark = 2.5;  // of the tiles, as in scenes/survey/survey.pov
inline constexpr int kEdgeReach_px = 2;

enum class Tile : std::uint8_t { None, Dark, Light };

// truth and card: the camera's signals of one pose, by POV-Ray.
[[nodiscard]] std::vector<Tile> find_chart(const CameraImage& truth, const CameraImage& card);

struct ChartScore {
    std::array<double, kChannels> unevenness{};
    std::array<double, kChannels> tone{};
    std::array<double, kChannels> light{};  // M_light
    std::size_t pixels = 0;
};

[[nodiscard]] ChartScore score_chart(const CameraImage& corrected, std::span<const Tile> tiles);

// Over all images of a survey with a chart: the rms of the unevenness over images and channels, the
// mean tone, and the variation of colour and brightness from image to image, as the standard
// deviation over the mean (for colour the larger of R/G and B/G).
struct SurveyScore {
    double unevenness = 0.0;
    double worst_unevenness = 0.0;  // of an image and channel
    double tone = 0.0;
    double colour_spread = 0.0;
    double level_spread = 0.0;
    double degrees = 0.0;  // mean over images: the light tiles' angle from grey
    std::size_t images = 0;
};

[[nodiscard]] SurveyScore summed_up(std::span<const ChartScore> scores);

}  // namespace aphotic::survey
