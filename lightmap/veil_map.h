// SPDX-License-Identifier: BSD-3-Clause
//
// The veil that each pixel of a lightmap sees: rig/veil.h's nodes, with the signal over the path's
// length instead of the exponential,
//
//   V_c = sum_s sum_n sum_i weight_i[n] T_sic(path[n]),
//   T_sic(l) = Phi_s int f_s b_i Q_c exp(-c' l) dlambda
//
// s, i  strobe and scatterer          f_s, Phi_s  its lamp spectrum and power
// Q_c   response of channel c         c', b_i     spectral/water.h
//
// T is tabulated once per water as the floor's is (path_table.h), for paths from the lamp straight
// to the camera to the longest that the floor's direct light takes, or where less than
// e^-kVeilDepth is left.
//
// Behind a port all wavelengths take the ray of the middle index: the veil changes little over the
// few pixels of dispersion.
#pragma once

#include "lightmap/path_table.h"
#include "rig/path_range.h"
#include "rig/rig.h"
#include "rig/veil.h"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace aphotic {

class VeilMap {
  public:
    // Of water that scatters. direct: what the floor's tables serve. error: relative, of the
    // spectral integral and its table.
    VeilMap(const Rig& rig, const PathRange& direct, double error);

    // R, G, B planar of these rows of the image.
    void rows_into(
        const Sled& sled, int first_row, int count, int threads, std::vector<float>& samples) const;

    // At the centre of a pixel, without interpolation.
    using Signal = std::array<double, kChannels>;
    [[nodiscard]] Signal at(const Rig& flown, int column, int row, VeilNodes& nodes) const;

  private:
    [[nodiscard]] Signal table_at(const std::vector<float>& table, double path_m) const;

    Rig rig_;
    Veil veil_;
    double lambda_nm_ = 0.0;  // whose rays are taken
    PathSteps steps_;
    std::vector<std::vector<float>> tables_;  // by lamp spectrum and scatterer
    std::vector<std::size_t> first_table_;    // by strobe
};

}  // namespace aphotic
