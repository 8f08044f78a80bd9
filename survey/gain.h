// SPDX-License-Identifier: BSD-3-Clause
//
// The gain of a survey: one number a channel, with which its middle comes out as asked
// (correction.h). A folder keeps its gain while its settings stay, so that images that come later
// fit the others.
#pragma once

#include "survey/correction.h"
#include "survey/first_look.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

struct SurveyGain {
    PerChannel gain{};
    PerChannel middle{};
    std::vector<std::string> images{};  // that it was taken from; none when it was given
};

// The median of the middle quotients of the images that were looked at. An InputError when there is
// none.
[[nodiscard]] SurveyGain measured_gain(const SurveyLook& look, const PerChannel& middle);

// The gain that the text of a folder's correction.json tells of. None when the text is of other
// settings, or not as correct_survey() wrote it: a gain that is no finite number above 0 among it.
// Nor of a survey that looked wrong: it may be mended since.
[[nodiscard]] std::optional<SurveyGain> kept_gain(std::string_view text,
                                                  const std::string& settings_sha256);

}  // namespace aphotic
