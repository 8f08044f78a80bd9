// SPDX-License-Identifier: BSD-3-Clause
//
// Sizes of images: numbers of pixels, rows and columns.
#pragma once

#include <cstddef>

namespace aphotic {

// The largest number of pixels across or along an image, for rigs and everything made from them.
inline constexpr int kLargestImagePx = 16384;

// A number that is not negative, as a container's size type.
[[nodiscard]] constexpr std::size_t size_of(int number) {
    return static_cast<std::size_t>(number);
}

}  // namespace aphotic
