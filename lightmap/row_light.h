// SPDX-License-Identifier: BSD-3-Clause
//
// The inner loops of a lightmap: the rays of some pixels of a row, and the light of one lamp on
// what they see. Arrays of one quantity each, without branches, for compilers to vectorise.
//
// A ray starts at o and goes along D, whose z is 1. With `down` the unit vertical, H the height of
// o over the floor and w = down . D, it meets the floor at P = o + D H/w. From a lamp at s,
// height h over the floor, with axis a, the light comes along
//
//   V = w (P - s) = w (o - s) + H D
//
// a vector that stays finite towards the horizon, and everything follows from it:
//
//   d = |V|/w     cos(theta) = V.a/|V|     cos(i) = h w/|V|     r = |D| H/w
//   cos(theta) cos(i) / d^2 = h w^3 (V.a) / |V|^4
//
// and for the highlight, with m the ray mirrored at the floor and l the way to the lamp,
//
//   m.l = (2 w^2 h - D.V) / (|D| |V|)
//
// For any beam, I = intensity * reach / |V| (beam_light.h), where cones have reach = V.a. So
// I cos(i) / d^2 = intensity * reach h w^3 / |V|^4.
//
// Through a flat port, (u, v) the slopes of the pixel's ray in air, D = (u a, v a, 1) and
// o = (u b, v b, distance + thickness), for tan = sin/cos on both sides of Snell's law gives
//
//   a = 1/sqrt(n_w^2 + (n_w^2 - 1) q)     b = distance + thickness/sqrt(n_g^2 + (n_g^2 - 1) q)
//
// with q = u^2 + v^2. Rays of other lenses and ports come from a table (ray_table.h). What is a
// small difference of large numbers, w towards the horizon, V.a at the end of a cone of 90 degrees,
// and which side of a beam's edge a pixel is on, is done in double precision, products in float.
//
// Over the few pixels of a block the path hardly changes. So nearly all of them are in one step of
// the table or in two, whose cubics need no look-up pixel by pixel.
#pragma once

