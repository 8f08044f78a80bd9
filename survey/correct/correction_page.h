// SPDX-License-Identifier: BSD-3-Clause
//
// The result of a survey's correction, as one page: images before and after, light over altitude,
// gains, doubtful pixels, skipped images and why, warnings, settings, the rig. It is
// self-contained: pictures are embedded.
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
