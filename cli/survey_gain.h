// SPDX-License-Identifier: BSD-3-Clause
//
// The gain of a survey: one number a channel, with which its middle comes out as asked
// (lightmap/correction.h).
#pragma once

#include "cli/survey_files.h"
#include "cli/survey_image.h"
#include "cli/survey_light.h"
#include "lightmap/correction.h"

#include <cstddef>
#include <string>
#include <vector>

namespace aphotic::cli {

// What is corrected, the light that it was taken in, and by what camera.
struct Survey {
    std::vector<SurveyFile> files;
    SurveyLight light;
    CameraNumbers camera;
};

struct SurveyGain {
    PerChannel gain{};
    PerChannel middle{};
    std::vector<std::string> images;  // that it was taken from; none when it was given
};

struct GainRequest {
    PerChannel middle{};
    std::size_t most_images = 16;
    double least_light = 0.0;  // of the map's brightest: darker pixels do not count
    std::size_t jobs = 1;
};

// Of images spread evenly over the survey, the median of each one's own middle quotient. An
// InputError when there is none.
[[nodiscard]] SurveyGain measured_gain(const Survey& survey, const GainRequest& request);

}  // namespace aphotic::cli
