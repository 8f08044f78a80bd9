// SPDX-License-Identifier: BSD-3-Clause
#include "rig/beam/photometric_file.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/printable.h"
#include "base/words.h"
#include "rig/beam/beam_csv.h"
#include "rig/beam/eulumdat_file.h"
#include "rig/beam/ies_file.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace aphotic {

namespace {

enum class Format { Ies, Eulumdat, Csv };

std::optional<Format> format_by_ending(std::string_view name) {
    const std::string lower = lower_case(std::string(name));
    if (lower.ends_with(".ies")) return Format::Ies;
    if (lower.ends_with(".ldt")) return Format::Eulumdat;
    if (lower.ends_with(".csv")) return Format::Csv;
    return std::nullopt;
}

Format format_of(const std::string& file_name) {
    if (const auto format = format_by_ending(file_name)) return *format;
    throw InputError("{}: found another file type; allowed for a measured beam: {}",
                     printable(file_name),
                     kPhotometricEndings);
}

PhotometricFile parse_by_ending(const std::string& file_name, std::string_view text) {
    switch (format_of(file_name)) {
        case Format::Ies:
            return parse_ies(file_name, text);
        case Format::Eulumdat:
            return parse_eulumdat(file_name, text);
        case Format::Csv:
            break;
    }
    return parse_beam_csv(file_name, text);
}

}  // namespace

PhotometricFile parse_photometric_file(const std::string& file_name, std::string_view text) {
    PhotometricFile file = parse_by_ending(file_name, text);
    const double largest = largest_intensity(file.table);
    if (largest > 0.0 && !std::isnormal(largest)) {
        throw InputError(
            fmt::format("{}: found no intensity above {:.3g} after the file's factors; allowed: a "
                        "largest one of {:.3g} or more, since doubles lose digits below",
                        printable(file_name),
                        largest,
                        std::numeric_limits<double>::min()));
    }
    return file;
}

BeamTable normalised(BeamTable table) {
    int exponent = 0;
    std::frexp(largest_intensity(table), &exponent);
    for (double& intensity : table.intensity) intensity = std::ldexp(intensity, -exponent);
    return table;
}

PhotometricFile read_photometric_file(const std::filesystem::path& file) {
    return parse_photometric_file(file.string(), read_text_file(file, kMostPhotometricBytes));
}

bool is_photometric_file_name(std::string_view name) {
    return format_by_ending(name).has_value();
}

std::string photometric_text(const PhotometricFile& photometry, const std::string& file_name) {
    switch (format_of(file_name)) {
        case Format::Ies:
            return ies_text(photometry, file_name);
        case Format::Eulumdat:
            return eulumdat_text(photometry, file_name);
        case Format::Csv:
            break;
    }
    return beam_csv_text(photometry, file_name);
}

void write_photometric_file(const PhotometricFile& photometry, const std::filesystem::path& file) {
    write_text_file(file, photometric_text(photometry, file.string()));
}

}  // namespace aphotic
