// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit_page.h"

namespace aphotic {

void write_fit_page(const std::filesystem::path&,
                    const RigText&,
                    const FitSamples&,
                    const FitResult&) {}

}  // namespace aphotic
