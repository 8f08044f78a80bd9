// SPDX-License-Identifier: BSD-3-Clause
//
// Where the edges of the strobes' cones fall in the image, by the geometry of lightmaps
// (row_light.h).
//
// A pixel's point of the floor is within a cone of half angle g when its direction from the lamp,
// v, keeps v.a >= |v| cos g with the strobe's axis a. An edge passes between neighbouring pixels of
// which one is within and the other is not, and over a pixel where the places of an emitter's rim,
// or behind a port the two ends of the wavelength range, disagree. A cone of 90 degrees has no
// edge, for its light ends as cos^n 90 = 0, unless n < 1. The horizon is an edge too.
#pragma once

#include "lightmap/row_light.h"
#include "rig/rig.h"

#include <cstdint>
#include <vector>

namespace aphotic {

class ConeEdges {
  public:
    explicit ConeEdges(const Rig& rig);

    // 1 for every pixel, row by row, within so many pixels of an edge, along rows or columns;
    // within_px = 1: the pixels on both its sides. 0 marks none.
    [[nodiscard]] std::vector<std::uint8_t> mask(const Sled& sled, int within_px) const;

  private:
    // The cones of a strobe that have an edge, and the places that its light comes from.
    struct Lamp {
        std::vector<LampTerms> places;
        std::vector<double> cosines;
    };
    // By pixel of a row, how many of the rays and places have the pixel's point within a thing that
    // has an edge: the floor itself, then each cone of each strobe.
    using Counts = std::vector<std::vector<std::uint8_t>>;

    void count_row(int row, const std::vector<RayTerms>& rays, Counts& counts) const;

    Rig rig_;
    std::vector<double> ends_nm_;  // of the range behind a port, else one wavelength
    std::vector<Lamp> lamps_;
    std::vector<std::uint8_t> most_;  // that a count can be, by thing
};

// Non-zero pixels spread to all within so many pixels along rows and columns: a mask widened.
// Bits keep apart.
void spread(std::vector<std::uint8_t>& mask, int width_px, int within_px);

}  // namespace aphotic
