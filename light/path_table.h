// SPDX-License-Identifier: BSD-3-Clause
//
// The signal of light over its path length, tabulated once per water, lamp and floor.
//
//   T_c(l) = int f(lambda) Q_c(lambda) exp(-K(lambda) l) dlambda  =  sum_j w_cj exp(-K_j l)
//
// T_c  signal of channel c      l  lamp to floor to camera, in water [m]      K  loss [1/m]
// f    lamp spectrum times reflectance      w_cj  f Q_c at a node of the grid, times its weight
//
// Between even steps of h the table is the cubic that matches T and T' at both ends. Its error is
// at most h^4/384 of the fourth derivative, sum_j w_cj K_j^4 exp(-K_j l). While no w_cj is
// negative, each derivative's ratio to T only falls as the path grows, since the light that fades
// fastest is lost first, and over a step T falls by no more than exp(h m_1). So everywhere
//
//   |error| / T  <=  h^4/384 m_4 exp(h m_1),        m_p = sum_j w_cj K_j^p e_j / sum_j w_cj e_j
//
// with e_j = exp(-K_j l) at the shortest path: path_steps derives h from it. In clear water T is
// one number and one step suffices. With K = 0.5/m and an error of 1e-6, h is 0.28 m.
#pragma once

#include "light/path_range.h"
#include "rig/rig.h"
#include "spectral/bands.h"
#include "spectral/sensor.h"

#include <Eigen/Core>

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace aphotic {

// T_c as a sum over the nodes of a spectral grid.
struct SpectralSum {
    Eigen::ArrayXd K_per_m;   // by node
    Eigen::ArrayXXd weights;  // by node and channel
};

// Over the wavelengths of a grid, for one lamp's light.
using LightOf = std::function<double(double lambda_nm)>;
[[nodiscard]] SpectralSum spectral_sum(const Water& water,
                                       std::span<const WeightedWavelength> grid,
                                       const LightOf& light);

struct PathSteps {
    double first_m = 0.0;
    double steps_per_m = 0.0;
    int count = 0;
};

// The fewest steps that meet the relative error for every channel of the sum, whose weights are not
// negative.
[[nodiscard]] PathSteps path_steps(const SpectralSum& sum, const PathRange& paths, double error);

// Per step, four vectors of (R, G, B, 0): the cubic's coefficients in t, 0 to 1 over the step, so
// that T = c0 + t (c1 + t (c2 + t c3)).
inline constexpr std::size_t kTableLanes = 4;
inline constexpr std::size_t kTableOrder = 4;
inline constexpr std::size_t kTableStride = kTableLanes * kTableOrder;

// Weights of either sign.
[[nodiscard]] std::vector<float> path_table(const SpectralSum& sum, const PathSteps& steps);

// T and T' [1/m] of each channel; past either end, by extrapolating the cubic there.
struct PathSignal {
    std::array<double, kChannels> value{};
    std::array<double, kChannels> slope{};
};
[[nodiscard]] PathSignal signal_at(const std::vector<float>& table,
                                   const PathSteps& steps,
                                   double path_m);

}  // namespace aphotic
