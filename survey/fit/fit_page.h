// SPDX-License-Identifier: BSD-3-Clause
//
// A fit as one page to view: the results with their errors, observed and fitted light with the
// residuals, the beam with its error band, residuals over altitude, the numbers held.
#pragma once

#include "survey/fit/fit.h"

#include <filesystem>

namespace aphotic {

void write_fit_page(const std::filesystem::path& file,
                    const RigText& rig,
                    const FitSamples& samples,
                    const FitResult& result);

}  // namespace aphotic
