// SPDX-License-Identifier: BSD-3-Clause
//
// A measured beam from any text, in each format. What is read is a sound table, and is read again
// from what is written of it: to the last bit but for .ldt, whose values are rounded on the way.
#include "fuzz.h"
#include "rig/beam/photometric_file.h"

#include <cmath>
#include <numbers>
#include <optional>

namespace {

using aphotic::BeamTable;

void demand(bool holds) {
    if (!holds) std::abort();
}

void demand_rising(const std::vector<double>& angles_rad) {
    for (std::size_t i = 1; i < angles_rad.size(); ++i) demand(angles_rad[i] > angles_rad[i - 1]);
}

void demand_sound(const BeamTable& table) {
    demand_rising(table.vertical_rad);
    demand_rising(table.horizontal_rad);
    const std::size_t rows = table.vertical_rad.size();
    demand(rows >= 2 && !table.horizontal_rad.empty());
    demand(table.intensity.size() == rows * table.horizontal_rad.size());
    for (const double intensity : table.intensity)
        demand(std::isfinite(intensity) && intensity >= 0.0);
    const bool is_c = table.angles == aphotic::TableAngles::TypeC;
    demand(table.vertical_rad.front() >= (is_c ? 0.0 : -0.5 * std::numbers::pi));
    demand(table.vertical_rad.back() <= (is_c ? 1.0 : 0.5) * std::numbers::pi);
    if (is_c && table.horizontal_rad.size() > 1) {
        demand(table.horizontal_rad.front() == 0.0);
        demand(table.horizontal_rad.back() == 2.0 * std::numbers::pi);
    }
}

void demand_sound_answers(const BeamTable& table) {
    demand(table_flux(table) >= 0.0);
    for (const Eigen::Vector3d& direction :
         {Eigen::Vector3d(0.0, 0.0, 1.0), Eigen::Vector3d(0.3, -0.2, 0.5)}) {
        const double most = most_table_intensity(table, direction, 0.1);
        demand(table_intensity(table, direction) <= most);
    }
}

void read_as(const std::string& name, const std::string& text) {
    std::optional<aphotic::PhotometricFile> file;
    aphotic::expect_result_or_placed_error(
        name, [&] { file = aphotic::parse_photometric_file(name, text); });
    if (!file) return;
    demand_sound(file->table);
    demand_sound_answers(file->table);
    const auto again = [&] {
        return aphotic::parse_photometric_file(name, aphotic::photometric_text(*file, name));
    };
    if (name.ends_with(".ldt")) {
        // Without light, or of too little or too much of it, there are no values per 1000 lm.
        aphotic::expect_result_or_placed_error(name, [&] { demand_sound(again().table); });
    } else {
        demand(again().table == file->table);
    }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text = aphotic::text_of(data, size);
    for (const char* name : {"beam.ies", "beam.ldt", "beam.csv"}) read_as(name, text);
    return 0;
}
