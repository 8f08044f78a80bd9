// SPDX-License-Identifier: BSD-3-Clause
//
// A first look at some images of a survey, spread evenly over it: what the gain is taken from
// (corrector.h), and what looks wrong (survey_check.h). How many the gain takes is no matter to the
// check, which needs kEnoughImages.
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
        0;                     // that the gain is taken from, whether or not they are among these
    double least_light = 0.0;  // of the map's brightest: darker pixels do not count
    std::size_t jobs = 1;
};

struct SurveyLook {
    std::vector<ImageLook> images{};   // those that can be used
    std::size_t count = 0;             // that were looked at
    DropoutScales scales{};            // of which images that lack light were told, and left out
    std::optional<Suspicion> doubt{};  // of the rig, for what its strobes seem to do
    std::string first_why{};           // why the first of the others cannot, and which; or empty

    // Where there are none: what cannot be done to them, "read", and why.
    [[nodiscard]] std::string none_can_be(std::string_view done) const;
};

[[nodiscard]] SurveyLook look_at(const Survey& survey,
                                 const LookRequest& request,
                                 const RunWatch& watch);

// What the reader of the navigation warns of.
[[nodiscard]] std::vector<Suspicion> suspicions_of(const std::optional<Navigation>& navigation);

// What looks wrong about the navigation and about images whose light nobody knows: says it to the
// watch, too. Refused, once for all, where none of them can be read.
[[nodiscard]] std::vector<Suspicion> suspicions_of(const std::vector<ImageFile>& files,
                                                   const CameraNumbers& camera,
                                                   const std::optional<Navigation>& navigation,
                                                   std::size_t jobs,
                                                   const RunWatch& watch,
                                                   DropoutScales* scales = nullptr);

}  // namespace aphotic
