// SPDX-License-Identifier: BSD-3-Clause
//
// A survey's images, each divided by the map of its own light (correction.h) and written. What is
// left in the folder of results beside the images:
//
//   correction.json   settings, gain, counts, which images were skipped and why: the report below
//   report.html       when asked for: a page to look at (correction_page.h)
//   corrected.jsonl   what is done (journal.h)
#pragma once

#include "base/share.h"
#include "survey/gain.h"
#include "survey/image_run.h"
#include "survey/survey.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace aphotic {

struct CorrectionOptions {
    ImageRunOptions run{};       // of a share: its own folder
    WorkShare share{};           // of the images that are corrected; gain and warnings are of all
    std::vector<double> gain{};  // one for all channels, or three; none: taken from the survey
    std::filesystem::path gain_from{};  // a folder of results that has one; empty: none
    std::optional<double> middle{};     // none: the floor's colour, grey where nobody knows it
    std::size_t gain_images = 16;
    NoiseLimit limit{};
    std::optional<double> read_noise{};  // none: what the file's numbers are rounded by
    bool keep_mosaic = false;
    int edge_px = 2;
    bool report = false;  // also write report.html, a page to look at (correction_page.h)
};

struct CorrectionReport {
    nlohmann::ordered_json settings;
    std::string settings_sha256;
    SurveyGain gain;
    std::optional<SrgbEncoding> srgb{};  // none: linear alone
    std::vector<ImageLook> looks{};      // at images before the first was corrected
    std::vector<Suspicion> looks_wrong;
    std::string not_checked;        // and why; or empty
    std::optional<RunOutcome> run;  // none: it has not ended
    double seconds = 0.0;
};
[[nodiscard]] nlohmann::ordered_json to_json(const CorrectionReport& report);

// How such images are shown, whether or not they are also written so.
[[nodiscard]] SrgbEncoding shown_as(const Survey& survey,
                                    const CorrectionOptions& options,
                                    const SurveyGain& gain);

// Each of the jobs' threads holds one image, its map and its result. Images that are corrected
// already stay as they are; the same images give the same files, bit for bit.
CorrectionReport correct_survey(const Survey& survey,
                                const CorrectionOptions& options,
                                const RunWatch& watch);

}  // namespace aphotic
