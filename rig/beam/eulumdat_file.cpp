// SPDX-License-Identifier: BSD-3-Clause
#include "rig/beam/eulumdat_file.h"

#include "base/csv.h"
#include "base/degrees.h"
#include "base/error.h"
#include "rig/beam/photometric_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace aphotic {

namespace {

constexpr std::size_t kDirectRatios = 10;
constexpr std::size_t kMostLampsOfSet = 1'000'000;

class ValueLines {
  public:
    ValueLines(std::string file, std::string_view text) : file_(std::move(file)), rest_(text) {}

    [[nodiscard]] const std::string& file() const { return file_; }
    [[nodiscard]] std::size_t line() const { return line_; }

    std::string_view next(std::string_view what) {
        ++line_;
        if (rest_.empty()) {
            fail_at_line(file_, line_, fmt::format("the file ends where {} should be", what));
        }
        return trimmed(next_line(rest_));
    }

    void skip(std::size_t lines, std::string_view what) {
        for (std::size_t i = 0; i < lines; ++i) static_cast<void>(next(what));
    }

    FileNumber number(std::string_view what) {
        std::string word(next(what));
        if (std::ranges::count(word, ',') == 1 && word.find('.') == std::string::npos)
            std::ranges::replace(word, ',', '.');
        return number_of(file_, line_, word, what);
    }

    std::vector<FileNumber> numbers(std::size_t count, std::string_view what) {
        std::vector<FileNumber> all;
        for (std::size_t i = 0; i < count; ++i) all.push_back(number(what));
        return all;
    }

    std::size_t count(std::string_view what, std::size_t least, std::size_t most) {
        return count_of(file_, number(what), what, least, most);
    }

    void expect_end() {
        while (!rest_.empty()) {
            const std::string_view word = next("the end");
            if (word.find_first_not_of(std::string_view("\x1A\0", 2)) == std::string_view::npos)
                continue;
            fail_at_line(file_,
                         line_,
                         fmt::format("found {} after the last intensity; allowed: as many as Isym, "
                                     "Mc and Ng require",
                                     shown_word(word)));
        }
    }

