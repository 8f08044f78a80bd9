// SPDX-License-Identifier: BSD-3-Clause
//
// Files of measured beams, by their extension:
//
//   .ies   IESNA LM-63 of 1986, 1991, 1995, 2002 and 2019           candela
//   .ldt   EULUMDAT (Stockmar 1990), absolute as by DIAL (2009)     candela
//   .csv   ours: theta_deg,intensity or theta_deg,phi_deg,intensity  as written
//
// rig/beam/ies_file.h, rig/beam/eulumdat_file.h and rig/beam/beam_csv.h describe the formats. In
// all of them, angle 0 about the axis is our along, and it increases in the direction of LM-63's
// type C (rig/beam/beam_table.h).
//
// The table describes the lamp in the medium in which it was measured, most often air. Texts in
// the file, such as the maker's name, are ignored. An error is an InputError
// "file:line: what was found; allowed: ...".
#pragma once

#include "rig/beam/beam_table.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace aphotic {

struct PhotometricFile {
    BeamTable table;  // the lamp as measured
    // The file's flux for all lamps; empty for .csv without one, and for absolute photometry, which
    // does not separate the lamp from the luminaire.
    std::optional<double> luminous_flux_lm;

    [[nodiscard]] bool operator==(const PhotometricFile&) const = default;
};

inline constexpr std::size_t kMostPhotometricBytes = std::size_t{64} << 20U;

// file_name is for messages; its extension gives the format.
[[nodiscard]] PhotometricFile parse_photometric_file(const std::string& file_name,
                                                     std::string_view text);
[[nodiscard]] PhotometricFile read_photometric_file(const std::filesystem::path& file);

// The same shape with its largest intensity from 0.5 to below 1, scaled by a power of two: no digit
// changes, sums and products of intensities cannot overflow, and only negligible ones underflow.
// Intensities under 2.2e-308 of the largest lose digits that are negligible too. Reading refuses
// tables whose largest intensity is itself that small, since doubles have lost its digits.
[[nodiscard]] BeamTable normalised(BeamTable table);

// Whether a name has one of these extensions.
[[nodiscard]] bool is_photometric_file_name(std::string_view name);
inline constexpr std::string_view kPhotometricEndings = ".ies, .ldt or .csv";

// In the extension's format. Read again, .ies and .csv give exactly the same table. What a format
// cannot express is an InputError: .ldt and .csv hold type C only, and a table over other angles
// would have to be interpolated.
[[nodiscard]] std::string photometric_text(const PhotometricFile& photometry,
                                           const std::string& file_name);
void write_photometric_file(const PhotometricFile& photometry, const std::filesystem::path& file);

}  // namespace aphotic
