// SPDX-License-Identifier: BSD-3-Clause
//
// Tables of numbers in CSV, the project's own and the user's, and their curves.
//
//   # title: Coral sand, clean          comment; "key: text" becomes metadata
//   wavelength_nm,reflectance           one header row: names that end in their unit
//   400,0.279                           one row of numbers per line, comma-separated
//
// Text is UTF-8, at most 64 MiB, lines end in LF or CR LF. Blank lines, spaces around fields and a
// byte order mark are ignored. Numbers use a decimal point whatever the locale. Every error is an
// InputError "file:line: what was found; allowed: ...".
//
// The role of a curve determines the header rows and values allowed:
//
//   WaterAbsorption      wavelength_nm,absorption_per_m        0 or more      [1/m]
//   WaterScattering      wavelength_nm,scattering_per_m        0 or more      [1/m]
//   WaterAttenuation     wavelength_nm,attenuation_per_m       0 or more      [1/m]
//   WaterType            wavelength_nm,absorption_per_m,scattering_per_m      [1/m]
//   LampSpectrum         wavelength_nm,relative_power          0 or more      [relative per nm]
//                        wavelength_nm,radiant_flux_w_per_nm   0 or more      [W/nm]
//   Reflectance          wavelength_nm,reflectance             0 to 1         [1]
//   SensorResponse       wavelength_nm,red,green,blue          0 or more      [relative]
//   FilterTransmittance  wavelength_nm,red,green,blue          0 to 1         [1]
//   QuantumEfficiency    wavelength_nm,quantum_efficiency      0 to 1         [1]
//   ColourMatching       wavelength_nm,xbar,ybar,zbar          0 or more      [1]
//
// Wavelengths are in nanometres, above 0 and strictly increasing.
#pragma once

#include "spectral/spectrum.h"

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

struct TableRow {
    std::size_t line = 0;  // in the file, from 1
    std::vector<double> fields;
};

struct Table {
    std::string name;         // file path, or built-in name
    std::string file_sha256;  // empty: not from a file
    std::map<std::string, std::string> metadata;
    std::vector<std::string> columns;
    std::size_t header_line = 0;
    std::vector<TableRow> rows;

    // The text of a "# key: text" comment, empty if there is none.
    [[nodiscard]] std::string text_of(const std::string& key) const;
};

inline constexpr std::size_t kMostTableBytes = std::size_t{64} << 20U;

// name is for messages.
[[nodiscard]] Table parse_table(const std::string& name, std::string_view text);
[[nodiscard]] Table read_table(const std::filesystem::path& file);

enum class CurveRole {
    WaterAbsorption,
    WaterScattering,
    WaterAttenuation,
    WaterType,
    LampSpectrum,
    Reflectance,
    SensorResponse,
    FilterTransmittance,
    QuantumEfficiency,
    ColourMatching,
};

inline constexpr std::array kCurveRoles{CurveRole::WaterAbsorption,
                                        CurveRole::WaterScattering,
                                        CurveRole::WaterAttenuation,
                                        CurveRole::WaterType,
                                        CurveRole::LampSpectrum,
                                        CurveRole::Reflectance,
                                        CurveRole::SensorResponse,
                                        CurveRole::FilterTransmittance,
                                        CurveRole::QuantumEfficiency,
                                        CurveRole::ColourMatching};

// "water absorption" and so on, as in messages and in "# role:" of the built-in tables.
[[nodiscard]] std::string_view role_name(CurveRole role);
[[nodiscard]] std::optional<CurveRole> role_named(std::string_view name);

// One curve per column after the first, named such as "sensor response 'nikon-d5100' (red)".
[[nodiscard]] std::vector<Spectrum> curves_of(const Table& table, CurveRole role);

// The roles that the table can have; an InputError if it has no possible role.
[[nodiscard]] std::vector<CurveRole> roles_of(const Table& table);

}  // namespace aphotic
