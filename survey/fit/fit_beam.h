// SPDX-License-Identifier: BSD-3-Clause
//
// The beam as a fit sees it: unknown shares of known parts,
//
//   I(w) = sum_m beta_m f_m(w),      beta_m >= 0
//
// w   direction in the lamp's frame, a unit vector: along, across, axis (rig/beam/beam.h)
//
//   Table    f_m: cubic B-splines of the angle theta off the axis, knots even from 0 to the widest
//            angle, mirrored at 0, so that I is smooth on the axis; 0 beyond the widest
//   Cones    f_m: each of the rig's cones, edges under kSoftEdge blocks softened to that, about
//            where they are: a block's mean of a step is a slope, by which its place is found
//   Cosine   one part, cos^n theta, whose exponent n is a shape
//   Optics   one part, the rig's optics, whose focal length and distance are shapes
//   Held     one part, the rig's beam as it is
//
// Shapes are what the parts depend on besides: found by the search that finds aim and water.
// Derivatives of Table and Cosine are exact; those of the others are central differences of a
// closed form, right to kSteps^2.
//
// De Boor's splines in their form for even knots: H. Prautzsch, W. Boehm and M. Paluszny, Bezier
// and B-Spline Techniques (2002), 8.7.
#pragma once

#include "rig/beam/beam.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace aphotic {

// A cubic step as wide has the variance of the even one over a block: sqrt((1/12) / (1/20)).
inline constexpr double kSoftEdge = 1.29;
inline constexpr double kMillimetres = 1e3;  // of a metre; in which rigs tell a lens

enum class FitBeamKind { Table, Cones, Cosine, Optics, Held };

// A part's share at a direction.
struct BeamPartValue {
    std::size_t part = 0;
    double value = 0.0;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  // over w, along the sphere
    std::array<double, 2> by_shape{};
};

class FitBeam {
  public:
    // Of a table: parts, four or more, over angles up to widest_rad.
    [[nodiscard]] static FitBeam table(std::size_t parts, double widest_rad);
    // Throws InputError where the beam is no sum of cones. block_rad: what a block spans.
    [[nodiscard]] static FitBeam cones(const Beam& beam, double block_rad);
    [[nodiscard]] static FitBeam cosine(double exponent);
    // One part, the beam itself.
    [[nodiscard]] static FitBeam held(const Beam& beam);
    // Throws InputError where the beam is of no optics.
    [[nodiscard]] static FitBeam optics(const Beam& beam);

    [[nodiscard]] FitBeamKind kind() const { return kind_; }
    [[nodiscard]] std::size_t parts() const { return parts_; }
    [[nodiscard]] const std::vector<double>& shapes() const { return shapes_; }
    [[nodiscard]] std::vector<std::string> shape_names() const;
    [[nodiscard]] double& shape(std::size_t which) { return shapes_[which]; }
    [[nodiscard]] double widest_rad() const { return widest_rad_; }

    // Those that are not 0 there; of differences, the slopes only where they are asked for.
    void at(const Eigen::Vector3d& w, bool has_slopes, std::vector<BeamPartValue>& values) const;

    // Whether it is one that is fitted and the same all about its axis.
    [[nodiscard]] bool is_round() const {
        return kind_ == FitBeamKind::Table || kind_ == FitBeamKind::Cones ||
               kind_ == FitBeamKind::Cosine;
    }
    // Of a round one, off its axis: each part, and the first part's slopes over the shapes.
    [[nodiscard]] Eigen::VectorXd parts_at(double theta_rad) const;
    [[nodiscard]] std::array<double, 2> slopes_at(double theta_rad) const;
    // As a rig has it: scaled to a flux of 1, and that flux.
    struct Fitted {
        Beam beam;
        double flux = 0.0;
    };
    [[nodiscard]] Fitted beam_of(const Eigen::VectorXd& shares) const;

  private:
    FitBeam() = default;
    void splines_at(const Eigen::Vector3d& w, std::vector<BeamPartValue>& values) const;
    void cosine_at(const Eigen::Vector3d& w, std::vector<BeamPartValue>& values) const;
    void optics_at(const Eigen::Vector3d& w,
                   bool has_slopes,
                   std::vector<BeamPartValue>& values) const;
    using Shapes = std::array<double, 2>;
    [[nodiscard]] BeamOptics optics_with(const Shapes& shapes) const;

    FitBeamKind kind_ = FitBeamKind::Table;
    std::size_t parts_ = 0;
    double widest_rad_ = 0.0;
    std::vector<double> shapes_;
    Beam beam_;                     // the rig's, of cones and optics
    std::vector<Beam> part_beams_;  // of cones, and of one that is held
};

// Of the angles that a fitted table is written at.
inline constexpr double kFittedStep_deg = 0.5;

}  // namespace aphotic
