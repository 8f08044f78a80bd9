// SPDX-License-Identifier: BSD-3-Clause
//
// The floor's signal over the light's path length, for every lamp of a rig (path_table.h):
//
//   T_sjc(l) = int Phi_s rho Q_c l_j(n) exp(-K l) dlambda
//
// s    lamp spectrum Phi_s             rho  the floor's reflectance; 1 for its highlight
// Q_c  response of channel c           l_j  share of an index node (index_nodes.h)
//
// Behind a port also by wavelength, for light whose rays may not be interpolated over the index.
#pragma once

#include "light/path_table.h"
#include "rig/rig.h"
#include "spectral/bands.h"

#include <array>
#include <cstddef>
#include <vector>

namespace aphotic {

// For one lamp spectrum.
struct LampSignal {
    std::vector<std::vector<float>> diffuse;    // by index node
    std::vector<std::vector<float>> highlight;  // the same; empty if the floor has no highlight
    SpectralSum dispersed_diffuse;              // by wavelength, behind a port
    SpectralSum dispersed_highlight;
};

// The nodes from which rays behind a port are interpolated at any index: they vary smoothly with
// the index, but glass and water disperse light by different laws. Nine nodes are accurate to 1e-9
// of a slope, five to 1e-7.
inline constexpr std::size_t kRayNodes = 9;

struct SignalTable {
    PathSteps steps;
    std::size_t grid_size = 0;                // wavelengths
    std::vector<std::size_t> lamp_of_strobe;  // of `lamps`
    std::vector<LampSignal> lamps;
    std::vector<double> ray_nodes_nm;                       // of dispersed light
    std::vector<std::array<double, kRayNodes>> ray_shares;  // by wavelength
};

// error: relative, of the spectral integral and of the table. Without paths there is no light.
[[nodiscard]] SignalTable signal_table(const Rig& rig, const PathRange& paths, double error);

// The distinct lamp spectra, and the index of each strobe's.
[[nodiscard]] std::vector<const Spectrum*> lamps_of(const Rig& rig,
                                                    std::vector<std::size_t>& by_strobe);

using Signals = std::array<double, kChannels>;

}  // namespace aphotic
