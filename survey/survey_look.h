// SPDX-License-Identifier: BSD-3-Clause
//
// A first look at some images of a survey, spread evenly over it: what the gain is taken from
// (survey_gain.h), and what looks wrong (survey/survey_check.h). How many the gain takes is no
// matter to the check, which needs kEnoughImages.
#pragma once

#include "survey/survey_check.h"
#include "survey/survey_files.h"
#include "survey/survey_image.h"
#include "survey/survey_light.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace aphotic {

// What is corrected, the light that it was taken in, and by what camera.
struct Survey {
    std::vector<SurveyFile> files;
    SurveyLight light;  // of a survey whose light nobody knows, as it is by default
    CameraNumbers camera;
};

struct LookRequest {
    std::size_t most_images = 16;
    std::size_t gain_images =
        0;                     // that the gain is taken from, whether or not they are among these
    double least_light = 0.0;  // of the map's brightest: darker pixels do not count
    std::size_t jobs = 1;
};

struct SeenImage {
    std::string name;
    ImageLook look;
    bool is_for_gain = false;
};

struct SurveyLook {
    std::vector<SeenImage> images;  // those that can be used
    std::size_t count = 0;          // that were looked at
    std::string first_why;          // why the first of the others cannot, and which; or empty

    [[nodiscard]] std::vector<ImageLook> looks() const;
};

[[nodiscard]] SurveyLook look_at(const Survey& survey, const LookRequest& request);

// What looks wrong about images whose light nobody knows.
[[nodiscard]] std::vector<Suspicion> suspicions_of(std::vector<SurveyFile> files,
                                                   const CameraNumbers& camera,
                                                   std::size_t jobs);

// --strict.
void add_strict_option(CLI::App& app, bool& strict);

// Says what looks wrong; when strict as an InputError.
void tell(const std::vector<Suspicion>& suspicions, bool strict);
[[nodiscard]] nlohmann::ordered_json suspicions_json(const std::vector<Suspicion>& suspicions);

}  // namespace aphotic
