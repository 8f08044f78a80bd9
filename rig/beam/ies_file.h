// SPDX-License-Identifier: BSD-3-Clause
//
// .ies: IESNA LM-63, the North American photometry format.
//
//   IESNA:LM-63-2002            the edition: none in 1986, IESNA91, IESNA:LM-63-1995 or -2002,
//                               IES:LM-63-2019
//   [KEYWORD] text ...          in 1986, lines of any text
//   TILT=NONE                   or INCLUDE, with factors of 1: light does not change with the tilt
//   lamps  lumens per lamp  multiplier  nV  nH  type  units  width  length  height
//   ballast factor  lamp factor  watts
//   V[nV]  H[nH]  candela[nH][nV]
//
//   I = candela x multiplier x ballast factor x lamp factor        [cd]
//
// Numbers may continue across lines, separated by blanks, commas or both. Up to 1995 the lamp
// factor is a factor (the "ballast-lamp photometric factor"); in 2002 its place is "for future
// use", and in 2019 it is a code for the origin of the file (1.1 for an accredited laboratory),
// which must not be multiplied in. -1 lumens per lamp mean absolute photometry.
//
// type 1 is C, 2 is B, 3 is A (rig/beam/beam_table.h). V and H are in degrees. By the range of H, a
// table of type C is
//
//   0 alone      a round beam            0 to 180     mirrored in the plane of 0 and 180
//   0 to 90      mirrored in both        90 to 270    mirrored in the plane of 90 and 270
//   0 to 360     whole; 360 may be omitted if the steps are even, since it equals 0
//
// A table of type A or B that begins at V = 0 is mirrored below, one that begins at H = 0 to the
// left. V may end at any angle, where the light ends.
//
// Sizes and watts are ignored.
//
// Sources: IESNA LM-63-2002; for the lamp factor of 1986 to 1995, I. Ashdown's IESNA.H (1998); for
// the codes of 2019, PhotomPy 0.3.1.
#pragma once

#include "rig/beam/photometric_file.h"

#include <string>
#include <string_view>

namespace aphotic {

// file_name is for messages.
[[nodiscard]] PhotometricFile parse_ies(const std::string& file_name, std::string_view text);

// Written as LM-63-2002, which every reader supports. The type is kept, symmetries are unfolded,
// and photometry is absolute if the lamps' flux is unknown. Keywords that the edition requires have
// the value "not stated".
[[nodiscard]] std::string ies_text(const PhotometricFile& photometry, const std::string& file_name);

}  // namespace aphotic