  private:
    std::string file_;
    std::string_view rest_;
    std::size_t line_ = 0;
};

// The stored planes: Mc1 - 1, counted from 0, and their number.
struct StoredPlanes {
    std::size_t first = 0;
    std::size_t count = 0;
};

StoredPlanes stored_planes(std::size_t symmetry, std::size_t planes) {
    switch (symmetry) {
        case 1:
            return {0, 1};
        case 2:
            return {0, planes / 2 + 1};
        case 3:
            return {3 * planes / 4, planes / 2 + 1};
        case 4:
            return {0, planes / 4 + 1};
        default:
            return {0, planes};
    }
}

// Checks that the angles required by a symmetry exist.
void check_plane(const std::string& file, const FileNumber& angle, double wanted_deg) {
    if (angle.value == wanted_deg) return;
    fail_number(
        file, angle, "a C angle", fmt::format("{} degrees here, by Isym and Mc", wanted_deg));
}

void check_symmetry_angles(const std::string& file,
                           std::size_t symmetry,
                           const std::vector<FileNumber>& angles) {
    const std::size_t planes = angles.size();
    check_plane(file, angles.front(), 0.0);
    if (symmetry == 2) check_plane(file, angles[planes / 2], 180.0);
    if (symmetry == 3 || symmetry == 4) check_plane(file, angles[planes / 4], 90.0);
    if (symmetry == 3) check_plane(file, angles[3 * planes / 4], 270.0);
}

std::size_t next_plane_count(ValueLines& lines, std::size_t symmetry) {
    constexpr std::array<std::size_t, 5> kMultiples{1, 1, 2, 4, 4};
    const std::size_t multiple = kMultiples.at(symmetry);
    const std::size_t least = symmetry == 1 ? 1 : std::max<std::size_t>(2, multiple);
    const std::size_t planes = lines.count("Mc, the number of C planes", least, kMostTableNodes);
    if (planes % multiple != 0) {
        fail_at_line(lines.file(),
                     lines.line(),
                     fmt::format("Mc, the number of C planes: found {}; allowed with Isym {}: "
                                 "multiples of {}",
                                 planes,
                                 symmetry,
                                 multiple));
    }
    return planes;
}

// The factor from values to candela, and the file's data on the lamps.
double next_lamps(ValueLines& lines, PhotometricFile& photometry) {
    const std::string& file = lines.file();
    const double factor =
        above_zero(file, lines.number("the conversion factor"), "the conversion factor");
    lines.skip(1, "the tilt");
    const FileNumber sets = lines.number("the number of sets of lamps");
    if (sets.value != 1.0) {
        fail_number(file,
                    sets,
                    "sets of lamps",
                    "1; of several, keep the one that is installed, since intensities are per 1000 "
                    "lm of it");
    }
    const FileNumber count = lines.number("the number of lamps");
    static_cast<void>(count_of(file,
                               {std::abs(count.value), count.line},
                               "the number of lamps, negative for absolute photometry",
                               1,
                               kMostLampsOfSet));
    lines.skip(1, "the type of lamps");
    const FileNumber lumens = lines.number("the lamps' lumens");
    static_cast<void>(above_zero(file, lumens, "the lamps' lumens"));
    if (count.value > 0.0) photometry.luminous_flux_lm = lumens.value;
    lines.skip(3, "colour, rendering and watts");
    return product_of_factors(file, lumens, factor) / 1000.0;
}

std::vector<std::vector<double>> next_planes(ValueLines& lines,
                                             std::size_t planes,
                                             std::size_t angles,
                                             double factor) {
    std::vector<std::vector<double>> columns(planes);
    for (std::vector<double>& column : columns) {
        for (std::size_t i = 0; i < angles; ++i) {
            column.push_back(
                intensity_of(lines.file(), lines.number("an intensity"), "an intensity", factor));
        }
    }
    lines.expect_end();
    return columns;
}

// 0 if the steps differ, as the format requires.
std::string step_text(const std::vector<double>& angles_rad) {
    constexpr double kSame_deg = 1e-9;
    const double step_deg =
        angles_rad.size() < 2 ? 0.0 : (angles_rad[1] - angles_rad[0]) * kDegreesPerRadian;
    for (std::size_t i = 2; i < angles_rad.size(); ++i) {
        const double other_deg = (angles_rad[i] - angles_rad[i - 1]) * kDegreesPerRadian;
        if (std::abs(other_deg - step_deg) > kSame_deg) return "0";
    }
    return fmt::format("{:.6g}", step_deg);
}

// The part of the table within 90 degrees of the axis.
BeamTable downward(BeamTable table) {
    constexpr double kRightAngle = 0.5 * std::numbers::pi;
    const std::size_t rows = table.vertical_rad.size();
    const auto beyond = std::ranges::upper_bound(table.vertical_rad, kRightAngle);
    if (beyond == table.vertical_rad.end()) return table;
    if (beyond == table.vertical_rad.begin()) return {};
    const auto kept = static_cast<std::size_t>(beyond - table.vertical_rad.begin());
    const double share = (kRightAngle - *(beyond - 1)) / (*beyond - *(beyond - 1));
    std::vector<double> intensity;
    for (std::size_t h = 0; h < table.horizontal_rad.size(); ++h) {
        const double* plane = &table.intensity[h * rows];
        intensity.insert(intensity.end(), plane, plane + kept);
        if (share > 0.0) intensity.push_back((1.0 - share) * plane[kept - 1] + share * plane[kept]);
    }
    table.vertical_rad.erase(beyond, table.vertical_rad.end());
    if (share > 0.0) table.vertical_rad.push_back(kRightAngle);
    table.intensity = std::move(intensity);
    return table;
}

std::string percent_text(double share) {
    return fmt::format("{:.4g}", 100.0 * share);
}

}  // namespace

