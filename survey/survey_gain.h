// SPDX-License-Identifier: BSD-3-Clause
//
// The gain of a survey: one number a channel, with which its middle comes out as asked
// (survey/correction.h).
#pragma once

#include "survey/correction.h"
#include "survey/survey_look.h"

#include <string>
#include <vector>

namespace aphotic {

struct SurveyGain {
    PerChannel gain{};
    PerChannel middle{};
    std::vector<std::string> images;  // that it was taken from; none when it was given
};

// The median of the middle quotients of the images that were looked at. An InputError when there is
// none.
[[nodiscard]] SurveyGain measured_gain(const SurveyLook& look, const PerChannel& middle);

}  // namespace aphotic
