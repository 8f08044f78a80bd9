// SPDX-License-Identifier: BSD-3-Clause
//
// The gain of a survey: one number a channel, with which its middle comes out as asked
// (correction.h). A folder keeps its gain while its settings stay, so that images that come later
// fit the others.
#pragma once

#include "survey/correction.h"
#include "survey/first_look.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

struct SurveyGain {
    PerChannel gain{};
    PerChannel middle{};
    std::vector<std::string> images{};  // that it was taken from; none when it was given
    std::string folder{};               // whose gain it is; empty: this survey's own
};

// The median of the middle quotients of the images that were looked at. An InputError when there is
// none.
[[nodiscard]] SurveyGain measured_gain(const SurveyLook& look, const PerChannel& middle);

// The gain that the text of a folder's correction.json tells of. None when the text is of other
// settings, or not as correct_survey() wrote it: a gain that is no finite number above 0 among it.
// Nor of a survey that looked wrong: it may be mended since.
[[nodiscard]] std::optional<SurveyGain> kept_gain(std::string_view text,
                                                  const nlohmann::ordered_json& settings);

// The gain and the middle of another survey, from the correction.json in its folder of results, for
// a survey in this light: dives that share one gain can be compared. An InputError when there is
// none, or when it is of another camera. What else differs is added to the doubts.
[[nodiscard]] SurveyGain gain_of_folder(const std::filesystem::path& folder,
                                        const LightAt& light,
                                        const CameraNumbers& camera,
                                        std::vector<Suspicion>& doubts);
// The same from the text of that file.
[[nodiscard]] SurveyGain gain_of_notes(std::string_view text,
                                       const std::string& folder,
                                       const LightAt& light,
                                       const CameraNumbers& camera,
                                       std::vector<Suspicion>& doubts);

// What scales the camera's channels so that the median of some of the survey's images, in its files
// evenly spread, is grey; 1 where none has light in every channel.
[[nodiscard]] PerChannel grey_balance(const Survey& survey, double grey, std::size_t jobs);

// The balance that the text of a folder's baseline.json tells of. None when the text is of other
// settings, or no numbers over 0.
[[nodiscard]] std::optional<PerChannel> kept_balance(std::string_view text,
                                                     const nlohmann::ordered_json& settings);

}  // namespace aphotic
