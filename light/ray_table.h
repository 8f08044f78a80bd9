// SPDX-License-Identifier: BSD-3-Clause
//
// The rays in water of every place of the image at one wavelength. A pinhole's have a formula.
// Those of calibrated lenses and of ports take long, so they come from pixel_ray() (rig/geometry.h)
// at the nodes of a grid over the image, a sixty-fourth of the focal length f apart; between these
// each is a cubic through the four next nodes of either way. Where the formula changes over f, that
// is right to about (1/64)^4 / 40, 1e-9 of a slope. Where nodes would be closer than pixels, each
// ray is computed by itself.
#pragma once

#include "rig/rig.h"

#include <array>
#include <cstddef>
#include <vector>

namespace aphotic {

class RayTable {
  public:
    RayTable(const Rig& rig, double lambda_nm, int threads);

    // Pixels' centres are at .5.
    [[nodiscard]] WaterRay at(double column, double row) const;

    [[nodiscard]] bool has_nodes() const { return !nodes_.empty(); }

  private:
    // Nodes along one way of the image.
    struct Axis {
        Axis(int pixels, double most_apart_px);
        double pixels;
        std::size_t nodes;
    };
    using Node = std::array<double, 6>;  // origin and direction

    Rig rig_;
    double lambda_nm_;
    Axis across_;
    Axis down_;
    std::vector<Node> nodes_;
};

}  // namespace aphotic
