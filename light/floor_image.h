// SPDX-License-Identifier: BSD-3-Clause
//
// The floor's light (floor_light.h) at every pixel of an image, by tiles (tile_image.h) of
// kFloorTile_px.
//
// Where no crease of a lamp's beam (beam_crease.h) comes within a tile (tile_cone.h), the lamp's
// light is smooth there, and right by a polynomial to kTileError of the lamps' signal. Lamps of
// which a crease comes near, or whose light is too steep, go on to smaller tiles. So the light of
// every beam, lens and port costs what its smoothness asks.
#pragma once

#include "light/floor_light.h"
#include "light/tile_image.h"

namespace aphotic {

// Of the signal: a third of it at the places where it is checked.
inline constexpr double kTileError = 1e-6;
inline constexpr int kFloorTile_px = 64;

// Pixels with light whose path is not in the table.
struct Outside {
    bool is_before = false;
    bool is_beyond = false;
};

[[nodiscard]] Outside paint_floor(const FloorLight& light, int threads, const ImageRows& rows);

}  // namespace aphotic
