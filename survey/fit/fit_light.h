// SPDX-License-Identifier: BSD-3-Clause
//
// The light of docs/background/physics.md on blocks of an image, and its derivatives over all
// fitted numbers, by the kernel's own formulas (light/floor_ray.h):
//
//   L_c = V sum_s P_s [ B I(w) cos(i)/(pi d^2) T_c(d + r)
//                       + sum_i int p_i(psi) I(w) V_ic(t + d) / d^2 dt ]
//
// P_s    the strobe's power                      V     vignetting: the rig's, cos^n, or
//                                                      1 + a1 p^2 + ...
// I      fit_beam.h's, w in the frame            T, V_ic   survey/fit/path_light.h
//        of the strobe as it is aimed
// B      the floor's brightness, 1 for the rig's: the veil does not depend on it
//
// Geometry is computed in ceres::Jet, which carries its derivatives over the sled's altitude, pitch
// and roll and the strobe's aim. Derivatives over the water are the tables' (path_light.h), those
// over the beam's coefficients the beam's.
//
// Lamps are points, the floor is flat and matt. Behind a port each channel has the ray of its mean
// wavelength. The veil is integrated by Gauss-Legendre quadrature with kFitVeilPoints over the
// angle at the lamp, at the Chebyshev points of light/tile_fit.h with the image as one tile. Its
// change with the sled's pose is neglected: it is small, and so are the pose offsets.
//
// The mean over a block is, each way, the value at its middle plus a 24th of the second differences
// of middles: exact for cubics.
//
// Alternatively, blocks have planes of their own (block_planes.h). These do not move with the pose,
// the veil is integrated up to each of them, and the mean over a block is the value at its middle,
// since neighbouring middles lie on different planes.
//
// An aim is turned by two small angles, towards `along` and `across` of the rig's own frame of the
// strobe (rig/beam/beam.h). Offsets are added to the navigation's altitude, pitch and roll.
#pragma once

#include "rig/geometry.h"
#include "rig/rig.h"
#include "survey/fit/fit_beam.h"
#include "survey/fit/path_light.h"

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace aphotic {

inline constexpr unsigned kFitVeilPoints = 8;

// Places of the image, with pixel centres at .5: the middles of blocks, in rows from the top left.
struct FitPlaces {
    int width_px = 0;
    int height_px = 0;
    int block_px = 1;

    [[nodiscard]] std::size_t across() const {
        return static_cast<std::size_t>(std::max(1, width_px / block_px));
    }
    [[nodiscard]] std::size_t down() const {
        return static_cast<std::size_t>(std::max(1, height_px / block_px));
    }
    [[nodiscard]] std::size_t size() const { return across() * down(); }
    [[nodiscard]] double column(std::size_t place) const {
        return (static_cast<double>(place % across()) + 0.5) * block_px;
    }
    [[nodiscard]] double row(std::size_t place) const {
        const std::size_t row = place / across();
        return (static_cast<double>(row) + 0.5) * block_px;
    }
};

// An image or a map as blocks.
struct FitImage {
    std::string name;
    Sled sled;
    std::vector<float> signal{};   // by place, then channel
    std::vector<Plane> planes{};   // by place; empty: the floor is the sled's plane
    double saturated_share = 0.0;  // of its samples
};

// The quantities that a fit adjusts.
struct FitState {
    std::vector<FitBeam> beams;                  // one for all strobes, or one for each
    std::vector<std::size_t> beam_of;            // by strobe
    std::vector<std::array<double, 2>> aim_rad;  // by strobe, relative to the rig: along, across
    std::vector<double> power;                   // by strobe
    std::vector<WaterNumber> water;
    FloorTint tint{};  // q1, q2 of path_light.h
    double floor_brightness = 1.0;
    std::vector<double> vignetting;  // n, or a1, a2, a3; empty: the rig's own
    Sled offset;
};

enum class FitPart { Beam, Aim, Power, Water, Tint, Brightness, Lens, Offset };

// One number of the state.
struct FitPlaceInState {
    FitPart part{};
    std::size_t of = 0;     // strobe, beam or number of the water
    std::size_t which = 0;  // of coefficients, aim, tint, vignetting, offset

    [[nodiscard]] bool operator==(const FitPlaceInState&) const = default;
};
// Of the fitted rig, by strobe: beams scaled to a flux of 1, and the sum as in the rig, since
// images do not determine the common scale.
[[nodiscard]] std::vector<double> powers_in(const FitState& state, const Rig& rig);
[[nodiscard]] double& number_in(FitState& state, const FitPlaceInState& at);

// The axis of a strobe with the state's aim.
[[nodiscard]] Eigen::Vector3d aimed_axis(const Rig& rig,
                                         const std::array<double, 2>& aim_rad,
                                         std::size_t strobe);

// Rows: by place, then channel.
struct BlockLight {
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    Eigen::VectorXd logarithm;    // of L; NaN where it is missing
    Eigen::VectorXd floor_share;  // of the light that is not veil
    Rows slopes;                  // of the logarithm, over the requested numbers
    Rows by_pose;                 // over altitude, pitch and roll
};

class FitLight {
  public:
    static constexpr int kPose = 3;

    FitLight(const Rig& rig, const FitPlaces& places);

    // planes: an image's.
    [[nodiscard]] BlockLight at(const FitState& state,
                                const PathLight& light,
                                const Sled& sled,
                                const std::vector<FitPlaceInState>& numbers,
                                const std::vector<Plane>& planes = {}) const;

    // The paths that these images can show, with room for altitude offsets.
    [[nodiscard]] PathRange paths(const std::vector<FitImage>& images) const;
    // The widest angle off any strobe's axis of the visible floor, up to a right angle.
    [[nodiscard]] double widest_rad(const std::vector<FitImage>& images) const;
    // The angle that a block at the image's middle subtends.
    [[nodiscard]] double block_rad() const;

    [[nodiscard]] const FitPlaces& places() const { return places_; }

    using Rays = std::vector<WaterRay>;  // one, or by channel
    // The camera's view of a place.
    struct Sight {
        double from_middle2 = 0.0;  // p^2 of vignetting
        double cosine = 1.0;        // off the optical axis, in air
        double vignetting = 1.0;    // the rig's own
    };

    // Values on one grid from those on another: a matrix along its rows, and one down its columns.
    struct Grids {
        using Shares = Eigen::SparseMatrix<double, Eigen::RowMajor>;
        Shares along;
        Shares down;
    };

  private:
    // use(ray, strobe, what it shows)
    template <typename Use>
    void for_each_way(const std::vector<FitImage>& images, const Use& use) const;

    Rig rig_;
    FitPlaces places_;
    std::vector<Rays> rays_;  // by place
    std::vector<Sight> sights_;
    std::vector<Rays> veil_nodes_;
    Grids veil_;   // from the nodes to the places
    Grids means_;  // from the middles of blocks
};

}  // namespace aphotic
