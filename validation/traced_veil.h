// SPDX-License-Identifier: BSD-3-Clause
//
// The veil in the reference: a strobe's light that the water scatters into the camera's ray,
//
//   A = Phi power sum_i b_i int p_i(psi) I(w) exp(-K (t + d)) / d^2 dt,     psi >= kVeilCut
//
// from t = 0, where the ray enters the water, to its end; the symbols are those of light/veil.h,
// whose formulas are not used. With x the angle at the lamp between its nearest point of the ray, h
// away at t = t_0, and the point at t,
//
//   dt / d^2 = dx / h,    t + d = t_0 + h tan(45 degrees + x/2),    psi = x + 90 degrees
//
// Over x, from edge to edge of the beam and of a table's rows, panels of Gauss and Kronrod are
// halved until the 15 and the 7 points of each agree to kVeilTolerance of the whole, for each
// scatterer and for the least and the largest K. Values between them are bracketed, so the points
// serve every wavelength.
//
// An emitter with a size is kVeilLamps x kVeilLamps lamps by Gauss's rule. A lamp on the ray is
// moved beside it by kVeilBeside_m, where its light is finite. Shadows of objects are omitted.
#pragma once

#include "rig/rig.h"
#include "validation/traced_beam.h"
#include "validation/traced_water.h"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace aphotic {

inline constexpr double kVeilTolerance = 1e-10;
inline constexpr unsigned kVeilLamps = 4;
inline constexpr double kVeilBeside_m = 1e-6;

// For one strobe: A = Phi power sum_n sum_i b_i light[i][n] exp(-K path_m[n]).
struct VeilPoints {
    std::vector<double> path_m;              // t + d
    std::vector<std::vector<double>> light;  // by scatterer  [1/(m sr)]
};

// A part of the camera's ray in water; length_m may be infinite.
struct VeilRay {
    Eigen::Vector3d origin_m;
    Eigen::Vector3d direction;  // unit
    double length_m;
};

struct Losses {
    double least_per_m;
    double most_per_m;
};

class TracedVeil {
  public:
    TracedVeil(const Rig& rig, const TracedWater& water);

    void trace(std::size_t strobe,
               const VeilRay& ray,
               const Losses& losses,
               VeilPoints& points) const;

    // A for all strobes.
    [[nodiscard]] double radiance(const VeilRay& ray, double lambda_nm) const;

  private:
    struct Lamp {
        Eigen::Vector3d position_m;
        double share;
    };
    struct Source {
        TracedBeam beam;
        std::vector<Lamp> lamps;
        double power;
        Spectrum spectrum;
    };
    struct Work;

    void add_lamp(const Source& source,
                  const Lamp& lamp,
                  const VeilRay& ray,
                  const Losses& losses,
                  VeilPoints& points) const;

    TracedWater water_;
    std::vector<Source> sources_;
    std::vector<double> kinks_rad_;  // of the phase functions
};

}  // namespace aphotic
