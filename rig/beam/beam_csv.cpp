// SPDX-License-Identifier: BSD-3-Clause
#include "rig/beam/beam_csv.h"

#include "base/error.h"
#include "rig/beam/photometric_text.h"
#include "spectral/table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <utility>

namespace aphotic {

namespace {

const std::vector<std::string> kRoundColumns{"theta_deg", "intensity"};
const std::vector<std::string> kTurnColumns{"theta_deg", "phi_deg", "intensity"};

// The distinct values of a column in order, each with the first line that contains it.
std::vector<FileNumber> values_of(const Table& table, std::size_t column) {
    std::map<double, std::size_t> line_of;
    for (const TableRow& row : table.rows) line_of.emplace(row.fields[column], row.line);
    std::vector<FileNumber> values;
    for (const auto& [value, line] : line_of) values.push_back({value, line});
    return values;
}

std::size_t index_of(double value, const std::vector<FileNumber>& values) {
    const auto found = std::ranges::lower_bound(values, value, {}, &FileNumber::value);
    return static_cast<std::size_t>(found - values.begin());
}

// The intensity at each theta and phi, theta fastest.
std::vector<FileNumber> grid_of(const Table& table,
                                const std::vector<FileNumber>& thetas,
                                const std::vector<FileNumber>& phis) {
    if (thetas.size() > kMostTableNodes / phis.size()) {
        fail_at_line(table.name,
                     table.rows.back().line,
                     fmt::format("found {} theta_deg and {} phi_deg; allowed: {} rows in all",
                                 thetas.size(),
                                 phis.size(),
                                 kMostTableNodes));
    }
    std::vector<FileNumber> grid(thetas.size() * phis.size());
    const bool has_phi = table.columns.size() == 3;
    const auto place = [&](double theta, double phi) {
        return has_phi ? fmt::format("theta_deg {}, phi_deg {}", theta, phi)
                       : fmt::format("theta_deg {}", theta);
    };
    for (const TableRow& row : table.rows) {
        const double theta = row.fields[0];
        const double phi = has_phi ? row.fields[1] : 0.0;
        FileNumber& node = grid[index_of(phi, phis) * thetas.size() + index_of(theta, thetas)];
        if (node.line > 0) {
            fail_at_line(table.name,
                         row.line,
                         fmt::format("found a second row of {}, first on line {}; allowed: one",
                                     place(theta, phi),
                                     node.line));
        }
        node = {row.fields.back(), row.line};
    }
    for (std::size_t i = 0; i < grid.size(); ++i) {
        if (grid[i].line > 0) continue;
        fail_at_line(
            table.name,
            table.rows.back().line,
            fmt::format("found no row for {}; allowed: one for each theta_deg and phi_deg",
                        place(thetas[i % thetas.size()].value, phis[i / thetas.size()].value)));
    }
    return grid;
}

void unfold(PhotometricFile& photometry,
            const std::string& file,
            const std::vector<FileNumber>& phis,
            std::vector<TurnPlane> planes) {
    const double first = phis.front().value;
    const double last = phis.back().value;
    if (phis.size() == 1 && first == 0.0) {
        photometry.table.horizontal_rad = {0.0};
        photometry.table.intensity = std::move(planes.front().intensity);
        return;
    }
    if (first != 0.0 || (last != 360.0 && !closes_evenly(phis))) {
        fail_at_line(file,
                     phis.back().line,
                     fmt::format("phi_deg: found {} to {}; allowed: 0 to 360 (360 may be omitted "
                                 "where steps are even), or 0 alone",
                                 first,
                                 last));
    }
    if (last == 360.0 && planes.back().intensity != planes.front().intensity) {
        fail_at_line(file,
                     phis.back().line,
                     "found intensities at phi_deg 360 that differ from those at 0; allowed: the "
                     "same, since it is one direction");
    }
    set_turn(photometry.table, std::move(planes));
}

}  // namespace

PhotometricFile parse_beam_csv(const std::string& file_name, std::string_view text) {
    const Table table = parse_table(file_name, text);
    const bool has_phi = table.columns == kTurnColumns;
    if (!has_phi && table.columns != kRoundColumns) {
        fail_at_line(file_name,
                     table.header_line,
                     fmt::format("found the header row {}; allowed for a beam: {} or {}",
                                 fmt::join(table.columns, ","),
                                 fmt::join(kRoundColumns, ","),
                                 fmt::join(kTurnColumns, ",")));
    }
    const std::vector<FileNumber> thetas = values_of(table, 0);
    const std::vector<FileNumber> phis =
        has_phi ? values_of(table, 1) : std::vector{FileNumber{0.0, table.header_line}};
    check_angles(file_name, thetas, "theta_deg", 0.0, 180.0);
    check_angles(file_name, phis, "phi_deg", 0.0, 360.0);
    if (thetas.size() < 2) fail_number(file_name, thetas.front(), "theta_deg", "two or more");

    PhotometricFile photometry;
    photometry.table.vertical_rad = radians_of(thetas);
    const std::vector<FileNumber> grid = grid_of(table, thetas, phis);
    std::vector<TurnPlane> planes;
    for (std::size_t h = 0; h < phis.size(); ++h) {
        planes.push_back({phis[h].value, {}});
        for (std::size_t v = 0; v < thetas.size(); ++v) {
            planes.back().intensity.push_back(
                intensity_of(file_name, grid[h * thetas.size() + v], "intensity", 1.0));
        }
    }
    unfold(photometry, file_name, phis, std::move(planes));
    return photometry;
}

std::string beam_csv_text(const PhotometricFile& photometry, const std::string& file_name) {
    const BeamTable& table = photometry.table;
    if (table.angles != TableAngles::TypeC) {
        throw InputError("{}: found a table of type A or B; allowed in .csv: type C", file_name);
    }
    const bool is_round = table.horizontal_rad.size() == 1;
    std::string text = fmt::format("{}\n", fmt::join(is_round ? kRoundColumns : kTurnColumns, ","));
    std::vector<std::string> thetas;
    for (const double theta : table.vertical_rad) thetas.push_back(degrees_text(theta));
    for (std::size_t h = 0; h < table.horizontal_rad.size(); ++h) {
        const std::string phi = is_round ? "" : degrees_text(table.horizontal_rad[h]) + ",";
        for (std::size_t v = 0; v < thetas.size(); ++v) {
            const double intensity = table.intensity[h * thetas.size() + v];
            text += fmt::format("{},{}{}\n", thetas[v], phi, intensity);
        }
    }
    return text;
}

}  // namespace aphotic
