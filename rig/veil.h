// SPDX-License-Identifier: BSD-3-Clause
//
// The veil: light that the water scatters into the view, on its way from a lamp to the floor or
// beside it. Single scattering, along the ray of a pixel:
//
//   A(lambda) = Phi(lambda) sum_i b_i(lambda) int p_i(psi) I(w) exp(-c' (t + d)) / d^2 dt
//
// t         along the ray, from where it enters the water to what it meets      [m]
// d, w      from the lamp to that point of the ray: distance [m] and direction
// psi       the angle by which light is turned there, kVeilCut or more
// b_i, p_i  of each scatterer; c' what the veil loses (spectral/water.h)
// I         the beam's intensity (rig/beam.h)                                   [1/sr]
//
// With h the lamp's distance from the ray, t_0 its foot point on it, and phi the angle at the lamp
// from there,
//
//   t = t_0 + h tan(phi),   d = h / cos(phi),   dt/d^2 = dphi/h,   psi = phi + 90 degrees
//
// so that the integrand is smooth, however near the lamp is to the ray, and the lamp's direction is
// linear in cos(phi) and sin(phi): a beam's edge at gamma about the axis k crosses the ray at
//
//   phi = atan2(k.u, k.e) +- acos(cos(gamma) / sqrt((k.e)^2 + (k.u)^2))
//
// with u the ray's direction and e that from the lamp to the foot point. Between the edges and the
// cut Gauss-Legendre's rule takes panels of up to kVeilPanelRad. The nodes depend on no
// wavelength: whoever has them has every wavelength, and the signal as well, by a table over the
// path's length.
//
// An emitter of a size is 3 x 3 lamps by Gauss-Legendre's rule. Shadows of objects in the veil are
// left out.
#pragma once

#include "rig/geometry.h"
#include "rig/rig.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace aphotic {

inline constexpr double kVeilPanelRad = 0.35;
inline constexpr unsigned kVeilPoints = 8;  // of a panel
// Light that the water leaves less than e^-kVeilDepth of is left out.
inline constexpr double kVeilDepth = 40.0;

// What one strobe of power 1 adds: A = Phi sum_n sum_i b_i weight[i][n] exp(-c' path_m[n]).
struct VeilNodes {
    std::vector<double> path_m;                 // t + d
    std::vector<std::vector<double>> weight{};  // by scatterer  [1/(m sr)]

    void clear();
};

class Veil {
  public:
    // points: of a panel; another number than kVeilPoints is for those who measure the error.
    explicit Veil(const Rig& rig, unsigned points = kVeilPoints);

    // Over the whole length of the ray, which may be infinite; adds nothing to nodes that are
    // there, it replaces them. Thread safe.
    void nodes(std::size_t strobe, const WaterRay& ray, double length_m, VeilNodes& nodes) const;

    // A of all strobes at one wavelength, powers included.
    [[nodiscard]] double radiance(const WaterRay& ray, double length_m, double lambda_nm) const;

  private:
    struct Lamp {
        Eigen::Vector3d position_m;
        double share;
    };

    Rig rig_;
    std::vector<std::vector<Lamp>> lamps_;  // by strobe
    std::vector<BeamFrame> frames_;
    std::vector<std::vector<double>> edges_rad_;
    double longest_m_ = 0.0;      // path beyond which nothing is left
    std::vector<double> points_;  // of the rule, on 0 to 1
    std::vector<double> weights_;
};

// The camera's ray of a pixel's centre in water, and how far it goes to the bare floor; infinite
// when it does not come down on it.
struct VeilSight {
    WaterRay ray;
    double length_m = 0.0;
};
[[nodiscard]] VeilSight sight_of(const Rig& rig, double column, double row, double lambda_nm);

}  // namespace aphotic
