// SPDX-License-Identifier: BSD-3-Clause
//
// The rays in water for every place of the image at some wavelengths. A pinhole's have a formula.
// Those of calibrated lenses and of ports are slow, so they come from pixel_ray() (rig/geometry.h)
// at the nodes of a grid over the image; between nodes each is a cubic through the four nearest
// nodes either way. The grid is fine enough for kRayTableError in the middles of its cells along
// the image's rim and middle lines, where lenses bend most and least. If there would be as many
// nodes as pixels, each ray is computed directly.
#pragma once

#include "base/lanes.h"
#include "light/lane_ray.h"
#include "rig/rig.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace aphotic {

// For directions [rad], and for origins in metres.
inline constexpr double kRayTableError = 2e-9;

class RayTable {
  public:
    RayTable(const Rig& rig, std::vector<double> lambda_nm, int threads);

    // For the first wavelengths, one for each ray; pixels' centres are at .5.
    void look(double column, double row, std::span<WaterRay> rays) const;
    // Sets origins and directions.
    void look(const Lanes& column, const Lanes& row, std::span<LaneRay> rays) const;

    [[nodiscard]] bool has_nodes() const { return !nodes_.empty(); }

  private:
    // Nodes along one side of the image.
    struct Axis {
        Axis(int pixels, double most_apart_px);
        [[nodiscard]] double place_px(double node) const;
        template <typename T>
        [[nodiscard]] T node_at(const T& place_px) const;
        double pixels;
        std::size_t nodes;
    };
    using Node = std::array<double, 6>;  // origin and direction
    using RaySum = Eigen::Array<double, 6, 1>;

    void make_nodes(int threads);
    // Directions are not of unit length.
    [[nodiscard]] RaySum sum_at(double column, double row, std::size_t wavelength) const;
    [[nodiscard]] std::array<RaySum, 4> nodes_along(std::size_t first_across,
                                                    double down,
                                                    std::size_t wavelength) const;
    // False if these places are not in a row between the same nodes.
    [[nodiscard]] bool look_along_row(const Lanes& column,
                                      const Lanes& row,
                                      std::span<LaneRay> rays) const;
    void look_at_each(const Lanes& column, const Lanes& row, std::span<LaneRay> rays) const;
    [[nodiscard]] bool is_exact() const;

    Rig rig_;
    std::vector<double> lambda_nm_;
    Axis across_;
    Axis down_;
    std::vector<Node> nodes_;  // by place and wavelength
};

}  // namespace aphotic
