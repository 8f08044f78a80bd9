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
// Numbers run across lines, separated by blanks, commas or both. The lamp factor's place holds one
// (the "ballast-lamp photometric factor") up to 1995; in 2002 it is "for future use", and in 2019 a
// code for how the file was made (1.1 for an accredited laboratory), which must not be multiplied
// in. -1 lumens per lamp mean absolute photometry.
//
// type 1 is C, 2 is B, 3 is A (rig/beam/beam_table.h). V and H are in degrees. By the range of H, a
// table of type C is
//
//   0 alone      the same all about      0 to 180     mirrored in the plane of 0 and 180
//   0 to 90      mirrored in both        90 to 270    mirrored in the plane of 90 and 270
//   0 to 360     whole; 360 may be left out where the steps are even, for it is 0 again
//
// A table of type A or B that begins at V = 0 is mirrored below, one that begins at H = 0 to the
// left. V may end anywhere: the light ends there.
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

// Written as LM-63-2002, which every reader knows: type kept, symmetries unfolded, absolute if the
// lamps' flux is unknown. Keywords that the edition requires say "not stated" if nothing is known.
[[nodiscard]] std::string ies_text(const PhotometricFile& photometry, const std::string& file_name);

}  // namespace aphotic
