// SPDX-License-Identifier: BSD-3-Clause
//
// Poses from CSV with a header row, whose columns may stand in any order, others among them
// (navigation_columns.h):
//
//   image,altitude_m,pitch_deg,roll_deg
//   201207.0001.tif,2.05,4.8,-0.3
//
// or from lines of four fields parted by blanks, without a header, as HabCam's .eic files:
//
//   201207.0001.tif 2.05 4.8 -0.3
//
// or from HabCam's older .img files, of sixteen columns and no header.
//
// Lines that are empty, hold commas alone or begin with # are passed over. A cell that is no number
// costs its own line alone, as does a line with too few or too many fields. A field may stand in
// double quotes, and a comma in them parts no fields. A CSV file without a column for pitch or roll
// leaves it as the rig has it.
#pragma once

#include "survey/navigation.h"
#include "survey/navigation_columns.h"
#include "survey/navigation_notes.h"

#include <string_view>
#include <vector>

namespace aphotic {

// A line of the table. Of a track, poses have no image but a time, or as their fault why none.
struct NavigationRow {
    ImagePose pose{};
    double time_s = 0.0;  // since 1970 (time_text.h)
};

struct NavigationTable {
    NavigationColumns columns{};
    std::vector<NavigationRow> rows{};
    std::size_t lines = 0;
};

// name stands in messages. A header that cannot be understood, or no line at all, is an InputError
// that names the line.
[[nodiscard]] NavigationTable parse_navigation_csv(const std::string& name,
                                                   std::string_view text,
                                                   const Sled& rig_sled,
                                                   const ColumnNames& given = {},
                                                   AngleUnit angles_in = AngleUnit::Degrees);

}  // namespace aphotic
