// SPDX-License-Identifier: BSD-3-Clause
//
// The data of a fit: the signal in an even grid of blocks of every image or map, in each channel
// the mean of the block's samples less the black level, at the reference exposure.
//
// A block is omitted (NaN) in a channel if more than kMostSaturated of its samples are saturated,
// since their mean would be too dark, or if more than half were not observed; and in a survey with
// depth maps if block_planes.h finds no plane. An image with planes at less than half of its blocks
// is skipped. If such a survey has no pose for it, its altitude is the median depth of its blocks
// along the axis, and it is level.
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
    Mosaic mosaic = Mosaic::None;          // of the files, if the survey specifies it
    std::vector<Skipped> skipped{};        // including those without light
    std::vector<MarkedImage> marked{};     // omitted: not lit by all strobes
    std::vector<Suspicion> looks_wrong{};  // of images; already reported to the watch
};

// Blocks of a width that gives about this number across.
[[nodiscard]] FitPlaces fit_places(int width_px, int height_px, int blocks_across);

// The survey has a navigation or depth maps. Images are read `jobs` at a time; only their blocks
// are kept. Which strobes lit them is judged as the survey specifies (dropouts.h), and dropouts are
// omitted. Doubts of survey_check.h are reported to the watch first. An InputError if no image
// can be used.
[[nodiscard]] FitSamples samples_of_images(const Survey& survey,
                                           const Rig& rig,
                                           int blocks_across,
                                           std::size_t jobs,
                                           const RunWatch& watch);

// Maps from `aphotic observe`, or from any program that writes R, G, B and the attributes
// aphotic:altitude_m, aphotic:pitch_deg, aphotic:roll_deg. An InputError for any that cannot be
// used: they are few, and each was named by the user.
[[nodiscard]] FitSamples samples_of_maps(const std::vector<std::string>& maps,
                                         const Camera& camera,
                                         int blocks_across);

}  // namespace aphotic
