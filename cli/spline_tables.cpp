// SPDX-License-Identifier: BSD-3-Clause
#include "cli/spline_tables.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "spectral/spline_import.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <vector>

namespace aphotic::cli {

namespace fs = std::filesystem;

namespace {

struct NewTable {
    fs::path path;
    std::string text;
};

std::vector<NewTable> tables_of(const SplineFile& found, const SplineOptions& options) {
    const CurveRole role =
        options.role == "lamp" ? CurveRole::LampSpectrum : CurveRole::Reflectance;
    std::vector<NewTable> tables;
    for (const SplineSpectrum& spectrum : found.spectra) {
        tables.push_back({fs::path(options.folder) / spline_table_name(spectrum.identifier),
                          spline_table(options.file, spectrum, role)});
    }
    return tables;
}

void refuse_to_overwrite(const std::vector<NewTable>& tables) {
    for (const NewTable& table : tables) {
        if (!fs::exists(fs::symlink_status(table.path))) continue;
        throw InputError(
            "{}: found a file of this name; allowed: none, unless --force is given, or another "
            "folder by -o",
            table.path.string());
    }
}

// Every file is whole before the first takes its place.
void write_all(const std::vector<NewTable>& tables) {
    std::vector<std::unique_ptr<AtomicFile>> files;
    for (const NewTable& table : tables) {
        files.push_back(std::make_unique<AtomicFile>(table.path));
        std::ofstream out(files.back()->temporary(), std::ios::binary);
        out << table.text;
        out.close();
        if (!out) throw RunError("{}: cannot be written", table.path.string());
    }
    for (const auto& file : files) file->commit();
}

void note_what_differs(const SplineFile& found, const std::string& file) {
    for (const std::size_t line : found.anonymous_lines) {
        fmt::print(stderr, "aphotic: {}:{}: passed over a spline without a name\n", file, line);
    }
    for (const SplineSpectrum& spectrum : found.spectra) {
        if (spectrum.is_linear()) continue;
        fmt::print(
            stderr,
            "aphotic: {}:{}: {} is a {}: its knots are taken, and joined by straight lines\n",
            file,
            spectrum.line,
            spectrum.identifier,
            spectrum.form);
    }
}

void print_tables(const SplineFile& found, const std::vector<NewTable>& tables) {
    for (std::size_t i = 0; i < tables.size(); ++i) {
        const SplineSpectrum& spectrum = found.spectra[i];
        fmt::print("wrote {}: {}, {} to {} nm, {} rows\n",
                   tables[i].path.string(),
                   spectrum.identifier,
                   spectrum.knots.front().lambda_nm,
                   spectrum.knots.back().lambda_nm,
                   spectrum.knots.size());
    }
}

void print_json(const SplineFile& found, const std::vector<NewTable>& tables) {
    nlohmann::json json = nlohmann::json::array();
    for (std::size_t i = 0; i < tables.size(); ++i) {
        const SplineSpectrum& spectrum = found.spectra[i];
        json.push_back(
            {{"file", tables[i].path.string()},
             {"identifier", spectrum.identifier},
             {"line", spectrum.line},
             {"form", spectrum.form},
             {"range_nm", {spectrum.knots.front().lambda_nm, spectrum.knots.back().lambda_nm}},
             {"rows", spectrum.knots.size()}});
    }
    // A file's name need not be UTF-8; JSON must be.
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace

ExitStatus write_spline_tables(const SplineOptions& options, bool as_json) {
    const SplineFile found =
        parse_splines(options.file, read_text_file(options.file), options.only);
    const std::vector<NewTable> tables = tables_of(found, options);
    if (!options.force) refuse_to_overwrite(tables);
    make_folder(options.folder);
    write_all(tables);
    note_what_differs(found, options.file);
    as_json ? print_json(found, tables) : print_tables(found, tables);
    return kDone;
}

}  // namespace aphotic::cli
