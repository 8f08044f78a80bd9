// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/block_planes.h"

#include "light/relief_shadow.h"

#include <algorithm>
#include <limits>

namespace aphotic {
namespace {

using Eigen::Vector3d;

// Pixels from the first up to the last.
struct PixelBlock {
    int left;
    int top;
    int right;
    int bottom;
};

PixelBlock block_at(const FitPlaces& places, std::size_t place) {
    const double half_px = 0.5 * places.block_px;
    const int left = static_cast<int>(places.column(place) - half_px);
    const int top = static_cast<int>(places.row(place) - half_px);
    return {.left = left,
            .top = top,
            .right = std::min(left + places.block_px, places.width_px) - 1,
            .bottom = std::min(top + places.block_px, places.height_px) - 1};
}

template <typename Holds>
bool holds_everywhere(const PixelBlock& block, const Holds& holds) {
    for (int row = block.top; row <= block.bottom; ++row)
        for (int column = block.left; column <= block.right; ++column)
            if (!holds(column, row)) return false;
    return true;
}

bool is_of_one_floor(const Relief& relief, const PixelBlock& block) {
    return holds_everywhere(block, [&](int column, int row) {
        const std::size_t pixel = relief.at(column, row);
        return relief.knows(pixel) &&
               (column == block.right || !relief.jumps(pixel, relief.at(column + 1, row))) &&
               (row == block.bottom || !relief.jumps(pixel, relief.at(column, row + 1)));
    });
}

bool is_seen_by_all(const Rig& rig,
                    const ReliefShadow& shadow,
                    const Relief& relief,
                    const PixelBlock& block) {
    return holds_everywhere(block, [&](int column, int row) {
        if (column % shadow.step_px() != 0 || row % shadow.step_px() != 0) return true;
        return std::ranges::none_of(rig.strobes, [&](const Strobe& strobe) {
            return shadow.hides(relief.at(column, row), strobe.position_m);
        });
    });
}

Plane mean_plane(const Relief& relief, const PixelBlock& block) {
    Vector3d point_m = Vector3d::Zero();
    Vector3d normal = Vector3d::Zero();
    double pixels = 0.0;
    for (int row = block.top; row <= block.bottom; ++row) {
        for (int column = block.left; column <= block.right; ++column) {
            const Plane plane = relief.plane(relief.at(column, row));
            point_m += plane.point_m;
            normal += plane.normal;
            pixels += 1.0;
        }
    }
    return {.point_m = point_m / pixels, .normal = normal.normalized()};
}

}  // namespace

std::vector<Plane> block_planes(const Relief& relief, const FitPlaces& places, const Rig& rig) {
    const ReliefShadow shadow(relief);
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    std::vector<Plane> planes;
    for (std::size_t place = 0; place < places.size(); ++place) {
        const PixelBlock block = block_at(places, place);
        const bool has_plane =
            is_of_one_floor(relief, block) && is_seen_by_all(rig, shadow, relief, block);
        planes.push_back(has_plane ? mean_plane(relief, block)
                                   : Plane{.point_m = Vector3d::Constant(kNone),
                                           .normal = Vector3d::Constant(kNone)});
    }
    return planes;
}

}  // namespace aphotic
