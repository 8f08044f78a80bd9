// SPDX-License-Identifier: BSD-3-Clause
//
// The floor's light (floor_light.h) at every pixel of an image, by tiles (tile_image.h) of
// kFloorTile_px.
//
// Where no crease of a lamp's beam (beam_crease.h) enters a tile (tile_cone.h), the lamp's light is
// smooth there, and a polynomial is accurate to kTileError of the lamps' signal. Lamps near one of
// their creases, or whose light is too steep, are passed to smaller tiles. The cost thus depends on
// the smoothness of the light of beam, lens and port.
#pragma once

#include "light/floor_light.h"
#include "light/tile_image.h"

namespace aphotic {

// Relative to the signal: a third of it at the places where it is checked.
inline constexpr double kTileError = 1e-6;
inline constexpr int kFloorTile_px = 64;

// Pixels with light whose path is not in the table.
struct Outside {
    bool is_before = false;
    bool is_beyond = false;
};

[[nodiscard]] Outside paint_floor(const FloorLight& light, int threads, const ImageRows& rows);

}  // namespace aphotic
