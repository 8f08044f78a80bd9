// SPDX-License-Identifier: BSD-3-Clause
//
// A raw survey corrected by maps that no rig made, with its page. One image is called as markup is,
// and cannot be read.
#pragma once

#include "base/atomic_file.h"
#include "support/raw_survey.h"
#include "survey/correct/correction_run.h"

#include <string>

namespace aphotic {

struct CorrectedSurvey {
    CorrectedSurvey() {
        write_file(raw.path("raw/<b>x.exr"), "no image");
        Survey survey = raw.survey();
        survey.light.title = "Sled of <script>document.title = 'owned'</script>";
        survey.light.toml = "title = \"<i>\"\n";
        survey.light.digest = "by hand";
        survey.light.size = {RawSurvey::kWidth_px, RawSurvey::kHeight_px};
        survey.light.map = [](const Sled& sled) {
            Lightmap map{.width_px = RawSurvey::kWidth_px,
                         .height_px = RawSurvey::kHeight_px,
                         .samples = RawSurvey::light()};
            for (float& sample : map.samples) sample /= static_cast<float>(sled.altitude_m);
            return map;
        };
        survey.light.edges = [](const Sled&, int) {
            return std::vector<std::uint8_t>(RawSurvey::kPixels_of_plane, 0);
        };
        CorrectionOptions options;
        options.run.folder = raw.path("out");
        options.run.jobs = 1;
        options.report = true;
        report = correct_survey(survey, options, {});
        page = read_text_file(raw.path("out/report.html"));
    }

    RawSurvey raw;
    CorrectionReport report;
    std::string page;
};

}  // namespace aphotic