PhotometricFile parse_eulumdat(const std::string& file_name, std::string_view bytes) {
    const std::string text = utf8_of(bytes);
    ValueLines lines(file_name, text);
    PhotometricFile photometry;
    lines.skip(2, "the manufacturer and the type");
    const std::size_t symmetry = lines.count("Isym, the symmetry", 0, 4);
    const std::size_t planes = next_plane_count(lines, symmetry);
    lines.skip(1, "the step of planes");
    const std::size_t angles =
        lines.count("Ng, the number of angles in a plane", 2, kMostTableNodes / planes);
    lines.skip(1, "the step of angles");
    lines.skip(5, "the report, name, number, file's name and date");
    lines.skip(11, "sizes and shares of flux");
    const double factor = next_lamps(lines, photometry);
    lines.skip(kDirectRatios, "direct ratios");
    const std::vector<FileNumber> turn = lines.numbers(planes, "a C angle");
    check_angles(file_name, turn, "a C angle", 0.0, 360.0);
    check_symmetry_angles(file_name, symmetry, turn);
    const std::vector<FileNumber> vertical = lines.numbers(angles, "a gamma angle");
    check_angles(file_name, vertical, "a gamma angle", 0.0, 180.0);

    const StoredPlanes stored = stored_planes(symmetry, planes);
    const auto columns = next_planes(lines, stored.count, angles, factor);
    photometry.table.vertical_rad = radians_of(vertical);
    if (symmetry == 1) {
        photometry.table.horizontal_rad = {0.0};
        photometry.table.intensity = columns.front();
        return photometry;
    }
    if (symmetry == 0 && turn.back().value == 360.0 && columns.back() != columns.front()) {
        fail_number(file_name,
                    turn.back(),
                    "a C angle",
                    "below 360 degrees, or the intensities of 0 repeated");
    }
    std::vector<TurnPlane> given;
    for (std::size_t i = 0; i < columns.size(); ++i)
        given.push_back({turn[(stored.first + i) % planes].value, columns[i]});
    if (symmetry == 2 || symmetry == 4) given = mirrored(std::move(given), 0.0);
    if (symmetry == 3 || symmetry == 4) given = mirrored(std::move(given), 90.0);
    set_turn(photometry.table, std::move(given));
    return photometry;
}

std::string eulumdat_text(const PhotometricFile& photometry, const std::string& file_name) {
    const BeamTable& table = photometry.table;
    if (table.angles != TableAngles::TypeC) {
        throw InputError("{}: found a table of type A or B; allowed in .ldt: type C", file_name);
    }
    const double emitted_lm = table_flux(table);
    const double flux_lm = photometry.luminous_flux_lm.value_or(emitted_lm);
    if (!(emitted_lm > 0.0 && flux_lm > 0.0)) {
        throw InputError(
            "{}: found a table without light; allowed in .ldt: intensities per 1000 lm", file_name);
    }
    const bool is_round = table.horizontal_rad.size() == 1;
    std::vector<double> turn = table.horizontal_rad;
    if (!is_round) turn.pop_back();  // 360 degrees is the same as 0

    std::string text;
    const auto add = [&text](std::string_view line) { text.append(line).append("\r\n"); };
    const auto add_times = [&add](int times, std::string_view line) {
        for (int i = 0; i < times; ++i) add(line);
    };
    add("");
    add(is_round ? "1" : "3");
    add(is_round ? "1" : "0");
    add(fmt::format("{}", turn.size()));
    add(step_text(turn));
    add(fmt::format("{}", table.vertical_rad.size()));
    add(step_text(table.vertical_rad));
    add_times(5, "");
    add_times(9, "0");
    add(percent_text(table_flux(downward(table)) / emitted_lm));
    add(percent_text(emitted_lm / flux_lm));
    add("1");
    add("0");
    add("1");
    add(photometry.luminous_flux_lm ? "1" : "-1");
    add("");
    add(fmt::format("{}", flux_lm));
    add_times(3, "0");
    add_times(kDirectRatios, "0");
    for (const double angle : turn) add(degrees_text(angle));
    for (const double angle : table.vertical_rad) add(degrees_text(angle));
    for (std::size_t i = 0; i < turn.size() * table.vertical_rad.size(); ++i)
        add(fmt::format("{}", table.intensity[i] / flux_lm * 1000.0));
    return text;
}

}  // namespace aphotic
