// SPDX-License-Identifier: BSD-3-Clause
//
// Water in the reference, from the rig's description (the tables of spectral/water.h, the
// parameters of spectral/phase_function.h), without any formula of spectral/.
//
//   K = multiple (a + sum of b_i S_i(kLossCut)) + uniform_loss                   [1/m]
//   S_i(psi) = 2 pi int_psi^pi p_i(x) sin(x) dx      share deflected by more than psi
//
// by quadrature of p_i from the back, which excludes the forward peak; a formula is normalised, a
// table is scaled by its own integral. Fournier and Forand's formula is 0/0 at d = 1: it is
// computed in long double, and within kForandNear of that from six places around, to 1e-11.
//
// Light attenuated below e^-kBlackDepth is black: doubles end soon after, and Eigen's vectorised
// exponential never goes below e^-709.8.
#pragma once

#include "spectral/water.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace aphotic {

inline constexpr double kForandNear = 1e-4;
inline constexpr double kBlackDepth = 700.0;

// The share of light left at an optical depth.
[[nodiscard]] double light_left(double depth);
[[nodiscard]] Eigen::ArrayXd light_left(const Eigen::ArrayXd& depth);

class TracedPhase {
  public:
    explicit TracedPhase(const PhaseFunction& phase);

    [[nodiscard]] double at(double psi_rad) const;            // p  [1/sr]
    [[nodiscard]] double share_beyond(double psi_rad) const;  // S
    [[nodiscard]] const std::vector<double>& kinks_rad() const { return kinks_rad_; }

  private:
    PhaseFunction phase_;
    double scale_ = 1.0;             // of a table
    std::vector<double> kinks_rad_;  // a table's rows
};

class TracedWater {
  public:
    explicit TracedWater(const Water& water);

    [[nodiscard]] double loss_per_m(double lambda_nm) const;  // K
    // b_i, multiple included.
    [[nodiscard]] double scattering_per_m(std::size_t scatterer, double lambda_nm) const;

    [[nodiscard]] bool scatters() const { return !phases_.empty(); }
    // One for each scatterer; empty if the water does not scatter.
    [[nodiscard]] const std::vector<TracedPhase>& phases() const { return phases_; }
    // The share that a scatterer deflects by more than kLossCut.
    [[nodiscard]] double lost(std::size_t scatterer) const { return lost_[scatterer]; }

  private:
    Water water_;
    std::vector<TracedPhase> phases_;
    std::vector<double> lost_;
};

}  // namespace aphotic
