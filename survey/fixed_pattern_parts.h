// SPDX-License-Identifier: BSD-3-Clause
//
// A fixed pattern (fixed_pattern.h) on a page: its picture, red where images are brighter than
// expected, blue where they are darker, in full colour at kShownPattern; grey: unseen.
#pragma once

#include "image/any_image.h"
#include "report/page.h"
#include "survey/fixed_pattern.h"

#include <cstddef>
#include <vector>

namespace aphotic {

inline constexpr double kShownPattern = 0.1;

// across: places in a row; image: the size that they cover. Empty for a pattern of no images.
[[nodiscard]] std::vector<PagePart> parts_of(const FixedPattern& pattern,
                                             std::size_t across,
                                             PlaneSize image);

}  // namespace aphotic
