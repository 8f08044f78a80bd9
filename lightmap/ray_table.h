// SPDX-License-Identifier: BSD-3-Clause
//
// The rays in water of every pixel at one wavelength, for cameras whose rays have no short formula:
// calibrated lenses, tilted and domed ports. They come from pixel_ray() (rig/geometry.h) at some
// rows of the image, a sixty-fourth of the focal length f apart and no more than kMostRowsApart;
// between these each pixel's is a cubic through its column's four next. Where the formula changes
// over f, that is right to about (1/64)^4 / 40, 1e-9 of a slope.
//
// Rays are as those of row_light.h: D with z = 1, o in the plane z = front_m(port), and `ahead`,
// how far along D from o, in units of D, the water begins.
#pragma once

#include "lightmap/row_block.h"
#include "rig/rig.h"

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

namespace aphotic {

struct RayBlock;

class RayTable {
  public:
    static constexpr double kMostRowsApart = 8.0;

    RayTable(const Rig& rig, double lambda_nm, int threads);

    // Of kRowBlock neighbours from a column on, a multiple of kRowBlock; or of any columns.
    void look_from(int row, int first_column, RayBlock& rays) const;
    void look_at(int row, const RowBlock<int>& columns, RayBlock& rays) const;

    [[nodiscard]] bool has_port() const { return planes_ > 2; }
    [[nodiscard]] double front_m() const { return front_m_; }

  private:
    // Where a row's four nodes begin in each plane, and what each counts.
    struct Nodes {
        std::size_t first;
        std::array<double, 4> weights;
    };
    [[nodiscard]] Nodes nodes_of(int row) const;
    [[nodiscard]] const double* plane(std::size_t k) const {
        return &samples_[k * stride_ * nodes_];
    }

    int height_px_;
    std::size_t stride_;  // of a row of nodes
    std::size_t nodes_;
    std::size_t planes_;  // D_x and D_y, and behind a port o_x, o_y and ahead
    double front_m_;
    std::vector<double> samples_;
};

// None where the rays have a formula: a pinhole without a port, or with one across the axis.
[[nodiscard]] std::shared_ptr<const RayTable> ray_table(const Rig& rig,
                                                        double lambda_nm,
                                                        int threads);

}  // namespace aphotic
