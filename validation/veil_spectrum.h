// SPDX-License-Identifier: BSD-3-Clause
//
// The reference's veil (traced_veil.h) of one pixel at many wavelengths. For one ray it is a sum
// over the points of the integral,
//
//   A(lambda) = sum_s Phi_s power_s sum_i b_i sum_n light_sin exp(-K path_n)
//
// The exponentials of points within kSmoothDepth of the nearest, (K_most - K_least) (path_n -
// path_0), are summed only at kLossNodes Chebyshev nodes of K and interpolated, with an error below
// 1e-12 of that sum; farther points are summed at each wavelength.
//
// Behind a port each wavelength has its own ray. The rays diverge little and smoothly, so the veil
// is interpolated over the wavelength that refracts the ray, with the water's properties at each
// wavelength, between 3, 5, 9 and 17 rays, until two successive results agree to kVeilOverRays
// everywhere. If an edge of a beam or of an object lies between the rays, they do not agree, and
// every ray is traced.
#pragma once

#include "rig/rig.h"
#include "validation/traced_veil.h"

#include <Eigen/Core>

#include <cstddef>
#include <functional>
#include <vector>

namespace aphotic {

inline constexpr double kVeilOverRays = 1e-9;
inline constexpr double kSmoothDepth = 8.0;
inline constexpr int kLossNodes = 24;

class VeilSpectrum {
  public:
    // lambda_nm: in any order.
    VeilSpectrum(const Rig& rig, const TracedWater& water, const std::vector<double>& lambda_nm);

    // With one ray for all wavelengths.
    [[nodiscard]] Eigen::ArrayXd along(const VeilRay& ray) const;

    // With rays by wavelength: ray(j) is that of lambda_nm[j].
    [[nodiscard]] Eigen::ArrayXd along(const std::function<VeilRay(std::size_t)>& ray) const;

  private:
    // Rays of some wavelengths, and their weights in the veil of every wavelength.
    struct Rays {
        std::vector<std::size_t> wavelengths;
        Eigen::ArrayXXd shares;  // wavelength, ray
    };

    void place_rays(const std::vector<double>& lambda_nm);

    TracedVeil veil_;
    Eigen::ArrayXd loss_per_m_;
    std::vector<std::vector<Eigen::ArrayXd>> light_;  // by strobe, scatterer: Phi power b
    Eigen::ArrayXd nodes_per_m_;                      // of K; empty for few wavelengths
    Eigen::ArrayXXd shares_of_nodes_;                 // wavelength, node
    std::vector<Rays> rays_;                          // each finer than the previous one
};

}  // namespace aphotic
