// SPDX-License-Identifier: BSD-3-Clause
//
// The beam as a fit sees it: an intensity I(w) with a few coefficients c, whatever these are,
//
//   Table    ln I = sum_k c_k B_k(theta), cubic B-splines of the angle off the axis, knots
//   kKnot_rad
//            apart from 0 to the widest angle, mirrored at 0: I is positive, smooth, and even about
//            the axis. Beyond the widest it goes on at its slope.
//   Cones    c_k: the logarithm of a cone's share of the flux, of each of the rig's. Edges under
//            kSoftEdge blocks are softened to that about where they are: a block's mean of a step
//            is a slope, by which its place is found
//   Cosine   cos^n theta, c: ln n
//   Optics   the rig's optics, c: the logarithms of its focal length and distance
//   Held     the rig's beam as it is, with edges as soft as blocks make them
//
// w   direction in the lamp's frame, a unit vector: along, across, axis (rig/beam/beam.h)
//
// What is known beforehand of the coefficients is Gaussian, rows of R c - r of variance 1. Of a
// table it is its second differences, 0 +- kRoughness (a P-spline: P. H. C. Eilers and B. D. Marx,
// Statistical Science 11, 1996, 89), so that it goes on evenly where nobody looks; of all others
// their logarithms, the rig's +- kShapeSpread. As a rig's powers tell how bright it is, the mean of
// a table over what it lights is held, and the sum of all cones' shares.
//
// Derivatives of Table and Cosine are exact, those of the others central differences of a closed
// form, right to kSteps^2. De Boor's splines in their form for even knots: H. Prautzsch, W. Boehm
// and M. Paluszny, Bezier and B-Spline Techniques (2002), 8.7.
#pragma once

#include "rig/beam/beam.h"

#include <Eigen/Core>

#include <cstddef>
#include <string>
#include <vector>

namespace aphotic {

// A cubic step as wide has the variance of the even one over a block: sqrt((1/12) / (1/20)).
inline constexpr double kSoftEdge = 1.29;
inline constexpr double kKnot_rad = 0.0524;  // 3 degrees
inline constexpr double kRoughness = 0.3;
inline constexpr double kShapeSpread = 0.3;
inline constexpr double kMillimetres = 1e3;  // of a metre; in which rigs tell a lens
// Of the angles that a fitted table is written at.
inline constexpr double kFittedStep_deg = 0.5;

enum class FitBeamKind { Table, Cones, Cosine, Optics, Held };

// In one direction.
struct BeamValue {
    double intensity = 0.0;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  // over w, along the sphere
    // Over the coefficients from `first` on; the others change nothing there.
    std::size_t first = 0;
    std::vector<double> by{};
};

// R and r.
struct BeamPrior {
    Eigen::MatrixXd rows;
    Eigen::VectorXd means;
};

class FitBeam {
  public:
    // Begins as the beam, as far as the kind can. block_rad: what a block spans. An InputError
    // where the beam has no such coefficients.
    FitBeam(FitBeamKind kind, const Beam& beam, double widest_rad, double block_rad);

    [[nodiscard]] FitBeamKind kind() const { return kind_; }
    [[nodiscard]] const std::vector<double>& coefficients() const { return c_; }
    [[nodiscard]] double& coefficient(std::size_t which) { return c_[which]; }
    // Of all but a table's: what its exponential is, in the units that rigs have.
    [[nodiscard]] std::vector<std::string> names() const;
    [[nodiscard]] const BeamPrior& prior() const { return prior_; }

    void at(const Eigen::Vector3d& w, BeamValue& value) const;

    // Whether it is fitted and the same all about its axis.
    [[nodiscard]] bool is_round() const {
        return kind_ != FitBeamKind::Optics && kind_ != FitBeamKind::Held;
    }
    [[nodiscard]] double widest_rad() const { return widest_rad_; }
    // As a rig has it: scaled to a flux of 1, and that flux.
    struct Fitted {
        Beam beam;
        double flux = 0.0;
    };
    [[nodiscard]] Fitted fitted() const;

  private:
    void begin_table();
    void soften_cones(double block_rad);
    void table_at(const Eigen::Vector3d& w, BeamValue& value) const;
    void cosine_at(const Eigen::Vector3d& w, BeamValue& value) const;
    [[nodiscard]] double table_intensity_at(double theta_rad) const;
    // With these coefficients, as a beam of the rig's kinds: of cones and optics.
    [[nodiscard]] double intensity_with(const std::vector<double>& c,
                                        const Eigen::Vector3d& w) const;
    [[nodiscard]] BeamOptics optics_with(const std::vector<double>& c) const;

    FitBeamKind kind_;
    double widest_rad_;
    Beam beam_;                   // the rig's
    std::vector<Beam> cones_;     // softened, each of a flux of 1
    std::vector<double> shares_;  // of the rig's cones, logarithms
    std::vector<double> c_;
    BeamPrior prior_;
};

}  // namespace aphotic
