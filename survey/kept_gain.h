// SPDX-License-Identifier: BSD-3-Clause
//
// The gain that a folder's correction.json tells of: a folder keeps its gain while its settings
// stay, so that images that come later fit the others.
#pragma once

#include "survey/survey_gain.h"

#include <optional>
#include <string>
#include <string_view>

namespace aphotic {

// None when the text is of other settings, or not as `aphotic correct` wrote it: a gain that is no
// finite number above 0 among it. Nor of a survey that looked wrong: it may be mended since.
[[nodiscard]] std::optional<SurveyGain> kept_gain(std::string_view text,
                                                  const std::string& settings_sha256);

}  // namespace aphotic
