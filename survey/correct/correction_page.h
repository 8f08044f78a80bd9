// SPDX-License-Identifier: BSD-3-Clause
//
// What became of a survey, as one page to look at: images before and after, light over altitude,
// gains, doubtful pixels, what was skipped and why, warnings, settings, the rig. It fetches
// nothing: pictures are within.
#pragma once

#include "survey/correct/contact_sheet.h"
#include "survey/correct/correction_run.h"

#include <span>
#include <string>

namespace aphotic {

[[nodiscard]] std::string correction_html(const Survey& survey,
                                          const CorrectionReport& report,
                                          std::span<const SheetImage> sheet);

}  // namespace aphotic
