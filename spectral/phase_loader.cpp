// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/phase_loader.h"

#include "base/csv.h"
#include "base/degrees.h"
#include "base/error.h"
#include "base/nearest.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace aphotic {
namespace {

constexpr auto kSeawater = "sea-water";
constexpr double kStraightBack_deg = 180.0;

void require_angles_and_values(const Table& table) {
    const std::vector<std::string> header{"angle_deg", "phase_function_per_sr"};
    if (table.columns != header) {
        fail_at_line(table.name,
                     table.header_line,
                     "found the header row {}; allowed for a phase function: {}",
                     fmt::join(table.columns, ","),
                     fmt::join(header, ","));
    }
    double before_deg = -1.0;
    double most = 0.0;
    for (const TableRow& row : table.rows) {
        const double angle_deg = row.fields[0];
        const double value = row.fields[1];
        if (angle_deg < 0.0 || angle_deg > kStraightBack_deg || angle_deg <= before_deg) {
            fail_at_line(table.name,
                         row.line,
                         "angle_deg: found {}; allowed: from 0 up to 180, increasing",
                         angle_deg);
        }
        if (value < 0.0) {
            fail_at_line(
                table.name, row.line, "phase_function_per_sr: found {}; allowed: 0 or more", value);
        }
        before_deg = angle_deg;
        most = std::max(most, value);
    }
    const std::size_t last = table.rows.back().line;
    if (before_deg != kStraightBack_deg)
        fail_at_line(table.name, last, "found a last angle of {}; allowed: 180", before_deg);
    if (table.rows.size() < 3 || most == 0.0)
        fail_at_line(
            table.name, last, "found no scattering; allowed: three rows or more, not all 0");
}

// Below the first row the power law is extrapolated; if steeper than psi^-2, it has no integral.
void require_integrable(const Table& table) {
    constexpr double kSteepest = -1.95;
    const std::vector<double>& a = table.rows[0].fields;
    const std::vector<double>& b = table.rows[1].fields;
    if (a[0] == 0.0 || a[1] == 0.0 || b[1] == 0.0) return;
    const double slope = std::log(b[1] / a[1]) / std::log(b[0] / a[0]);
    if (slope > kSteepest) return;
    fail_at_line(table.name,
                 table.rows[1].line,
                 "found a power law of exponent {:.3g} in the first two rows, which is "
                 "extrapolated to 0 degrees; allowed: above {}, or a first row at 0",
                 slope,
                 kSteepest);
}

}  // namespace

std::vector<std::string> builtin_phase_names() {
    std::vector<std::string> names;
    for (const BuiltinTable& table : builtin_phase_tables()) names.emplace_back(table.name);
    names.emplace_back(kSeawater);
    return names;
}

PhaseFunction builtin_phase(const std::string& name) {
    if (name == kSeawater) return {.name = name, .kind = MolecularScattering{}};
    for (const BuiltinTable& table : builtin_phase_tables()) {
        if (table.name == name) return phase_of(parse_table(name, table.csv));
    }
    const std::vector<std::string> names = builtin_phase_names();
    const std::string nearest = nearest_name(name, names);
    throw InputError(
        "no built-in phase function is named '{}'{}; allowed: {}, or a file whose name ends in "
        ".csv",
        name,
        nearest.empty() ? "" : "; did you mean '" + nearest + "'?",
        fmt::join(names, ", "));
}

PhaseFunction phase_of(const Table& table) {
    require_angles_and_values(table);
    require_integrable(table);
    std::vector<double> angle_rad;
    std::vector<double> values;
    for (const TableRow& row : table.rows) {
        angle_rad.push_back(row.fields[0] * kRadiansPerDegree);
        values.push_back(row.fields[1]);
    }
    return phase_table(table.name, std::move(angle_rad), std::move(values));
}

}  // namespace aphotic
