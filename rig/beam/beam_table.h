// SPDX-License-Identifier: BSD-3-Clause
//
// A measured beam: intensities over the two angles of a goniometer, as in photometric files
// (rig/beam/photometric_file.h), with every symmetry unfolded.
//
//   I(w)   intensity in the direction w, in the table's own unit
//
// bilinear in the two angles V (vertical) and H (horizontal) between the table's nodes, and 0
// beyond them. A direction w is in the lamp's frame: x along, y across, z the axis, across = axis x
// along. Where the lamp points down, x is forward, y starboard and z down. With w of length 1,
//
//   type C   w = (sin V cos H, -sin V sin H, cos V)   V off the axis, H about it
//   type B   w = (sin V cos H, sin H, cos V cos H)    planes of one V share the line across
//   type A   w = (sin V, cos V sin H, cos V cos H)    planes of one H share the line along
//
// This is the definition of the angles in IESNA LM-63-2002, section 3. "Photometric zero", V = H =
// 0 of B and C, is straight down: our axis. "Photometric horizontal", V = 90 degrees, H = 0, is our
// along. Seen from above, H runs counterclockwise for C, which is to port, and clockwise for A and
// B, to starboard. Type A is for lamps that shine horizontally (H = V = 0, with V = -90 degrees
// straight down): the lamp is rotated so that its V = H = 0 is also the axis, and its up becomes
// along. So for A and B alike, seen from behind the lamp with along upwards, V increases upwards
// and H to the right.
//
// At V = 0 of type C, and where all planes of A and of B meet, I is the value in the plane of w;
// files repeat one value there in all planes.
#pragma once

#include <Eigen/Core>

#include <vector>

namespace aphotic {

// The goniometers of LM-63.
enum class TableAngles { TypeA, TypeB, TypeC };

struct BeamTable {
    TableAngles angles = TableAngles::TypeC;
    // Strictly increasing. C: within 0 to pi. A and B: within -pi/2 to pi/2, two or more.
    std::vector<double> vertical_rad;
    // Strictly increasing. C: 0 alone, for a round beam, or from 0 to 2 pi, which have equal
    // intensities. A and B: within -pi/2 to pi/2, two or more.
    std::vector<double> horizontal_rad;
    std::vector<double> intensity;  // [horizontal][vertical], vertical fastest; finite, 0 or more

    [[nodiscard]] bool operator==(const BeamTable&) const = default;
};

// Directions are of any length but 0.

[[nodiscard]] double table_intensity(const BeamTable& table, const Eigen::Vector3d& direction);

// Upper bound of I over all directions within an angle of this one: its maximum over the smallest
// rectangle of V and H that contains them.
[[nodiscard]] double most_table_intensity(const BeamTable& table,
                                          const Eigen::Vector3d& direction,
                                          double within_rad);

// The maximum over all directions.
[[nodiscard]] double largest_intensity(const BeamTable& table);

// The integral of I over all directions, exact except for rounding, in the table's unit times sr.
// With x the angle on which the solid angle depends (dw = cos x dx dy; C: V - pi/2, A: V, B: H),
//
//   sum of I over the nodes times  integral of hat(x) cos x dx  times  integral of hat(y) dy
[[nodiscard]] double table_flux(const BeamTable& table);

// The lines where I falls to 0 in a step, because the table ends: along each, one angle is
// `at_rad`, and the other covers its whole range. Lines along which the table is 0 throughout are
// omitted, and so are those that are only a point (V = 0 or 180 degrees of C; V of A, H of B at
// 90).
//
//   type C   Vertical alone: a circle about the axis, or two for a table that begins off it
//   A and B  the four sides of a rectangle; horizontal lines of B and vertical lines of A are
//            great circles
enum class TableAngle { Vertical, Horizontal };
struct TableEdge {
    TableAngle angle = TableAngle::Vertical;
    double at_rad = 0.0;

    [[nodiscard]] bool operator==(const TableEdge&) const = default;
};
[[nodiscard]] std::vector<TableEdge> edges_of(const BeamTable& table);

// The unit direction of two angles, and the angles of a direction: H of C from 0 to 2 pi; for A and
// B, the angle about the poles from -pi to pi.
struct GoniometerAngles {
    double vertical_rad = 0.0;
    double horizontal_rad = 0.0;
};
[[nodiscard]] Eigen::Vector3d direction_at(TableAngles type, const GoniometerAngles& at);
[[nodiscard]] GoniometerAngles angles_of(TableAngles type, const Eigen::Vector3d& direction);

}  // namespace aphotic
