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
// T is tabulated once per water as the floor's is (path_table.h), for paths from the lamp straight
// to the camera to the longest that the floor's direct light takes, or where less than
// e^-kVeilDepth is left.
//
// The veil is smooth over the image but where the sight touches a beam's edge in the water or meets
// it on the floor. So it is computed on a grid of nodes at most kVeilCell_px apart, and in between
// it is the cubic through the four next of each way. Where the nodes' third differences are over
// kVeilBend of the signal, floor's light and veil, the veil itself is computed at five places of
// the cell: if the cubic is off at one by more than kVeilOff of the signal, the cell gets a grid of
// its own, four times as fine, and its parts the same test; those that fail are computed pixel by
// pixel. All that by the parts of light/veil.h, for edges of one are none of the others'. It
// depends on the cell alone: neither threads nor the rows that are asked for change a bit.
//
// Behind a port the veil is that of a few rays, interpolated over the water's index
// (light/index_nodes.h).
#pragma once

#include "light/path_range.h"
#include "light/path_table.h"
#include "light/veil.h"
#include "rig/geometry.h"
#include "rig/rig.h"
#include "spectral/bands.h"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace aphotic {

inline constexpr double kVeilCell_px = 16.0;
// At least, along the longer side, down to a pixel each.
inline constexpr double kVeilCells = 85.0;
inline constexpr int kVeilParts = 4;  // of a cell, each way
inline constexpr double kVeilOff = 4e-5;
inline constexpr double kVeilBend = 8e-5;
// What maps are off by at most, as measured (docs/lightmaps.md): away from the middles, too.
inline constexpr double kVeilOfSignal = 1e-4;
inline constexpr std::size_t kVeilPlanes = 12;  // of one map, at most

class VeilMap {
  public:
    // Of water that scatters. direct: the floor's light's. error: relative, of the spectral
    // integral and its table. points: of a panel (light/veil.h).
    VeilMap(const Rig& rig,
            const PathRange& direct,
            double error,
            unsigned points = kVeilMapPoints);

    // Of R, G and B, and beside them A of light/veil.h at wavelengths, a plane each, which share
    // their nodes: none behind a port, where each has a ray of its own.
    VeilMap(const Rig& rig,
            const PathRange& direct,
            double error,
            unsigned points,
            std::span<const double> lambda_nm);

    // A alone, at wavelengths that all have the ray of index_nm.
    VeilMap(const Rig& rig,
            const PathRange& direct,
            double error,
            unsigned points,
            std::span<const double> lambda_nm,
            double index_nm);

    [[nodiscard]] std::size_t planes() const { return planes_; }

    // Rows whose floor must be known for these, which they are among.
    struct Rows {
        int first = 0;
        int count = 0;
    };
    [[nodiscard]] Rows rows_for(Rows wanted) const;

    // The planes of rows that rows_for() gave, beside the floor's signal, which has as many; none:
    // as exact as the veil alone asks.
    void rows_into(const Sled& sled,
                   Rows rows,
                   const std::vector<float>& floor,
                   int threads,
                   std::vector<float>& samples) const;

    // At a place of the image, without interpolation; pixels' centres are at .5. By plane.
    using Signal = std::array<double, kVeilPlanes>;
    [[nodiscard]] Signal at(const Rig& flown, double column, double row, VeilNodes& nodes) const;
    // Where the pixel sees so far, not to the floor.
    [[nodiscard]] Signal at(
        const Rig& flown, double column, double row, double length_m, VeilNodes& nodes) const;

  private:
    // Nodes along one way, from the first pixel's centre to the last's.
    struct Axis {
        Axis(int count, double cell_px);
        [[nodiscard]] double node_px(double node) const { return 0.5 + node * apart_px; }
        [[nodiscard]] int first_pixel(int cell) const;  // of all that are in no cell before
        int pixels;
        int cells;
        double apart_px;
    };
    class Strip;

    // Where a rig flies.
    struct Flight {
        explicit Flight(const Rig& flown) : rig(flown), floor(floor_plane(flown.sled)) {}
        const Rig& rig;
        Plane floor;
    };
    using Grid = std::vector<WeightedWavelength>;

    VeilMap(const Rig& rig, unsigned points, std::vector<double> index_nodes_nm);
    void add_grids_of(std::span<const double> lambda_nm);
    void tabulate(const PathRange& paths, double error);
    // Where pixels' centres are nodes, nothing is interpolated, and beams are taken whole.
    [[nodiscard]] bool has_node_at_each_pixel() const {
        return across_.apart_px <= 1.0 && down_.apart_px <= 1.0;
    }
    [[nodiscard]] Signal at_sights(const Flight& flight,
                                   double column,
                                   double row,
                                   std::optional<double> length_m,
                                   VeilNodes& nodes) const;
    // Of a part of a strobe's beam.
    [[nodiscard]] Signal at_part(
        const Flight& flight, std::size_t part, double column, double row, VeilNodes& nodes) const;
    void add(const VeilNodes& nodes, std::size_t strobe, std::size_t index_node, Signal& sum) const;

    Rig rig_;
    Veil veil_;
    Axis across_;
    Axis down_;
    std::vector<double> index_nodes_nm_;  // whose rays are taken
    std::size_t planes_ = 0;
    std::vector<Grid> grids_;  // each of three planes
    PathSteps steps_;
    // By index node, lamp spectrum and scatterer; by step, grid, and as path_table() has it.
    std::vector<std::vector<float>> tables_;
    std::vector<std::size_t> lamp_of_strobe_;
};

}  // namespace aphotic
