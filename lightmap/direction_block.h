// SPDX-License-Identifier: BSD-3-Clause
//
// Directions from a lamp, for the pixels of a block: vectors V of any length, in the lamp's frame.
#pragma once

#include "lightmap/row_block.h"

namespace aphotic {

struct DirectionBlock {
    std::size_t count = kBlockCount;  // in use, a multiple of 16
    bool is_in_order = true;          // of neighbours in a row, along which all is smooth
    RowBlock<double> along;           // V.along and V.across: only where they are asked for
    RowBlock<double> across;
    RowBlock<double> axis;    // V.a
    RowBlock<double> square;  // |V|^2
};

// On which side of a beam's edges a direction is: found for it, or that of the one before.
enum class Edges { Found, Kept };

}  // namespace aphotic
