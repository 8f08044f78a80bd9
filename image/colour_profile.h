// SPDX-License-Identifier: BSD-3-Clause
//
// ICC profiles (ICC.1:2010) by Little CMS, from which other programs interpret an image's numbers.
//
//   sRGB      primaries, white and transfer curve of IEC 61966-2-1
//   linear    the same primaries and white, transfer curve v = x. A camera's own channels have no
//             primaries: such an image is shown with plausible colours, and never brighter or
//             darker
//   grey      one channel, linear
//
// The same profile has the same bytes whenever it is made.
#pragma once

#include <cstdint>
#include <vector>

namespace aphotic {

enum class ColourProfile { Srgb, Linear, LinearGrey };

[[nodiscard]] std::vector<std::uint8_t> icc_profile(ColourProfile profile);

}  // namespace aphotic
