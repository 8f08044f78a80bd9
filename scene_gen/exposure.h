// SPDX-License-Identifier: BSD-3-Clause
//
// A bound of a frame's brightness, and the power of two that scales its light.
//
// POV-Ray's EXR holds half floats: relative step 2^-11 from 2^-14 to 65504, coarser below, inf
// above. The light of each wavelength is multiplied by 2^e, chosen so that the brightest pixel is
// at about 2^kTargetLog2 or a few octaves below; the integrator divides by it again, exactly. A
// dark red wavelength thus has the same precision as a bright blue one.
//
//   e = floor(kTargetLog2 - log2 L_max)
//
// L_max  close bound of the radiance in view at power-of-two scale 0, from the rig's closed
//        form on a coarse grid of the image, with every cone and highlight widened by the
//        grid's step
//        [unit of the lamp's spectrum / (m^2 sr)]
//
// An object counts with all strobes that may light it at once, each at its least distance, at
// normal incidence, and mirrored if the object has a highlight. That is more than any of its points
// can receive, so it needs no grid.
//
// The factor of four between 2^kTargetLog2 and the largest half float is the grid's margin.
#pragma once

#include "rig/rig.h"

#include <vector>

namespace aphotic {

inline constexpr int kTargetLog2 = 14;

// Upper bound of the radiance that the camera can see, per wavelength.
class RadianceBound {
  public:
    explicit RadianceBound(const Rig& rig);

    // Zero if no strobe lights anything in view at this wavelength.
    [[nodiscard]] double at(double lambda_nm) const;

  private:
    // One strobe's light on one point: path length, and the two reflections' factors.
    struct Lit {
        std::size_t strobe;
        double path_m;
        double diffuse_per_m2;
        double specular_per_m2;
    };
    struct LitPoint {
        const Spectrum* reflectance;  // of the rig's
        std::vector<Lit> lit;
    };

    // neighbours_m: the neighbouring grid points, between which light may peak.
    void add_point(const Eigen::Vector3d& point_m,
                   double camera_leg_m,
                   const std::vector<Eigen::Vector3d>& neighbours_m);
    void add_object(const Object& object);

    const Rig& rig_;
    std::vector<LitPoint> points_;
};

// e for a bound; brightest_colour is the largest colour value in the scene at e = 0, kept within
// POV-Ray's single-precision range. 0 for a bound of 0, and never beyond a manifest's limit
// (spectral/manifest.h).
[[nodiscard]] int exposure_log2(double radiance_bound,
                                double brightest_colour,
                                int target_log2 = kTargetLog2);

}  // namespace aphotic
