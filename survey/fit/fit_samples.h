// SPDX-License-Identifier: BSD-3-Clause
//
// What a fit is made to: the signal of an even grid of blocks of every image or map, in each
// channel the mean of the block's samples less the black level, at the reference exposure.
//
// A block is left out (NaN) in a channel where more than kMostSaturated of its samples are
// saturated, for their mean would be too dark, or more than half were not observed; and of a survey
// with depth maps where block_planes.h finds no plane. An image that has a plane at less than half
// of its blocks is skipped. Where such a survey has no pose of it, its altitude is the middle one
// of its blocks' depths along the axis, level.
#pragma once

#include "survey/fit/fit_light.h"
#include "survey/run_watch.h"
#include "survey/survey.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace aphotic {

inline constexpr int kBlocksAcross = 40;
inline constexpr double kMostSaturated = 0.01;

struct FitSamples {
    FitPlaces places{};
    std::vector<FitImage> images{};
    bool are_maps = false;
    Mosaic mosaic = Mosaic::None;          // of the files, as far as the survey says
    std::vector<Skipped> skipped{};        // those without light among them
    std::vector<MarkedImage> marked{};     // those that not all strobes lit, left out
    std::vector<Suspicion> looks_wrong{};  // of images; the watch was told
};

// Blocks of a width that gives about so many across.
[[nodiscard]] FitPlaces fit_places(int width_px, int height_px, int blocks_across);

// The survey has a navigation or depth maps. Images are read `jobs` at a time and kept as their
// blocks alone. Which strobes lit them is judged by the survey's (dropouts.h): others are left out.
// What survey_check.h doubts is told to the watch before. An InputError when none can be used.
[[nodiscard]] FitSamples samples_of_images(const Survey& survey,
                                           const Rig& rig,
                                           int blocks_across,
                                           std::size_t jobs,
                                           const RunWatch& watch);

// Maps by `aphotic observe`, or by any program that writes R, G, B and the attributes
// aphotic:altitude_m, aphotic:pitch_deg, aphotic:roll_deg. An InputError for one that cannot be
// used: there are few, and each was named.
[[nodiscard]] FitSamples samples_of_maps(const std::vector<std::string>& maps,
                                         const Camera& camera,
                                         int blocks_across);

}  // namespace aphotic
