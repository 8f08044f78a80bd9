// SPDX-License-Identifier: BSD-3-Clause
//
// Results that shares of a survey's images (base/share.h) left below a folder, taken into it with
// their notes: the run that follows finds them done, and does what no share has.
#pragma once

#include "survey/image_run.h"

#include <cstddef>
#include <vector>

namespace aphotic {

// Returns how many images it took. A RunError where this machine still works on a share. What stays
// of the shares' folders is what is not ours.
std::size_t join_shares(const std::vector<ImageFile>& files, const ImageRunOptions& options);

}  // namespace aphotic
