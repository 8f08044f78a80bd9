// SPDX-License-Identifier: BSD-3-Clause
//
// The veil that each pixel of a lightmap sees: light/veil.h's nodes, with the signal over the
// path's length instead of the exponential,
//
//   V_c = sum_s sum_n sum_i weight_i[n] T_sic(path[n]),
//   T_sic(l) = Phi_s int f_s b_i Q_c exp(-K l) dlambda
//
// s, i  strobe and scatterer          f_s, Phi_s  its lamp spectrum and power
// Q_c   response of channel c         K, b_i      spectral/water.h
//
// T is tabulated once per water as the floor's is (path_table.h), for paths from the direct one
// between lamp and camera to the longest of the floor's direct light, or to where less than
// e^-kVeilDepth remains.
//
// Over an image the veil is painted by tiles (tile_image.h) of kVeilTile_px, each part of a beam
// (light/veil.h) separately, since an edge belongs to one part only. It is smooth except where the
// line of sight touches a beam's edge in the water or meets it on the floor. A polynomial is
// accepted if at each place between its points its error is at most a tenth of the tolerance
// relative to the signal, floor's light and veil, and if its last degrees are small, too
// (tile_fit.h). So that no light is missed between a tile's places, neither the planes of lamp and
// sights nor the directions from the lamp to their ends turn over it by more than twice the width
// of the narrowest (steep_crease.h); near the lamp, planes turn about it.
//
// Behind a port the veil is that of a few rays, interpolated over the water's index
// (light/index_nodes.h).
#pragma once

#include "light/floor_light.h"
#include "light/path_range.h"
#include "light/path_table.h"
#include "light/tile_image.h"
#include "light/veil.h"
#include "rig/rig.h"
#include "spectral/bands.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace aphotic {

// Smaller in images with fewer than four along their longer side, down to the least: each tile has
// one thread.
inline constexpr int kVeilTile_px = 256;
inline constexpr int kLeastVeilTile_px = 32;
// The largest error of maps and renders, relative to the signal.
inline constexpr double kVeilOfSignal = 1e-4;
inline constexpr std::size_t kVeilPlanes = kTilePlanes;  // of one map, at most

using VeilGrid = std::vector<WeightedWavelength>;

class VeilMap {
  public:
    // For water that scatters. direct: the floor light's. error: relative, of the spectral integral
    // and its table. points: per panel (light/veil.h). The planes are R, G and B, followed by A of
    // light/veil.h at wavelengths that share their nodes: none behind a port, where each has its
    // own ray. Without signals, only A, along rays of one wavelength.
    VeilMap(const Rig& rig,
            const PathRange& direct,
            double error,
            unsigned points = kVeilMapPoints,
            std::span<const double> lambda_nm = {},
            bool has_signals = true);

    [[nodiscard]] std::size_t planes() const { return planes_; }

    // By plane, along the rays of a place of the image, to the floor or to the given distance.
    using Signal = PlaceSignals;
    [[nodiscard]] Signal at(const PlaceRays& rays,
                            VeilNodes& nodes,
                            std::optional<double> length_m = {}) const;

    // The planes of some rows for a camera with these rays. tolerance: of the sum with the floor's
    // light, or of the veil alone if there is none.
    void paint(const Sled& sled,
               const CameraRays& rays,
               const FloorLight* floor,
               double tolerance,
               int threads,
               const ImageRows& rows) const;

  private:
    friend class VeilTiles;

    void tabulate(const PathRange& paths, double error);
    void add(const VeilNodes& nodes, std::size_t strobe, std::size_t ray, Signal& sum) const;

    Rig rig_;
    Veil veil_;
    std::vector<double> widest_rad_;      // by part: the largest turn over a tile
    std::vector<double> index_nodes_nm_;  // of the rays used, in the order of PlaceRays
    std::size_t planes_ = 0;
    std::vector<VeilGrid> grids_;  // each of three planes
    PathSteps steps_;
    // By index node, lamp spectrum, scatterer and grid.
    std::vector<std::vector<float>> tables_;
    std::vector<std::size_t> lamp_of_strobe_;
};

}  // namespace aphotic
