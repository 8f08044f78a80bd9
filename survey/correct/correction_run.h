// SPDX-License-Identifier: BSD-3-Clause
//
// Corrects (corrector.h) and writes a survey's images. Besides the images, the folder of results
// gets:
//
//   correction.json   settings, gain, counts, which images were skipped and why: the report below;
//                     of a baseline, baseline.json
//   report.html       when asked for: a page to look at (correction_page.h)
//   corrected.jsonl   what is done (work_folder.h)
#pragma once

#include "survey/correct/corrector.h"

namespace aphotic {

[[nodiscard]] nlohmann::ordered_json to_json(const CorrectionReport& report);

// Each of the jobs' threads holds one image, its map and its result. Images that are corrected
// already are left as they are; the same images give the same files, bit for bit. A baseline does
// not use the survey's light.
CorrectionReport correct_survey(const Survey& survey,
                                const CorrectionOptions& options,
                                const RunWatch& watch);

}  // namespace aphotic
