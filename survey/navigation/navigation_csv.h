// SPDX-License-Identifier: BSD-3-Clause
//
// Poses from a table with a header row, whose columns may stand in any order, others among them
// (navigation_columns.h):
//
//   image,altitude_m,pitch_deg,roll_deg
//   201207.0001.tif,2.05,4.8,-0.3
//
// Fields are separated by commas, semicolons, tabs or blanks, whichever makes a header that can be
// understood of the table's first line, which comments may precede (table_text.h). Or from lines
// without a header, known by their values:
//
//   201207.0001.tif 2.05 4.8 -0.3        HabCam's .eic
//   sixteen fields                       HabCam's .img
//   thirteen fields or more between ;    Matisse's .dim2
//   fifteen words                        ACFR's stereo_pose_est.data (navigation_csv.cpp)
//
// Lines that are empty or hold separators alone are passed over. A cell that is no number costs its
// own line alone, as does a line with too few or too many fields. A table without a column for
// pitch or roll leaves it as the rig has it.
#pragma once

#include "survey/navigation/navigation.h"
#include "survey/navigation/navigation_columns.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

// A line of the table. Of a track, poses have no image but a time, or as their fault why none.
struct NavigationRow {
    ImagePose pose{};
    double time_s = 0.0;  // since 1970 (time_text.h)
};

inline constexpr std::size_t kMostNavigationRows = 2'000'000;  // a day of 20 Hz

struct NavigationTable {
    NavigationColumns columns{};
    std::vector<NavigationRow> rows{};
    bool are_cameras_own = false;  // angles, in radians: not those of the vehicle
    std::string cut_warning{};     // of a last line without an end, whose last number counts
};

// name stands in messages. A header that cannot be understood, or no line at all, is an InputError
// that names the line.
[[nodiscard]] NavigationTable parse_navigation_csv(const std::string& name,
                                                   std::string_view text,
                                                   const Sled& rig_sled,
                                                   const ColumnNames& given = {},
                                                   AngleUnit angles_in = AngleUnit::Degrees,
                                                   bool has_places = false);

}  // namespace aphotic
