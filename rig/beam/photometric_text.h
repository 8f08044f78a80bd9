// SPDX-License-Identifier: BSD-3-Clause
//
// What the readers and writers of rig/beam/photometric_file.h share: numbers with their lines,
// angles in degrees that become radians and come back, and planes of type C that become a whole
// turn.
#pragma once

#include "rig/beam/beam_table.h"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

// Of one table. A file of 0.25 by 0.5 degrees has 519,841.
inline constexpr std::size_t kMostTableNodes = 4'000'000;

// Two angles of a table are no closer.
inline constexpr double kLeastAngleStep_deg = 1e-6;

// UTF-8 of a text that is UTF-8 or else Latin-1; without a byte order mark.
[[nodiscard]] std::string utf8_of(std::string_view text);

[[nodiscard]] std::string_view without_blanks(std::string_view text);

// A word of the file, for a message.
[[nodiscard]] std::string shown_word(std::string_view word);

[[nodiscard]] std::optional<double> finite_decimal(std::string_view word);

// A number as a message places it: "file:line: what: found ...; allowed: ...".
struct FileNumber {
    double value = 0.0;
    std::size_t line = 0;
};
[[nodiscard]] FileNumber number_of(const std::string& file,
                                   std::size_t line,
                                   std::string_view word,
                                   std::string_view what);
[[noreturn]] void fail_number(const std::string& file,
                              const FileNumber& number,
                              std::string_view what,
                              std::string_view allowed);

// A whole number from least to most.
[[nodiscard]] std::size_t count_of(const std::string& file,
                                   const FileNumber& number,
                                   std::string_view what,
                                   std::size_t least,
                                   std::size_t most);

[[nodiscard]] double above_zero(const std::string& file,
                                const FileNumber& number,
                                std::string_view what);

// An intensity of the file times a factor: finite, 0 or more.
[[nodiscard]] double intensity_of(const std::string& file,
                                  const FileNumber& number,
                                  std::string_view what,
                                  double factor);

// A file's factor of all intensities, above 0, times the others: no overflow, and no digit lost.
[[nodiscard]] double product_of_factors(const std::string& file,
                                        const FileNumber& last,
                                        double others);

// Strictly rising and within a range.
void check_angles(const std::string& file,
                  const std::vector<FileNumber>& angles_deg,
                  std::string_view what,
                  double least_deg,
                  double most_deg);

// A plane of type C: intensities over the angle off the axis.
struct TurnPlane {
    double at_deg = 0.0;  // about the axis
    std::vector<double> intensity;
};

// Adds the mirror image of each plane in the plane through the axis at mirror_deg, and at 180
// degrees from it.
[[nodiscard]] std::vector<TurnPlane> mirrored(std::vector<TurnPlane> planes, double mirror_deg);

// Whether the step from the last of these angles to 360 degrees is the one between all of them, so
// that the plane at 360, which is the one at 0, was but left out.
[[nodiscard]] bool closes_evenly(const std::vector<FileNumber>& angles_deg);

// The planes in order from 0 to 360 degrees, both there. Between the last and the first of the turn
// lies nothing but what is linear between them, which says what is at 0 where no plane is.
void set_turn(BeamTable& table, std::vector<TurnPlane> planes);

[[nodiscard]] double radians_of(double deg);
[[nodiscard]] std::vector<double> radians_of(const std::vector<FileNumber>& angles_deg);

// The shortest text of degrees that is read as this angle again, to the last bit. Of an angle that
// is that of no degrees, the nearest.
[[nodiscard]] std::string degrees_text(double angle_rad);

}  // namespace aphotic
