// SPDX-License-Identifier: BSD-3-Clause
#include "rig/beam/ies_file.h"

#include "base/csv.h"
#include "base/error.h"
#include "base/words.h"
#include "rig/beam/photometric_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace aphotic {

namespace {

constexpr std::size_t kMostTilts = 1000;
constexpr std::size_t kMostLamps = 1'000'000;
constexpr double kMostLumens = 1e12;

// A file's lines, in order.
class LineReader {
  public:
    explicit LineReader(std::string_view text) : rest_(text) {}

    [[nodiscard]] bool is_at_end() const { return rest_.empty(); }
    [[nodiscard]] std::size_t line() const { return line_; }
    [[nodiscard]] std::string_view rest() const { return rest_; }

    std::string_view next() {
        ++line_;
        return trimmed(next_line(rest_));
    }

  private:
    std::string_view rest_;
    std::size_t line_ = 0;
};

// Numbers separated by blanks, commas and line ends.
class NumberReader {
  public:
    NumberReader(std::string file, std::string_view text, std::size_t first_line)
        : file_(std::move(file)), rest_(text), line_(first_line) {}

    FileNumber next(std::string_view what) {
        const std::string_view word = next_word();
        if (word.empty()) {
            fail_at_line(file_, line_, fmt::format("the file ends where {} should be", what));
        }
        return number_of(file_, line_, word, what);
    }

    std::vector<FileNumber> next(std::size_t count, std::string_view what) {
        std::vector<FileNumber> numbers;
        for (std::size_t i = 0; i < count; ++i) numbers.push_back(next(what));
        return numbers;
    }

    void expect_end() {
        const std::string_view word = next_word();
        if (word.empty()) return;
        fail_at_line(file_,
                     line_,
                     fmt::format("found {} after the last number; allowed: as many numbers as the "
                                 "counts of angles require",
                                 shown_word(word)));
    }

    [[nodiscard]] const std::string& file() const { return file_; }

  private:
    std::string_view next_word() {
        constexpr std::string_view kBetween(" \t\r\n\f\v,\x1A\0", 9);  // DOS ends a text with 0x1A
        const std::size_t first = std::min(rest_.find_first_not_of(kBetween), rest_.size());
        line_ += static_cast<std::size_t>(std::ranges::count(rest_.substr(0, first), '\n'));
        rest_.remove_prefix(first);
        const std::string_view word = rest_.substr(0, rest_.find_first_of(kBetween));
        rest_.remove_prefix(word.size());
        return word;
    }

    std::string file_;
    std::string_view rest_;
    std::size_t line_;
};

// The year of the edition, from a line that names one. A file of 1986 has free text instead.
std::optional<int> edition_in(const std::string& file, std::size_t number, std::string_view line) {
    std::string name;
    for (const char c : lower_case(std::string(line))) {
        if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) name += c;
    }
    std::string_view year = name;
    const auto skip = [&year](std::string_view word) {
        const bool is_there = year.starts_with(word);
        if (is_there) year.remove_prefix(word.size());
        return is_there;
    };
    skip("ansi");
    if (!skip("iesna") && !skip("ies")) return std::nullopt;
    const bool names_standard = skip("lm63");
    constexpr std::array kYears{1986, 1991, 1995, 2002, 2019};
    for (const int known : kYears) {
        const std::string digits = fmt::to_string(known);
        if (year == digits || year == digits.substr(2)) return known;
    }
    if (!names_standard) return std::nullopt;
    fail_at_line(file,
                 number,
                 fmt::format("found the edition {}; allowed: LM-63 of 1986, 1991, 1995, 2002 or "
                             "2019",
                             shown_word(line)));
}

// The text after TILT= in a line that starts so.
std::optional<std::string_view> tilt_in(std::string_view line) {
    constexpr std::string_view kTilt = "tilt";
    if (lower_case(std::string(line.substr(0, kTilt.size()))) != kTilt) return std::nullopt;
    line = trimmed(line.substr(kTilt.size()));
    if (!line.starts_with('=')) return std::nullopt;
    return trimmed(line.substr(1));
}

