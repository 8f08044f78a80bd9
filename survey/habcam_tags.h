// SPDX-License-Identifier: BSD-3-Clause
//
// HabCam's tags, which its controller writes into the ImageDescription of each image:
//
//   lat=40.612345,lon=-67.123456,hdg=181.20,pitch=-4.80,roll=0.30,alt0=2.05,alt1=2.11,depth=61.2,...
//
// Keys with their values, parted by commas, in any order. Angles are in degrees, altitudes in
// metres: alt0 and alt1 are the two altimeters'.
//
// Source: howland54/habcam-dsvimc.
#pragma once

#include "survey/navigation.h"
#include "survey/navigation_columns.h"
#include "survey/navigation_notes.h"

#include <string_view>

namespace aphotic {

// alt0, pitch and roll, or what `given` names instead of them. An InputError when it names anything
// but these three.
[[nodiscard]] ColumnNames tag_names(const ColumnNames& given);

// A fault of the pose, and no error, where the description has none of them.
void read_tags(ImagePose& pose,
               std::string_view description,
               const ColumnNames& names,
               AngleUnit angles_in);

}  // namespace aphotic
