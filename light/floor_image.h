// SPDX-License-Identifier: BSD-3-Clause
//
// The floor's light (floor_light.h) at every pixel of an image, at the price of what is not smooth.
//
// The image is cut into tiles of kTilePixels. Where no crease of a lamp's beam (beam_crease.h)
// comes within a tile (tile_cone.h), the lamp's light is smooth there: it is computed at the points
// of tile_fit.h and interpolated, if at the places between it is right to kTileError of the lamps'
// signal. Lamps of which a crease comes near, or whose light is too steep, go on to the four
// quarters of the tile; and at kDirectPixels they are computed pixel by pixel. So the light of
// every beam, lens and port costs what its smoothness asks. Tiles depend on the image alone:
// neither threads nor the rows that are asked for change a bit.
#pragma once

#include "light/floor_light.h"

#include <vector>

namespace aphotic {

// Of the signal: a third of it at the places where it is checked.
inline constexpr double kTileError = 1e-6;
inline constexpr int kDirectPixels = 8;

// Rows of an image, planes R, G and B one after another.
struct ImageRows {
    int width_px = 0;
    int first = 0;
    int count = 0;
    float* samples = nullptr;
};

// Pixels with light whose path is not in the table.
struct Outside {
    bool is_before = false;
    bool is_beyond = false;
};

[[nodiscard]] Outside paint_floor(const FloorLight& light,
                                  int height_px,
                                  int threads,
                                  const ImageRows& rows);

}  // namespace aphotic