// A table of factors for light over the lamp's tilt; only constant ones are accepted.
void pass_over_constant_tilt(NumberReader& numbers) {
    const std::string& file = numbers.file();
    static_cast<void>(numbers.next("the lamp's geometry"));
    const std::size_t count =
        count_of(file, numbers.next("the number of tilts"), "the number of tilts", 1, kMostTilts);
    static_cast<void>(numbers.next(count, "tilt"));
    for (const FileNumber& factor : numbers.next(count, "the factor of a tilt")) {
        if (factor.value == 1.0) continue;
        fail_number(file,
                    factor,
                    "the factor of a tilt (TILT)",
                    "1; lamps whose light changes with tilt are not modelled");
    }
}

struct IesHeader {
    std::size_t verticals = 0;
    std::size_t horizontals = 0;
    TableAngles type = TableAngles::TypeC;
    double factor = 1.0;  // of all intensities
};

// The thirteen numbers before the angles.
IesHeader next_header(NumberReader& numbers, int edition, PhotometricFile& photometry) {
    const std::string& file = numbers.file();
    const auto count = [&](std::string_view what, std::size_t least, std::size_t most) {
        return count_of(file, numbers.next(what), what, least, most);
    };
    IesHeader header;
    const auto take_factor = [&](const FileNumber& factor, std::string_view what) {
        static_cast<void>(above_zero(file, factor, what));
        header.factor = product_of_factors(file, factor, header.factor);
    };
    const std::size_t lamps = count("the number of lamps", 1, kMostLamps);
    const FileNumber lumens = numbers.next("lumens per lamp");
    if ((lumens.value < 0.0 && lumens.value != -1.0) || lumens.value > kMostLumens) {
        fail_number(file,
                    lumens,
                    "lumens per lamp",
                    fmt::format("0 to {}, or -1 for absolute photometry", kMostLumens));
    }
    if (lumens.value > 0.0) photometry.luminous_flux_lm = static_cast<double>(lamps) * lumens.value;
    take_factor(numbers.next("the multiplier of candela"), "the multiplier of candela");
    header.verticals = count("the number of vertical angles", 2, kMostTableNodes);
    const FileNumber horizontals = numbers.next("the number of horizontal angles");
    header.horizontals = count_of(file,
                                  horizontals,
                                  "the number of horizontal angles",
                                  1,
                                  kMostTableNodes / header.verticals);
    constexpr std::array kTypes{TableAngles::TypeC, TableAngles::TypeB, TableAngles::TypeA};
    header.type = kTypes.at(count("the type of photometry", 1, 3) - 1);
    static_cast<void>(count("the type of units", 1, 2));
    for (const std::string_view side : {"the width", "the length", "the height"})
        static_cast<void>(numbers.next(side));
    take_factor(numbers.next("the ballast factor"), "the ballast factor");
    const FileNumber lamp_factor = numbers.next("the ballast-lamp photometric factor");
    if (edition <= 1995) take_factor(lamp_factor, "the ballast-lamp photometric factor");
    static_cast<void>(numbers.next("the input watts"));
    return header;
}

using Columns = std::vector<std::vector<double>>;

