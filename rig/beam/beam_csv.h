// SPDX-License-Identifier: BSD-3-Clause
//
// .csv: a beam as a table in our own format, as in spectral/table.h:
//
//   # source: goniometer, 2 m, tank
//   theta_deg,intensity                 or   theta_deg,phi_deg,intensity
//   0,1                                      0,0,1
//   10,0.96                                  ...
//
// theta is the angle off the strobe's axis, from 0 to 180 degrees. phi is the angle about it, from
// along, in the sense of LM-63's type C: counterclockwise seen from behind a lamp whose along is
// up, to port for one that points down with along forward (rig/beam/beam_table.h). Intensities are
// 0 or more, in any unit, linear in both angles between the rows and 0 beyond the last theta.
//
// The rows may be in any order. With phi, there is one row for each theta and each phi, and phi
// makes a full turn: 0 to 360 degrees, with the intensities of 0 repeated at 360, which may be
// omitted if the steps are even. Nothing is mirrored. phi = 0 alone means a round beam.
#pragma once

#include "rig/beam/photometric_file.h"

#include <string>
#include <string_view>

namespace aphotic {

// file_name is for messages.
[[nodiscard]] PhotometricFile parse_beam_csv(const std::string& file_name, std::string_view text);

// Type C only; others are an InputError.
[[nodiscard]] std::string beam_csv_text(const PhotometricFile& photometry,
                                        const std::string& file_name);

}  // namespace aphotic
