// SPDX-License-Identifier: BSD-3-Clause
//
// A beam's data sheet figures, and the beam as a table for other programs.
//
//   flux     integral of I over all directions: 1, less the loss in a window
//   largest  of I, on a grid of a tenth of a degree                      [1/sr]
//   FWHM     in a plane through the axis, the angle between the outermost directions on either side
//            where I is half of its largest value in that plane
//   widest   the largest angle off the axis with light, on that grid
#pragma once

#include "rig/beam/beam.h"
#include "rig/beam/photometric_file.h"

namespace aphotic {

struct BeamFigures {
    double flux = 0.0;
    double largest_per_sr = 0.0;
    double fwhm_along_rad = 0.0;
    double fwhm_across_rad = 0.0;
    double widest_rad = 0.0;
};

[[nodiscard]] BeamFigures figures_of(const Beam& beam);

// I in the plane of the axis and along or across; theta from -180 to 180 degrees, negative to aft
// and port for a lamp that points down.
enum class BeamPlane { Along, Across };
[[nodiscard]] double intensity_in_plane(const Beam& beam, BeamPlane plane, double theta_rad);

// A table with the beam's light, for a lamp of given flux in lumens: the beam's own table, if it
// has one, in water and not rotated. Others are sampled every kExportStep_deg off the axis and
// every kExportTurn_deg about it; between nodes it errs by `error` of the largest intensity, found
// in the middle of every cell.
inline constexpr double kExportStep_deg = 1.0;
inline constexpr double kExportTurn_deg = 5.0;
struct ExportedBeam {
    PhotometricFile file;
    double error = 0.0;
};
[[nodiscard]] ExportedBeam exported(const Beam& beam, double luminous_flux_lm);

}  // namespace aphotic
