// SPDX-License-Identifier: BSD-3-Clause
//
// The most pixels across or along an image, of rigs and of what is made from them.
#pragma once

namespace aphotic {

inline constexpr int kLargestImagePx = 16384;

}  // namespace aphotic
