// SPDX-License-Identifier: BSD-3-Clause
//
// The built-in tables (spectral/data/*.csv, embedded by cmake/Embed.cmake), and loading a table or
// curve by built-in name or file.
//
// Each built-in table states in its comments its title, role, quantity, unit, source, how the
// numbers were obtained, their uncertainty, range and terms.
#pragma once

#include "spectral/spectrum.h"
#include "spectral/table.h"

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

struct BuiltinTable {
    std::string_view name;
    std::string_view csv;
};

[[nodiscard]] std::span<const BuiltinTable> builtin_tables();

// The names of all built-in tables with this "# role:".
[[nodiscard]] std::vector<std::string> builtin_names(std::string_view role);

// Throws InputError for an unknown name, with the nearest known one and the list of names.
[[nodiscard]] Table builtin_table(std::string_view name);

// A name that ends in ".csv" is a file in base_folder or below it (file_beside.h); any other name
// is a built-in table.
[[nodiscard]] bool names_a_file(std::string_view name_or_path);
[[nodiscard]] Table load_table(const std::string& name_or_path,
                               const std::filesystem::path& base_folder);

// The curves of a table, one per column. Throws InputError if the table does not have that role.
[[nodiscard]] std::vector<Spectrum> load_curves(const std::string& name_or_path,
                                                CurveRole role,
                                                const std::filesystem::path& base_folder);

// The same for the roles with a single curve.
[[nodiscard]] Spectrum load_curve(const std::string& name_or_path,
                                  CurveRole role,
                                  const std::filesystem::path& base_folder);

}  // namespace aphotic
