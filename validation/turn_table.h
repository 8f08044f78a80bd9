// SPDX-License-Identifier: BSD-3-Clause
//
// The angles by which a Monte Carlo scatters light, and their probabilities: the phase functions of
// all scatterers at one wavelength, weighted by their scattering, from a least angle on.
//
//   P(psi)  density of directions,  2 pi int_least^pi P sin(psi) dpsi = 1     [1/sr]
//
// 2 pi P sin(psi) is a straight line between nodes in a constant ratio, so that samples follow
// exactly the density() returned, and both are within 1e-4 of the functions.
#pragma once

#include "validation/traced_water.h"

#include <vector>

namespace aphotic {

class TurnTable {
  public:
    // At one wavelength. least_rad: above 0.
    TurnTable(const TracedWater& water, double lambda_nm, double least_rad);

    // Scattering by least_rad or more  [1/m]
    [[nodiscard]] double scattering_per_m() const { return scattering_per_m_; }
    [[nodiscard]] double least_rad() const { return angle_rad_.front(); }

    [[nodiscard]] double density(double psi_rad) const;  // P; 0 below the least
    // The angle below which the share `uniform` of all scattering lies; 0 <= uniform < 1.
    [[nodiscard]] double quantile(double uniform) const;

  private:
    double scattering_per_m_ = 0.0;
    double log_step_ = 0.0;
    std::vector<double> angle_rad_;
    std::vector<double> line_;   // 2 pi P sin(psi) at each angle
    std::vector<double> share_;  // below each angle
};

}  // namespace aphotic
