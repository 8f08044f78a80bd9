// SPDX-License-Identifier: BSD-3-Clause
//
// Corrects (corrector.h) and writes a survey's images. Besides the images, the folder of results
// receives:
//
//   correction.json   settings, gain, counts, skipped images and why: the report below; for a
//                     baseline, baseline.json
//   report.html       on request, a page to view (correction_page.h)
//   corrected.jsonl   the images finished so far (work_folder.h)
#pragma once

#include "survey/correct/corrector.h"

namespace aphotic {

[[nodiscard]] nlohmann::ordered_json to_json(const CorrectionReport& report);

// Each of the jobs' threads holds one image, its map and its result. Images that are already
// corrected stay unchanged; the same images give the same files, bit for bit. A baseline does not
// use the survey's light.
CorrectionReport correct_survey(const Survey& survey,
                                const CorrectionOptions& options,
                                const RunWatch& watch);

}  // namespace aphotic
