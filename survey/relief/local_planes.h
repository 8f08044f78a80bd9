// SPDX-License-Identifier: BSD-3-Clause
//
// The planes that touch a depth map. A plane n . P = h shows in every camera without a port as
//
//   1/Z = a + b x + c y,    (x, y) = (X, Y)/Z,    n = (b, c, a) / |(b, c, a)|
//
// linear in the place of the image, so a least-squares fit over a window is exact for any slope.
// Windows are three blocks of block_px pixels each way. A pixel takes the planes of the four
// windows about it, linearly by its place between their middles, unless one of these fits worse
// than another beside it by more than chance, as on a step: then the plane of the best one up to
// two blocks off goes on to it, or, of the least blocks, that of the best 3 x 3 pixels which have
// it.
//
// Independent noise of sigma in Z tilts the plane of a window of m pixels a side by
//
//   sqrt(12) sigma / (m^2 p)  [rad],    p: a pixel on the floor  [m]
//
// and blocks are as large as keep that to kSlopeError, within a twelfth of the image's width.
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
    // On the side of the camera.
    [[nodiscard]] Eigen::Vector3d normal() const {
        return -Eigen::Vector3d(abc(1), abc(2), abc(0)).normalized();
    }
};

class LocalPlanes {
  public:
    // Rows of width_px pixels.
    LocalPlanes(const std::vector<InversePlace>& places, int width_px, int block_px);

    // None where fewer than a quarter of every window near is known.
    [[nodiscard]] std::optional<LocalPlane> at(int column, int row) const;

    // The middle one of all windows' rms over 1/Z: the ranges' relative noise, or how rough the
    // floor is.
    [[nodiscard]] double roughness() const;

  private:
    struct Window {
        LocalPlane plane;
        double mean_per_m = 0.0;
        double count = 0.0;
        bool is_known = false;
        bool is_good = false;  // beside its neighbours
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

// Blocks for this roughness, of pixels of so many radians.
[[nodiscard]] int block_for(double roughness, double pixel_rad, int width_px);

}  // namespace aphotic
