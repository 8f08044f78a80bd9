// SPDX-License-Identifier: BSD-3-Clause
//
// The result of a survey's correction, as one page: images before and after, light over altitude,
// gains, doubtful pixels, skipped images and why, warnings, settings, the rig. It is
// self-contained: pictures are embedded.
#pragma once

#include "report/page.h"
#include "survey/correct/correction_run.h"

#include <string>

namespace aphotic {

[[nodiscard]] std::string correction_html(const Survey& survey,
                                          const CorrectionReport& report,
                                          PageFigures sheet);  // contact_sheet.h

}  // namespace aphotic