// The symmetry given by the horizontal angles of type C.
void unfold_turn(BeamTable& table,
                 const std::string& file,
                 const std::vector<FileNumber>& horizontal,
                 const Columns& columns) {
    const double first = horizontal.front().value;
    const double last = horizontal.back().value;
    if (horizontal.size() == 1 && first == 0.0) {
        table.horizontal_rad = {0.0};
        table.intensity = columns.front();
        return;
    }
    std::vector<TurnPlane> planes;
    for (std::size_t i = 0; i < columns.size(); ++i)
        planes.push_back({horizontal[i].value, columns[i]});
    if (first == 0.0 && last == 90.0) return set_turn(table, mirrored(mirrored(planes, 0.0), 90.0));
    if (first == 0.0 && last == 180.0) return set_turn(table, mirrored(planes, 0.0));
    if (first == 90.0 && last == 270.0) return set_turn(table, mirrored(planes, 90.0));
    if (first == 0.0 && last == 360.0) {
        if (columns.back() != columns.front()) {
            fail_at_line(file,
                         horizontal.back().line,
                         "found candela at 360 degrees that differ from those at 0; allowed: the "
                         "same, since it is one plane");
        }
        return set_turn(table, planes);
    }
    if (first == 0.0 && closes_evenly(horizontal)) return set_turn(table, planes);
    fail_at_line(
        file,
        horizontal.front().line,
        fmt::format(
            "horizontal angles: found {} to {} degrees; allowed for type C: 0 alone, 0 to 90, 0 to "
            "180, 90 to 270, or 0 to 360 (360 may be omitted where steps are even)",
            first,
            last));
}

// -x for each angle x that is not 0, then the angles themselves.
std::vector<double> with_negatives(const std::vector<double>& angles) {
    std::vector<double> both;
    for (auto angle = angles.rbegin(); angle != angles.rend(); ++angle)
        if (*angle != 0.0) both.push_back(-*angle);
    both.insert(both.end(), angles.begin(), angles.end());
    return both;
}

template <typename Value>
std::vector<Value> with_mirror_image(const std::vector<Value>& values) {
    std::vector<Value> both(values.rbegin(), values.rend() - 1);
    both.insert(both.end(), values.begin(), values.end());
    return both;
}

// Types A and B: mirrors the part above the horizon to below it, and the right part to the left.
void unfold_quadrants(BeamTable& table, Columns columns) {
    if (table.vertical_rad.front() == 0.0) {
        table.vertical_rad = with_negatives(table.vertical_rad);
        for (std::vector<double>& column : columns) column = with_mirror_image(column);
    }
    if (table.horizontal_rad.front() == 0.0) {
        table.horizontal_rad = with_negatives(table.horizontal_rad);
        columns = with_mirror_image(columns);
    }
    for (const std::vector<double>& column : columns)
        table.intensity.insert(table.intensity.end(), column.begin(), column.end());
}

BeamTable next_table(NumberReader& numbers, const IesHeader& header) {
    const std::string& file = numbers.file();
    const bool is_c = header.type == TableAngles::TypeC;
    BeamTable table;
    table.angles = header.type;
    const std::vector<FileNumber> vertical = numbers.next(header.verticals, "a vertical angle");
    const std::vector<FileNumber> horizontal =
        numbers.next(header.horizontals, "a horizontal angle");
    check_angles(file, vertical, "a vertical angle", is_c ? 0.0 : -90.0, is_c ? 180.0 : 90.0);
    check_angles(file, horizontal, "a horizontal angle", is_c ? 0.0 : -90.0, is_c ? 360.0 : 90.0);
    table.vertical_rad = radians_of(vertical);
    Columns columns(header.horizontals);
    for (std::vector<double>& column : columns) {
        for (const FileNumber& candela : numbers.next(header.verticals, "candela"))
            column.push_back(intensity_of(file, candela, "candela", header.factor));
    }
    numbers.expect_end();
    if (is_c) {
        unfold_turn(table, file, horizontal, columns);
        return table;
    }
    if (horizontal.size() == 1) {
        fail_number(file, horizontal.front(), "the only horizontal angle", "two or more of them");
    }
    table.horizontal_rad = radians_of(horizontal);
    unfold_quadrants(table, std::move(columns));
    return table;
}

// Lines short enough for every reader, with whole words.
constexpr std::size_t kLineWidth = 100;

class LineWriter {
  public:
    void add(std::string_view word) {
        if (width_ > 0 && width_ + 1 + word.size() > kLineWidth) end_line();
        if (width_ > 0) text_ += ' ';
        text_ += word;
        width_ += word.size() + 1;
    }
    void end_line() {
        text_ += "\r\n";
        width_ = 0;
    }
    [[nodiscard]] const std::string& text() const { return text_; }

