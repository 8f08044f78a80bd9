// SPDX-License-Identifier: BSD-3-Clause
//
// A first look at some images of a survey, evenly spread over it: the source of the gain
// (corrector.h), and of warnings (survey_check.h). The check needs kEnoughImages, however many the
// gain uses.
#pragma once

#include "survey/fixed_pattern.h"
#include "survey/run_watch.h"
#include "survey/survey.h"
#include "survey/survey_check.h"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

// The share of a survey's images, and the most, that are searched for a fixed pattern, if these are
// more than are examined anyway.
inline constexpr double kPatternShare = 0.05;
inline constexpr std::size_t kMostPatternImages = 200;

struct LookRequest {
    std::size_t most_images = 16;
    std::size_t gain_images = 0;  // for the gain, whether or not they are among these
    double least_light = 0.0;     // of the map's brightest: darker pixels are ignored
    std::size_t jobs = 1;
};

struct SurveyLook {
    std::vector<ImageLook> images{};   // usable ones
    std::size_t count = 0;             // of images examined
    DropoutScales scales{};            // by which images that lack light were omitted
    std::optional<Suspicion> doubt{};  // about the rig, from its strobes' apparent behaviour
    FixedPattern pattern{};            // of kEnoughImages or more with a map
    std::string first_why{};           // the first unusable image, and why; or empty

    // A message if none is usable: what cannot be done to them, such as "read", and why.
    [[nodiscard]] std::string none_can_be(std::string_view done) const;
};

[[nodiscard]] SurveyLook look_at(const Survey& survey,
                                 const LookRequest& request,
                                 const RunWatch& watch);

// Warnings from the reader of the navigation.
[[nodiscard]] std::vector<Suspicion> suspicions_of(const std::optional<Navigation>& navigation);

// What looks wrong about the navigation and about images of unknown light, also reported to the
// watch. An InputError for the whole survey if none of the images examined can be read.
[[nodiscard]] std::vector<Suspicion> suspicions_of(const std::vector<ImageFile>& files,
                                                   const CameraNumbers& camera,
                                                   const std::optional<Navigation>& navigation,
                                                   std::size_t jobs,
                                                   const RunWatch& watch,
                                                   DropoutScales* scales = nullptr);

}  // namespace aphotic
