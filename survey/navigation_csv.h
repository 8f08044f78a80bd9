// SPDX-License-Identifier: BSD-3-Clause
//
// Navigation from CSV with a header row, whose columns may stand in any order, others among them:
//
//   image,altitude_m,pitch_deg,roll_deg
//   201207.0001.tif,2.05,4.8,-0.3
//
// or from lines of four fields parted by blanks, without a header, as HabCam's .eic files:
//
//   201207.0001.tif 2.05 4.8 -0.3
//
// Lines that are empty, hold commas alone or begin with # are passed over. A cell that is no number
// costs its own image alone, as does a line with too few or too many fields. A CSV file without a
// column for pitch or roll leaves it as the rig has it.
#pragma once

#include "survey/navigation.h"

#include <string_view>

namespace aphotic {

// name stands in messages. A header that cannot be understood, or no line of an image at all, is an
// InputError that names the line.
[[nodiscard]] Navigation parse_navigation_csv(const std::string& name,
                                              std::string_view text,
                                              const Sled& rig_sled);
// Or from an iFDO, known by its content (navigation_ifdo.h).
[[nodiscard]] Navigation read_navigation_csv(const std::filesystem::path& file,
                                             const Sled& rig_sled);

}  // namespace aphotic
