// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/curve_loader.h"

#include "base/error.h"
#include "base/file_beside.h"
#include "base/nearest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace aphotic {
namespace {

std::vector<std::string> all_names() {
    std::vector<std::string> names;
    for (const BuiltinTable& table : builtin_tables()) names.emplace_back(table.name);
    return names;
}

[[noreturn]] void fail_unknown(std::string_view name) {
    const std::vector<std::string> names = all_names();
    const std::string nearest = nearest_name(name, names);
    throw InputError(
        "no built-in table is named '{}'{}; allowed: {}, or a file whose name ends in .csv",
        name,
        nearest.empty() ? "" : "; did you mean '" + nearest + "'?",
        fmt::join(names, ", "));
}

void require_role(const Table& builtin, CurveRole role) {
    const std::string found = builtin.text_of("role");
    if (found == role_name(role)) return;
    throw InputError("'{}' is a built-in table of role {}, not {}; allowed: {}",
                     builtin.name,
                     found,
                     role_name(role),
                     fmt::join(builtin_names(role_name(role)), ", "));
}

}  // namespace

std::vector<std::string> builtin_names(std::string_view role) {
    std::vector<std::string> names;
    for (const BuiltinTable& builtin : builtin_tables()) {
        const Table table = parse_table(std::string(builtin.name), builtin.csv);
        if (table.text_of("role") == role) names.push_back(table.name);
    }
    return names;
}

Table builtin_table(std::string_view name) {
    for (const BuiltinTable& table : builtin_tables()) {
        if (table.name == name) return parse_table(std::string(name), table.csv);
    }
    fail_unknown(name);
}

bool names_a_file(std::string_view name_or_path) {
    return name_or_path.ends_with(".csv");
}

Table load_table(const std::string& name_or_path, const std::filesystem::path& base_folder) {
    if (names_a_file(name_or_path)) return read_table(file_beside(base_folder, name_or_path));
    return builtin_table(name_or_path);
}

std::vector<Spectrum> load_curves(const std::string& name_or_path,
                                  CurveRole role,
                                  const std::filesystem::path& base_folder) {
    const Table table = load_table(name_or_path, base_folder);
    // Different roles can share a header, so a built-in table's own role is checked first.
    if (!names_a_file(name_or_path)) require_role(table, role);
    return curves_of(table, role);
}

Spectrum load_curve(const std::string& name_or_path,
                    CurveRole role,
                    const std::filesystem::path& base_folder) {
    return load_curves(name_or_path, role, base_folder).front();
}

}  // namespace aphotic