#include "light/index_nodes.h"
#include "light/path_table.h"
#include "lightmap/beam_light.h"
#include "lightmap/ray_table.h"
#include "lightmap/row_block.h"
#include "lightmap/row_fit.h"
#include "rig/geometry.h"
#include "rig/rig.h"

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace aphotic {

// What is the same for all rays of a map at one index.
struct RayTerms {
    int width_px = 0;
    double slope_per_px = 0.0;
    double middle_column = 0.0;  // of the image, where v is 0
    double middle_row = 0.0;
    double distance_m = 0.0;  // of the port; all 0 and indices 1 without one
    double thickness_m = 0.0;
    double glass_index = 1.0;
    double water_index = 1.0;
    Eigen::Vector3d down;
    double floor_m = 0.0;                   // from the pupil along `down`
    std::shared_ptr<const RayTable> table;  // of other cameras, in place of all but these two
};

// table: that of the rig at this wavelength.
[[nodiscard]] RayTerms ray_terms(const Rig& rig,
                                 const Plane& floor,
                                 double lambda_nm,
                                 std::shared_ptr<const RayTable> table);

struct RayBlock {
    bool is_in_order = true;  // those of neighbours
    double o_z = 0.0;
    RowBlock<double> D_x;
    RowBlock<double> D_y;
    RowBlock<double> o_x;
    RowBlock<double> o_y;
    RowBlock<double> ahead;  // where the water begins on D from o, of a table's ports
    RowBlock<double> H;
    RowBlock<double> w;         // 1 where the ray sees nothing
    RowBlock<float> per_w;      // 1/w
    RowBlock<float> w3;         // w^3; 0 where it sees nothing, or the row has ended
    RowBlock<float> leg_steps;  // r in steps of the table, less the place of its start
};

// The pixels of a block: neighbours, or the samples of kSampledBlocks blocks (row_fit.h). A row's
// last block ends with the row where samples are taken, for there may be no floor beyond.
struct ColumnBlock {
    RowBlock<double> v;       // the slope of each in air
    RowBlock<int> column;     // and its number
    int count = kRowBlock;    // in the image
    bool is_in_order = true;  // neighbours
};
[[nodiscard]] ColumnBlock neighbours(const RayTerms& terms, int first_column);
inline constexpr std::size_t kSampledBlocks = kBlockCount / kFitSamples;
[[nodiscard]] int first_sampled_column(const RayTerms& terms, int block);
[[nodiscard]] ColumnBlock samples_of_blocks(const RayTerms& terms, int first_block);
// As many as there are, up to kRowBlock; the rest of the block repeats the last.
[[nodiscard]] ColumnBlock some_columns(const RayTerms& terms, std::span<const int> columns);

void look_along(const RayTerms& terms,
                const PathSteps& steps,
                int row,
                const ColumnBlock& columns,
                RayBlock& rays);

// Behind a port: the rays of some columns at an index whose rays at nodes, even over the range of
// indices, count by their shares. Rays move smoothly with the index, but glass and water disperse
// light by different laws: nine nodes are right to 1e-9 of a slope, five to 1e-7.
inline constexpr std::size_t kRayNodes = 9;
using RayNodes = std::array<RayBlock, kRayNodes>;
void look_between(const RayTerms& terms,
                  const PathSteps& steps,
                  const RayNodes& nodes,
                  const std::vector<double>& shares,
                  int count,
                  RayBlock& rays);
// The rays at a wavelength, each by itself (rig/geometry.h).
void look_exactly(
    const Rig& rig, int row, const ColumnBlock& columns, double lambda_nm, RayBlock& rays);

struct LampTerms {
    Eigen::Vector3d position_m;
    BeamFrame frame;                         // of its beam, turned
    double height_m = 0.0;                   // over the floor
    std::shared_ptr<const BeamLight> light;  // of the beam times power / (pi N)
    double phong = 0.0;
    double phong_size = 0.0;
};

// What the rays get of one lamp, ready to be looked up.
struct LampBlock {
    DirectionBlock V;
    BeamBlock beam;
    RowBlock<float> place;  // of the path in the table, in steps
    RowBlock<int> step;
    RowBlock<float> within_step;  // 0 to 1
    RowBlock<float> diffuse;      // factor of T
    RowBlock<float> highlight;    // factor of U, T without reflectance
};

// V, with its sides where the beam asks for them or without, and the beam there.
void aim_round(const RayBlock& rays, const LampTerms& lamp, DirectionBlock& V);
void aim_turned(const RayBlock& rays, const LampTerms& lamp, DirectionBlock& V);
void shine(const RayBlock& rays, const LampTerms& lamp, Edges edges, LampBlock& block);
// One more for each of kRowBlock pixels that see the floor; and that see it within a cone of this
// cosine, of the rays last shone on.
void count_seen(const RayBlock& rays, std::uint8_t* counts);
void count_within(const RayBlock& rays,
                  const DirectionBlock& V,
                  double cosine,
                  std::uint8_t* counts);

// Pixels with light whose path is not in the table.
struct Outside {
    int before = 0;
    int beyond = 0;

    bool operator==(const Outside&) const = default;
};
// The factors and the place in the table; black outside it.
[[nodiscard]] Outside weigh(const RayBlock& rays,
                            const LampTerms& lamp,
                            const PathSteps& steps,
                            LampBlock& block);
void weigh_highlight(const RayBlock& rays, const LampTerms& lamp, LampBlock& block);

// Adds factors times the table's signal, by channel.
using SumBlock = std::array<RowBlock<float>, kChannels>;
void look_up(const LampBlock& block,
             const RowBlock<float>& factors,
             std::span<const float> table,
             SumBlock& sums);

}  // namespace aphotic
