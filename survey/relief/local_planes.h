// SPDX-License-Identifier: BSD-3-Clause
//
// Tangent planes of a depth map. In any camera without a port, a plane n . P = h appears as
//
//   1/Z = a + b x + c y,    (x, y) = (X, Y)/Z,    n = (b, c, a) / |(b, c, a)|
//
// which is linear in the image coordinates, so a least-squares fit over a window is exact for any
// slope. Windows are three blocks of block_px pixels each way. A pixel takes the planes of the four
// windows around it, interpolated linearly by its place between their middles, unless one of these
// fits worse than its neighbour by more than chance, as on a step: then the plane of the best
// window up to two blocks off is extended to it, or, for the smallest blocks, that of the best
// 3 x 3 pixels that contain it.
//
// Independent noise of sigma in Z tilts the plane of a window of m pixels a side by
//
//   sqrt(12) sigma / (m^2 p)  [rad],    p: a pixel on the floor  [m]
//
// and blocks are large enough to limit that to kSlopeError, within a twelfth of the image's width.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace aphotic {

inline constexpr double kSlopeError = 0.01;
inline constexpr int kLeastBlock_px = 2;

// A pixel's place (x, y) and 1/Z; NaN: unknown.
struct InversePlace {
    Eigen::Vector2f place;
    float inverse_per_m;
};

struct LocalPlane {
    Eigen::Vector3d abc = Eigen::Vector3d::Zero();  // of 1/Z
    double rms_per_m = 0.0;                         // of 1/Z in the window

    [[nodiscard]] double inverse_at(const Eigen::Vector2f& place) const {
        return abc(0) + abc(1) * static_cast<double>(place.x()) +
               abc(2) * static_cast<double>(place.y());
    }
    // Towards the camera.
    [[nodiscard]] Eigen::Vector3d normal() const {
        return -Eigen::Vector3d(abc(1), abc(2), abc(0)).normalized();
    }
};

class LocalPlanes {
  public:
    // Rows of width_px pixels.
    LocalPlanes(const std::vector<InversePlace>& places, int width_px, int block_px);

    // Empty if less than a quarter of every window nearby is known.
    [[nodiscard]] std::optional<LocalPlane> at(int column, int row) const;

    // The median of all windows' rms over 1/Z: the ranges' relative noise, or the floor's
    // roughness.
    [[nodiscard]] double roughness() const;

  private:
    struct Window {
        LocalPlane plane;
        double mean_per_m = 0.0;
        double count = 0.0;
        bool is_known = false;
        bool is_good = false;  // compared with its neighbours
    };
    [[nodiscard]] const Window* window(int across, int down) const;
    void judge(int across, int down);
    [[nodiscard]] std::optional<LocalPlane> between(int column, int row) const;
    [[nodiscard]] std::optional<LocalPlane> finest(int column, int row) const;
    [[nodiscard]] std::optional<LocalPlane> best(int column, int row) const;

    const std::vector<InversePlace>& places_;
    int width_px_;
    int block_px_;
    int across_;
    int down_;
    std::vector<Window> windows_;  // by block
};

// Blocks for this roughness, for pixels of this angular size.
[[nodiscard]] int block_for(double roughness, double pixel_rad, int width_px);

}  // namespace aphotic
