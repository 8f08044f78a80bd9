// SPDX-License-Identifier: BSD-3-Clause
//
// A fit as one page to look at: what was found with its errors, observed and fitted light with
// what is left, the beam with its band of error, residuals over altitude, what was held.
#pragma once

#include "survey/fit/fit.h"

#include <filesystem>

namespace aphotic {

void write_fit_page(const std::filesystem::path& file,
                    const RigText& rig,
                    const FitSamples& samples,
                    const FitResult& result);

}  // namespace aphotic
