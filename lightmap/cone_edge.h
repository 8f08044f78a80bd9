// SPDX-License-Identifier: BSD-3-Clause
//
// Where the edges of the strobes' cones fall in the image, by geometry alone.
//
// A pixel's point of the floor is within a cone of half angle g when its direction from the lamp,
// v, keeps v.a >= |v| cos g with the strobe's axis a. An edge passes between neighbouring pixels of
// which one is within and the other is not, and over a pixel where the places of an emitter's rim,
// or behind a port the two ends of the wavelength range, disagree. A cone of 90 degrees has no
// edge: its light ends as cos 90 = 0. The horizon is an edge too.
#pragma once

#include "scene_gen/rig.h"

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
    // Where the pixels' rays enter the water, all at the height of_z_m, and their slopes per metre
    // down.
    struct Rays {
        float of_z_m = 0.0F;
        std::vector<float> x_m, y_m, slope_x, slope_y;
    };
    // A strobe's cone from each place that its light comes from.
    struct Cone {
        std::vector<Eigen::Vector3f> lamps_m;
        Eigen::Vector3f axis;
        float cos2_edge = 0.0F;
    };
    // By thing that has an edge, the floor itself and then the cones, and by pixel of a row: how
    // many of the rays and places have the pixel's point within it.
    using Counts = std::vector<std::vector<std::uint8_t>>;

    void count_row(int row, const Sled& sled, Counts& counts) const;
    [[nodiscard]] std::size_t most_of(std::size_t thing) const;

    int width_px_;
    int height_px_;
    std::vector<Rays> rays_;  // of the ends of the range behind a port, else one
    std::vector<Cone> cones_;
};

// Non-zero pixels spread to all within so many pixels along rows and columns: a mask widened.
// Bits keep apart.
void spread(std::vector<std::uint8_t>& mask, int width_px, int within_px);

}  // namespace aphotic
