// SPDX-License-Identifier: BSD-3-Clause
//
// A measured beam (rig/beam/beam_table.h) prepared for many directions:
//
//   I = (1 - h) ((1 - v) I00 + v I01) + h ((1 - v) I10 + v I11)
//
// v, h   the places of the angles V and H within their cell of the table, 0 to 1
//
// as in table_intensity(), except for the angles: cells are found without a search
// (rig/beam/cell_search.h), and both angles are arc tangents of packs, accurate to kCellAngle_rad.
// A table is continued by that angle beyond its ends. The error of I is thus its slope times that,
// while that of std::atan2 is a few times smaller: for a table in whole degrees, 1.2e-13 of the
// peak where I falls from the peak to 0 in one cell. That is 1e-6 of I itself down to 1.2e-7 of the
// peak, and in all cells that fall less steeply further down.
#pragma once

#include "base/lanes.h"
#include "rig/beam/beam_table.h"
#include "rig/beam/cell_search.h"

#include <vector>

namespace aphotic {

inline constexpr double kCellAngle_rad = 2e-15;

class TableCells {
  public:
    // The table must not be round.
    explicit TableCells(const BeamTable& table);

    // For directions in the lamp's frame, of these lengths.
    [[nodiscard]] Lanes at(const LaneVector& direction, const Lanes& length) const;

  private:
    [[nodiscard]] double at(double V, double H) const;

    struct Place {
        std::size_t cell;
        double share;
    };
    // The nodes of one angle.
    struct Axis {
        explicit Axis(const std::vector<double>& nodes_rad);
        [[nodiscard]] bool contains(double angle_rad) const;
        [[nodiscard]] Place place(double angle_rad) const;
        CellSearch cell;
        std::vector<double> per_step;
    };

    TableAngles angles_;
    Axis vertical_;
    Axis horizontal_;
    std::vector<double> intensity_;
};

}  // namespace aphotic
