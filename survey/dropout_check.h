// SPDX-License-Identifier: BSD-3-Clause
//
// Whether the strobes fired (dropouts.h), of the images of a survey: in the light of its rig where
// that is known, strobe by strobe, else of its one map, else by their level alone.
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

// Where most images seem to lack strobes, it is the rig that is another, and none is judged: the
// scales are of no image then, and this is what to say.
[[nodiscard]] std::optional<Suspicion> doubt_of_rig(std::span<const LightCells> images,
                                                    const Survey& survey,
                                                    DropoutScales& scales);

// Notes in the image what it has of the survey's light, and divides its exposure by that where the
// light that was on is wanted; where images have an exposure each, its level by which. An
// InputError of an image without light.
void judge(SurveyImage& taken,
           const Survey& survey,
           const ImageFile& file,
           const DropoutScales& scales);
[[nodiscard]] std::string why_dark(const Dropout& found);

// Of a strobe that did not fire, or of all at less than their power.
[[nodiscard]] MarkedImage marked(const std::string& image,
                                 const std::vector<std::string>& strobes,
                                 double share,
                                 std::uint64_t out);

}  // namespace aphotic
