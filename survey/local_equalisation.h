// SPDX-License-Identifier: BSD-3-Clause
//
// Contrast-limited adaptive histogram equalisation: every part of the image is given the same
// distribution of brightness, whatever its light.
//
//   out = least + (most - least) F(I)
//
// F            the share of samples below I, of the tile around; between the centres of tiles
//              their F are interpolated linearly, beyond the outermost they go on
// least, most  of the plane: out stays within them, and f(k I) = k f(I)
// clip         no bin counts for more than clip times the mean bin, and what is cut off is spread
//              over all bins: 1 leaves the image as it is, without a bound F is the tile's own
//
// Bins are kBins between least and most, and F is linear within a bin. A constant stays as it is.
// It bends the tones, so that what comes out measures nothing; and a pale patch as large as a tile
// is levelled away with the light.
//
// K. Zuiderveld, "Contrast limited adaptive histogram equalization", Graphics Gems IV, 1994.
#pragma once

#include <span>
#include <vector>

namespace aphotic {

inline constexpr int kBins = 1024;

struct LocalEqualisation {
    int tiles = 8;  // across and down
    double clip = 3.0;
};

// plane: rows of width_px samples, all finite. An InputError when there are more tiles than rows or
// columns.
[[nodiscard]] std::vector<float> locally_equalised(std::span<const float> plane,
                                                   int width_px,
                                                   const LocalEqualisation& options);

}  // namespace aphotic
