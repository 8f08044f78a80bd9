// SPDX-License-Identifier: BSD-3-Clause
//
// Where the edges of the strobes' beams are in the image, by the geometry of lightmaps
// (light/floor_ray.h). Only tiles that an edge may enter are examined pixel by pixel.
//
// A pixel's floor point is within a cone of half angle g if its direction from the lamp, v, has v.a
// >= |v| cos g with the strobe's axis a. An edge passes between neighbouring pixels of which one is
// within and the other is not, and over a pixel where the places of an emitter's rim, or behind a
// port the two ends of the wavelength range, disagree. rig/beam/beam.h defines edges (edges_rad,
// has_rim): a cone of 90 degrees has none, since its light ends as cos^n 90 = 0, unless n < 1; nor
// has a soft one. The horizon is an edge too.
#pragma once

#include "light/beam_light.h"
#include "light/ray_table.h"
#include "rig/rig.h"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace aphotic {

class ConeEdges {
  public:
    explicit ConeEdges(const Rig& rig);

    // 1 for every pixel, row by row, within this many pixels of an edge, along rows or columns;
    // within_px = 1: the pixels on both its sides. 0 marks none.
    [[nodiscard]] std::vector<std::uint8_t> mask(const Sled& sled, int within_px) const;

  private:
    // An edge of a strobe's beam, and the places that emit its light.
    struct LampEdge {
        std::vector<Eigen::Vector3d> places_m;
        std::size_t strobe = 0;
        std::size_t edge = 0;
        std::vector<Crease> creases{};
    };
    struct Tile;

    void mark(const Tile& tile, const Sled& sled, std::vector<std::uint8_t>& mask) const;

    Rig rig_;
    RayTable rays_;                 // at the ends of the range behind a port, else at one
    std::vector<BeamEdges> beams_;  // by strobe
    std::vector<LampEdge> edges_;
};

// Non-zero pixels spread to all within this many pixels along rows and columns: a dilated mask.
// Bits stay separate.
void spread(std::vector<std::uint8_t>& mask, int width_px, int within_px);

}  // namespace aphotic
