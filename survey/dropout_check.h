// SPDX-License-Identifier: BSD-3-Clause
//
// Whether the strobes fired (dropouts.h) in a survey's images: from the light of each strobe if the
// rig is known, otherwise from the one map, otherwise from the image level.
#pragma once

#include "survey/dropouts.h"
#include "survey/survey.h"
#include "survey/survey_check.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace aphotic {

[[nodiscard]] LightCells light_cells(const SurveyImage& taken,
                                     const Survey& survey,
                                     const ImageFile& file);

// If most images seem to lack strobes, the rig is wrong and no image is judged: the scales are then
// empty, and this is the message.
[[nodiscard]] std::optional<Suspicion> doubt_of_rig(std::span<const LightCells> images,
                                                    const Survey& survey,
                                                    DropoutScales& scales);

// Records in the image its share of the survey's light, and divides its exposure by that share if
// correction is requested; with one exposure per image, it also corrects the level. An InputError
// for an image without light.
void judge(SurveyImage& taken,
           const Survey& survey,
           const ImageFile& file,
           const DropoutScales& scales);
[[nodiscard]] std::string why_dark(const Dropout& found);

// For a strobe that did not fire, or for all of them at reduced power.
[[nodiscard]] MarkedImage marked(const std::string& image,
                                 const std::vector<std::string>& strobes,
                                 double share,
                                 std::uint64_t out);

}  // namespace aphotic
