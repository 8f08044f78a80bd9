// SPDX-License-Identifier: BSD-3-Clause
//
// Poses from a table with a header row, whose columns may be in any order, among others
// (navigation_columns.h):
//
//   image,altitude_m,pitch_deg,roll_deg
//   201207.0001.tif,2.05,4.8,-0.3
//
// Fields are separated by commas, semicolons, tabs or blanks, whichever makes the table's first
// line a known header; comments may precede it (table_text.h). Or poses come from lines without a
// header, recognised by their values:
//
//   201207.0001.tif 2.05 4.8 -0.3        HabCam's .eic
//   sixteen fields                       HabCam's .img
//   thirteen fields or more between ;    Matisse's .dim2
//   fifteen words                        ACFR's stereo_pose_est.data (navigation_csv.cpp)
//
// Lines that are empty or have only separators are skipped. A cell that is not a number invalidates
// only its own line, as does a wrong number of fields. Without a column for pitch or roll, the
// rig's is used.
#pragma once

#include "survey/navigation/navigation.h"
#include "survey/navigation/navigation_columns.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

inline constexpr std::size_t kMostNavigationRows = 2'000'000;  // a day of 20 Hz

struct NavigationTable {
    NavigationColumns columns{};
    std::vector<ImagePose> poses{};  // in a track, each has a time, or a fault
    bool are_cameras_own = false;    // angles, in radians: not the vehicle's
    std::string cut_warning{};  // for a last line without a line break whose last number is used
};

// name is for messages. An InputError, with the line, for an unknown header or an empty table.
[[nodiscard]] NavigationTable parse_navigation_csv(const std::string& name,
                                                   std::string_view text,
                                                   const Sled& rig_sled,
                                                   const ColumnNames& given = {},
                                                   AngleUnit angles_in = AngleUnit::Degrees,
                                                   bool has_places = false);

}  // namespace aphotic
