// SPDX-License-Identifier: BSD-3-Clause
//
// Where the edges of the strobes' beams fall in the image, by the geometry of lightmaps
// (row_light.h).
//
// A pixel's point of the floor is within a cone of half angle g when its direction from the lamp,
// v, keeps v.a >= |v| cos g with the strobe's axis a. An edge passes between neighbouring pixels of
// which one is within and the other is not, and over a pixel where the places of an emitter's rim,
// or behind a port the two ends of the wavelength range, disagree. What is
// an edge, rig/beam/beam.h tells (edges_rad, has_rim): a cone of 90 degrees has none, for its light
// ends as cos^n 90 = 0, unless n < 1; nor has a soft one. The horizon is an edge too.
#pragma once

#include "lightmap/beam_edges.h"
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
    // The edges of a strobe's beam, and the places that its light comes from.
    struct Lamp {
        std::vector<LampTerms> places;
        BeamEdges edges;
    };
    // By pixel of a row, how many of the rays and places have the pixel's point within a thing that
    // has an edge: the floor itself, then each edge of each strobe.
    using Counts = std::vector<std::vector<std::uint8_t>>;

    void count_row(int row, const std::vector<RayTerms>& rays, Counts& counts) const;

    Rig rig_;
    std::vector<double> ends_nm_;  // of the range behind a port, else one wavelength
    std::vector<std::shared_ptr<const RayTable>> ray_tables_;  // at each
    std::vector<Lamp> lamps_;
    std::vector<std::uint8_t> most_;  // that a count can be, by thing
};

// Non-zero pixels spread to all within so many pixels along rows and columns: a mask widened.
// Bits keep apart.
void spread(std::vector<std::uint8_t>& mask, int width_px, int within_px);

}  // namespace aphotic
