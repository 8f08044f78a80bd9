// SPDX-License-Identifier: BSD-3-Clause
//
// The signal of places of an image as a linear function of the shares of the beams' parts, and its
// derivatives over all else that a fit looks for:
//
//   S_c = g_c V sum_s P_s sum_m beta_m [ B f_m(w) cos(i)/(pi d^2) T_c(d + r)
//                                        + sum_i int p_i(psi) f_m(w) V_ic(t + d) / d^2 dt ]
//
// g_c    the channel's gain, 1 of green      V     vignetting: the rig's, or 1 + a1 p^2 + ...
// P_s    the strobe's power                  f_m   parts of the beam (fit_beam.h), w in the frame
// T, V   survey/fit/path_light.h                       of the strobe as it is aimed
// B      the floor's brightness, 1 of the rig's: the veil is as bright above any floor
//
// All else is light/veil.h's and docs/physics.md's. Lamps are points, the floor is flat and matt.
// Behind a port each channel has the ray of its mean wavelength. The veil is integrated by
// kFitVeilPoints of Gauss and Legendre's over the angle at the lamp, at kFewestVeilNodes to
// kFitVeilNodes across and down the image, one for two blocks; between these it is the cubic
// through the four next of each way.
//
// The mean over a block is that of its pixels of the polynomial through the middles of the
// kMeanBlocks next blocks, each way.
//
// Aim is turned by two small angles, towards `along` and `across` of the rig's own frame of the
// strobe (rig/beam/beam.h). Offsets are added to the altitude, pitch and roll that the navigation
// tells.
#pragma once

#include "rig/rig.h"
#include "survey/fit/fit_beam.h"
#include "survey/fit/path_light.h"

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace aphotic {

inline constexpr unsigned kFitVeilPoints = 8;
inline constexpr std::size_t kFewestVeilNodes = 7;
inline constexpr std::size_t kFitVeilNodes = 13;
inline constexpr std::size_t kMeanBlocks = 5;
// By how much an aim may be off before the beam's table ends within the image; and how much farther
// off their axes lamps light water that the image sees.
inline constexpr double kAimRoom_rad = 0.15;
inline constexpr double kVeilRoom_rad = 0.25;

// Places of the image, pixels' centres at .5: the middles of blocks, in rows from the top left.
struct FitPlaces {
    int width_px = 0;
    int height_px = 0;
    int block_px = 1;
    std::vector<double> columns{};
    std::vector<double> rows{};

    [[nodiscard]] std::size_t size() const { return columns.size(); }
};

// What the fit looks for besides the shares.
struct FitState {
    std::vector<FitBeam> beams;                  // one of all strobes, or each its own
    std::vector<std::size_t> beam_of;            // by strobe
    std::vector<std::array<double, 2>> aim_rad;  // by strobe, off the rig's: along, across
    std::vector<double> power;                   // by strobe
    std::vector<WaterNumber> water;
    FloorTint floor{};  // q1, q2 of path_light.h
    double floor_brightness = 1.0;
    std::vector<double> vignetting;  // a1, a2, a3; empty: the rig's own
    std::array<double, kChannels> gain{1.0, 1.0, 1.0};
    Sled offset;
};

enum class FitPart {
    Water,
    FloorColour,
    FloorBrightness,
    Aim,
    Power,
    BeamShape,
    LensFactor,
    Offset,
    Gain
};

// One number of the state that is free.
struct FitNumber {
    FitPart part{};
    std::size_t of = 0;     // strobe, beam, channel or number of the water
    std::size_t which = 0;  // of aim, shapes, offsets
};
[[nodiscard]] double& number_in(FitState& state, const FitNumber& number);

// The axis of a strobe as the state aims it.
[[nodiscard]] Eigen::Vector3d aimed_axis(const Rig& rig, const FitState& state, std::size_t strobe);

class FitLight {
  public:
    FitLight(const Rig& rig, const FitPlaces& places);

    // Rows: by place, then channel. Columns of parts: by beam, then part.
    using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    [[nodiscard]] static std::size_t part_columns(const FitState& state);

    void parts_into(const FitState& state,
                    const PathLight& light,
                    const Sled& sled,
                    Rows& rows) const;

    // Columns of parts, then of the numbers, of altitude, pitch and roll, all as derivatives of the
    // signal with these shares, what of the signal is the floor's light, and the signal itself.
    static constexpr std::size_t kPoseColumns = 3;
    void columns_into(const FitState& state,
                      const PathLight& light,
                      const Sled& sled,
                      const Eigen::VectorXd& shares,
                      const std::vector<FitNumber>& numbers,
                      Rows& all) const;

    // The paths that these sleds can show, with room for offsets of the altitude.
    [[nodiscard]] PathRange paths(const std::vector<Sled>& sleds) const;
    // The widest angle off any strobe's axis of the floor that the places see, kAimRoom_rad and,
    // where the water scatters, kVeilRoom_rad more; up to a right angle.
    [[nodiscard]] double widest_rad(const std::vector<Sled>& sleds) const;
    // Whether the state's vignetting is over 0 all over the image.
    [[nodiscard]] bool is_bright(const FitState& state) const;
    // What a block at the image's middle spans.
    [[nodiscard]] double block_rad() const;

    [[nodiscard]] std::size_t rows() const { return kChannels * places_.size(); }
    [[nodiscard]] const FitPlaces& places() const { return places_; }

  private:
    using Rays = std::vector<WaterRay>;  // one, or by channel
    struct Place {
        Rays rays;
        double from_middle2 = 0.0;  // p^2 of vignetting
        double vignetting = 1.0;    // the rig's own
    };
    template <typename Scene, typename Add>
    void light_floor(const Scene& scene, const Add& add) const;
    template <typename Scene, typename Add>
    void light_water(const Scene& scene, const Add& add) const;
    // From what the nodes see of the veil to what the places do.
    void add_between_nodes(const Rows& of_nodes, Rows& rows) const;
    // From middles of blocks to their means.
    void average_over_blocks(Rows& rows) const;
    // The lens' V.
    void multiply_by_vignetting(const FitState& state, Rows& rows) const;

    Rig rig_;
    FitPlaces places_;
    std::vector<Place> sights_;
    std::vector<Rays> veil_nodes_;
    Eigen::SparseMatrix<double, Eigen::RowMajor> from_nodes_;  // by place and node
    Eigen::SparseMatrix<double, Eigen::RowMajor> means_;       // by place and place; none: points
};

}  // namespace aphotic
