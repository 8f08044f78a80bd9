// SPDX-License-Identifier: BSD-3-Clause
//
// .ldt: EULUMDAT, the European photometry format. One value per line:
//
//    1 manufacturer   2 type   3 Isym   4 Mc planes   5 their step   6 Ng angles   7 their step
//    8 to 12 report, name, number, file, date   13 to 21 sizes   22 and 23 shares of flux in %
//   24 conversion factor   25 tilt   26 sets of lamps
//   for the set: number of lamps, type, lumens of all, colour, rendering, watts
//   10 direct ratios, Mc angles C, Ng angles gamma, then intensities plane by plane
//
//   I = value x conversion factor x lumens / 1000        [cd]
//
// A negative number of lamps means absolute photometry: lumens are the luminaire's. All Mc angles
// are listed, whichever planes are stored; Isym gives those:
//
//   0   all                              1   one, for a round beam
//   2   C0 to C180, Mc/2 + 1 planes      3   C270 over C0 to C90, Mc/2 + 1 planes
//   4   C0 to C90, Mc/4 + 1 planes
//
// Several sets of lamps are options, and the file does not state which is installed: such a file is
// refused. Decimal commas are accepted. Gamma is V and C is H of LM-63's type C, C0 along; gamma
// may end at any angle, where the light ends.
//
// Sources: A. Stockmar, "EULUMDAT - ein Leuchtendatenformat für den europäischen
// Beleuchtungsplaner", Licht '90, 641-644, with Mc1 = 3 Mc/4 + 1 and Mc2 = Mc1 + Mc/2 for Isym 3;
// DIAL, "Handling of absolute photometry data in EULUMDAT files", 2009.
#pragma once

#include "rig/beam/photometric_file.h"

#include <string>
#include <string_view>

namespace aphotic {

// file_name is for messages.
[[nodiscard]] PhotometricFile parse_eulumdat(const std::string& file_name, std::string_view text);

// Isym 1 or 0. If the lamps' flux is unknown, the file is absolute, with the table's own flux.
// Sizes, watts and direct ratios are 0, for unknown. Types other than C, and a dark table, are an
// InputError.
[[nodiscard]] std::string eulumdat_text(const PhotometricFile& photometry,
                                        const std::string& file_name);

}  // namespace aphotic
