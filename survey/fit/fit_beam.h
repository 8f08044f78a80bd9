// SPDX-License-Identifier: BSD-3-Clause
//
// The beam in a fit: an intensity I(w) with a few coefficients c, whose meaning depends on the
// kind:
//
//   Table    ln I = sum_k c_k B_k(theta), cubic B-splines of the angle off the axis, with knots
//            kKnot_rad apart from 0 to the widest angle, mirrored at 0: I is positive, smooth, and
//            even about the axis. Beyond the widest angle it continues with its slope.
//   Cones    c_k: each cone's share of the flux. Edges sharper than kSoftEdge blocks are softened
//            to about that width: a block's mean over a step is a slope, which locates the step
//   Cosine   cos^n theta, c: n
//   Optics   the rig's optics, c: its focal length and distance [m]
//   Held     the rig's beam unchanged, with edges as soft as blocks make them
//
// w   direction in the lamp's frame, a unit vector: along, across, axis (rig/beam/beam.h)
//
// The prior of a table is Gaussian, on its second differences, 0 +- kRoughness (a P-spline: P. H.
// C. Eilers and B. D. Marx, Statistical Science 11, 1996, 89), so that it continues evenly where no
// image constrains it; that of all others on their logarithms, the rig's +- spread(). Since the
// powers carry the brightness, the mean of a table over the part that it lights is held, and so is
// the sum of all cones' shares.
//
// Derivatives of Table and Cosine are exact, those of the others central differences of a closed
// form, accurate to kSteps^2. De Boor's splines in their form for even knots: H. Prautzsch, W.
// Boehm and M. Paluszny, Bezier and B-Spline Techniques (2002), 8.7.
#pragma once

#include "rig/beam/beam.h"

#include <Eigen/Core>

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace aphotic {

// A cubic step of this width has the variance of the even one over a block: sqrt((1/12) / (1/20)).
inline constexpr double kSoftEdge = 1.29;
inline constexpr double kKnot_rad = 0.0524;  // 3 degrees
inline constexpr double kRoughness = 0.3;
inline constexpr double kShapeSpread = 0.3;
inline constexpr double kMillimetres = 1e3;  // per metre; rigs give lenses in millimetres
// Between the angles of a fitted table.
inline constexpr double kFittedStep_deg = 0.5;

enum class FitBeamKind { Table, Cones, Cosine, Optics, Held };
// Those that may be asked for.
inline const std::map<std::string, FitBeamKind> kFitBeams{{"table", FitBeamKind::Table},
                                                          {"cones", FitBeamKind::Cones},
                                                          {"cosine", FitBeamKind::Cosine},
                                                          {"optics", FitBeamKind::Optics}};

// In one direction.
struct BeamValue {
    double intensity = 0.0;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  // over w, along the sphere
    // Over the coefficients from `first` on; the others have no effect there.
    std::size_t first = 0;
    std::vector<double> by{};
};

// Rows of R x - r of variance 1, x being the coefficients less the rig's of a table, otherwise the
// logarithms of their quotients.
struct BeamPrior {
    Eigen::MatrixXd rows;
    Eigen::VectorXd means;
};

class FitBeam {
  public:
    // Starts from the beam, as far as the kind allows. block_rad: the angle that a block subtends.
    // An InputError if the beam has no such coefficients.
    FitBeam(FitBeamKind kind, const Beam& beam, double widest_rad, double block_rad);

    [[nodiscard]] FitBeamKind kind() const { return kind_; }
    [[nodiscard]] const std::vector<double>& coefficients() const { return c_; }
    [[nodiscard]] double& coefficient(std::size_t which) { return c_[which]; }
    // Except for a table: each coefficient's name in the rig.
    [[nodiscard]] std::vector<std::string> names() const;
    [[nodiscard]] const BeamPrior& prior() const { return prior_; }
    // Except for a table: the prior's, of each logarithm.
    [[nodiscard]] double spread() const;

    void at(const Eigen::Vector3d& w, BeamValue& value) const;

    // Whether it is fitted and rotationally symmetric.
    [[nodiscard]] bool is_round() const {
        return kind_ != FitBeamKind::Optics && kind_ != FitBeamKind::Held;
    }
    [[nodiscard]] double widest_rad() const { return widest_rad_; }
    // In a rig's form: scaled to a flux of 1, and that flux.
    struct Fitted {
        Beam beam;
        double flux = 0.0;
    };
    [[nodiscard]] Fitted fitted() const;

  private:
    void begin_table();
    void table_at(const Eigen::Vector3d& w, BeamValue& value) const;
    void cosine_at(const Eigen::Vector3d& w, BeamValue& value) const;
    [[nodiscard]] double table_intensity_at(double theta_rad) const;
    // With these coefficients, as a beam of the rig's kinds: for cones and optics.
    [[nodiscard]] double intensity_with(const std::vector<double>& c,
                                        const Eigen::Vector3d& w) const;
    [[nodiscard]] BeamOptics optics_with(const std::vector<double>& c) const;

    FitBeamKind kind_;
    double widest_rad_;
    Beam beam_;                // the rig's
    std::vector<Beam> parts_;  // its cones, softened, of a flux of 1, or of their shares if held
    std::vector<double> c_;
    BeamPrior prior_;
};

}  // namespace aphotic
