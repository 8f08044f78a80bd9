// SPDX-License-Identifier: BSD-3-Clause
//
// The lamp light that arrives over a path in water, and its dependence on the water:
//
//   T_c(l)  = int Phi rho e^(q1 u + q2 u^2) Q_c exp(-K l) dlambda    by way of the floor
//   V_ic(l) = int Phi b_i Q_c exp(-K l) dlambda                      by way of scatterer i
//
// rho    the rig's floor       q1, q2   relative redness of the images' floor
// u      wavelength, from -1 at the short end of the camera's range to 1 at the long end
//
// A floor of another colour changes how fast a channel loses light with the path, not only its
// level: a redder floor has its red at longer wavelengths, which water absorbs more.
//
// Versions are the light itself, then its derivatives over the fitted numbers of the rig's [water],
// then over q1 and q2. All are tables of light/path_table.h, with bands of a nanometre. Derivatives
// over the water are central differences of the whole rig, read with the number larger and smaller
// by kWaterStep, so any number of [water] is supported; their error is of order kWaterStep^2.
#pragma once

#include "light/path_table.h"
#include "rig/file/rig_text.h"
#include "rig/rig.h"

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace aphotic {

inline constexpr double kWaterStep = 1e-3;  // relative
inline constexpr double kFitTableError = 1e-6;

// A fitted number of [water], with its value there.
struct WaterNumber {
    std::string key;  // water.multiple
    double value = 0.0;
};

using FloorTint = std::array<double, 2>;  // q1, q2

class PathLight {
  public:
    // For every strobe of the rig, with these numbers in its [water].
    PathLight(const RigText& rig,
              const std::vector<WaterNumber>& numbers,
              const FloorTint& tint,
              const PathRange& paths);

    [[nodiscard]] std::size_t versions() const { return versions_; }
    [[nodiscard]] std::size_t scatterers() const { return scatterers_; }
    [[nodiscard]] const Rig& rig() const { return rig_; }

    [[nodiscard]] PathSignal floor(std::size_t strobe, std::size_t version, double path_m) const;
    [[nodiscard]] PathSignal veil(std::size_t strobe,
                                  std::size_t version,
                                  std::size_t scatterer,
                                  double path_m) const;
    // p_i, and its derivatives.
    [[nodiscard]] double phase(std::size_t version, std::size_t scatterer, double psi_rad) const;
    [[nodiscard]] double longest_m() const;

  private:
    void add_version(const std::vector<const Rig*>& rigs,
                     const std::vector<double>& shares,
                     const FloorTint& tint,
                     int power_of_u);

    Rig rig_;
    std::size_t versions_ = 0;
    std::size_t scatterers_;
    PathSteps steps_;
    std::vector<std::vector<float>> floor_;   // by version and strobe
    std::vector<std::vector<float>> veil_;    // by version, strobe and scatterer
    std::vector<std::vector<double>> phase_;  // by version and scatterer, over even steps of psi
};

}  // namespace aphotic