  private:
    std::string text_;
    std::size_t width_ = 0;
};

void add_numbers(LineWriter& lines, const std::vector<std::string>& numbers) {
    for (const std::string& number : numbers) lines.add(number);
    lines.end_line();
}

std::vector<std::string> degrees_texts(const std::vector<double>& angles_rad) {
    std::vector<std::string> texts;
    for (const double angle : angles_rad) texts.push_back(degrees_text(angle));
    return texts;
}

// Refuses a table that a reader would mirror.
void check_sides(const BeamTable& table, const std::string& file_name) {
    if (table.angles == TableAngles::TypeC) return;
    if (table.vertical_rad.front() != 0.0 && table.horizontal_rad.front() != 0.0) return;
    throw InputError(
        "{}: found a table of type A or B that begins at 0; allowed in .ies: one that begins below "
        "0, since one that begins at 0 is half of a symmetric table",
        file_name);
}

std::string number_text(double number) {
    return fmt::format("{}", number);
}

}  // namespace

PhotometricFile parse_ies(const std::string& file_name, std::string_view bytes) {
    const std::string text = utf8_of(bytes);
    LineReader lines(text);
    PhotometricFile photometry;
    int edition = 1986;
    std::optional<std::string_view> tilt_word;
    while (!tilt_word) {
        if (lines.is_at_end()) {
            fail_at_line(
                file_name,
                lines.line() + 1,
                "the file ends without a line TILT=; allowed: TILT=NONE, or TILT=INCLUDE with "
                "factors of 1");
        }
        const std::string_view line = lines.next();
        if (const auto named = edition_in(file_name, lines.line(), line)) {
            edition = *named;
        } else {
            tilt_word = tilt_in(line);
        }
    }
    const std::string word = lower_case(std::string(*tilt_word));
    NumberReader numbers(file_name, lines.rest(), lines.line() + 1);
    if (word == "include") {
        pass_over_constant_tilt(numbers);
    } else if (word != "none") {
        fail_at_line(file_name,
                     lines.line(),
                     fmt::format("found TILT={}, a table of the lamp's light over tilt; allowed: "
                                 "TILT=NONE, or INCLUDE with factors of 1",
                                 shown_word(*tilt_word)));
    }
    const IesHeader header = next_header(numbers, edition, photometry);
    photometry.table = next_table(numbers, header);
    return photometry;
}

std::string ies_text(const PhotometricFile& photometry, const std::string& file_name) {
    const BeamTable& table = photometry.table;
    check_sides(table, file_name);
    LineWriter lines;
    for (const std::string_view line : {"IESNA:LM-63-2002",
                                        "[TEST] not stated",
                                        "[TESTLAB] not stated",
                                        "[ISSUEDATE] not stated",
                                        "[MANUFAC] not stated",
                                        "TILT=NONE"}) {
        lines.add(line);
        lines.end_line();
    }
    const int type = table.angles == TableAngles::TypeC   ? 1
                     : table.angles == TableAngles::TypeB ? 2
                                                          : 3;
    add_numbers(lines,
                {"1",
                 photometry.luminous_flux_lm ? number_text(*photometry.luminous_flux_lm) : "-1",
                 "1",
                 fmt::format("{}", table.vertical_rad.size()),
                 fmt::format("{}", table.horizontal_rad.size()),
                 fmt::format("{}", type),
                 "2",
                 "0",
                 "0",
                 "0"});
    add_numbers(lines, {"1", "1", "0"});
    add_numbers(lines, degrees_texts(table.vertical_rad));
    add_numbers(lines, degrees_texts(table.horizontal_rad));
    const std::size_t rows = table.vertical_rad.size();
    for (std::size_t h = 0; h < table.horizontal_rad.size(); ++h) {
        for (std::size_t v = 0; v < rows; ++v)
            lines.add(number_text(table.intensity[h * rows + v]));
        lines.end_line();
    }
    return lines.text();
}

}  // namespace aphotic
