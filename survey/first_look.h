// SPDX-License-Identifier: BSD-3-Clause
//
// A first look at some images of a survey, evenly spread over it: the source of the gain
// (corrector.h), and of warnings (survey_check.h). The check needs kEnoughImages, however many the
// gain uses.
#pragma once

#include "survey/run_watch.h"
#include "survey/survey.h"
#include "survey/survey_check.h"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

struct LookRequest {
    std::size_t most_images = 16;
    std::size_t gain_images =
        0;                     // that the gain is derived from, whether or not they are among these
    double least_light = 0.0;  // of the map's brightest: darker pixels do not count
    std::size_t jobs = 1;
};

struct SurveyLook {
    std::vector<ImageLook> images{};   // usable ones
    std::size_t count = 0;             // that were examined
    DropoutScales scales{};            // of which images that lack light were omitted
    std::optional<Suspicion> doubt{};  // of the rig, for what its strobes seem to do
    std::string first_why{};  // why the first of the others is unusable, and which; or empty

    // If there are none: what cannot be done to them, "read", and why.
    [[nodiscard]] std::string none_can_be(std::string_view done) const;
};

[[nodiscard]] SurveyLook look_at(const Survey& survey,
                                 const LookRequest& request,
                                 const RunWatch& watch);

// Warnings from the reader of the navigation.
[[nodiscard]] std::vector<Suspicion> suspicions_of(const std::optional<Navigation>& navigation);

// What looks wrong about the navigation and about images of unknown light, also told to the watch.
// An error for the whole survey if none of them can be read.
[[nodiscard]] std::vector<Suspicion> suspicions_of(const std::vector<ImageFile>& files,
                                                   const CameraNumbers& camera,
                                                   const std::optional<Navigation>& navigation,
                                                   std::size_t jobs,
                                                   const RunWatch& watch,
                                                   DropoutScales* scales = nullptr);

}  // namespace aphotic
