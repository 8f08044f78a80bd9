// SPDX-License-Identifier: BSD-3-Clause
//
// Shared by the readers and writers of rig/beam/photometric_file.h: numbers with their lines,
// angles converted between degrees and radians, and planes of type C expanded to a full turn.
#pragma once

#include "rig/beam/beam_table.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

// The limit for one table. A file of 0.25 by 0.5 degrees has 519,841.
inline constexpr std::size_t kMostTableNodes = 4'000'000;

// The least distance between two angles of a table.
inline constexpr double kLeastAngleStep_deg = 1e-6;

// The text as UTF-8, from UTF-8 or else Latin-1; without a byte order mark.
[[nodiscard]] std::string utf8_of(std::string_view text);

// A word of the file, as shown in messages.
[[nodiscard]] std::string shown_word(std::string_view word);

// An error about a number: "file:line: what: found ...; allowed: ...".
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

// A file's factor for all intensities, above 0, times the others, without overflow or loss of
// digits.
[[nodiscard]] double product_of_factors(const std::string& file,
                                        const FileNumber& last,
                                        double others);

// Strictly increasing and within a range.
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

// Adds the mirror image of each plane about the plane through the axis at mirror_deg, and at 180
// degrees from it.
[[nodiscard]] std::vector<TurnPlane> mirrored(std::vector<TurnPlane> planes, double mirror_deg);

// Whether the step from the last of these angles to 360 degrees equals all others, so that the
// plane at 360, equal to that at 0, was only omitted.
[[nodiscard]] bool closes_evenly(const std::vector<FileNumber>& angles_deg);

// The planes in order from 0 to 360 degrees, both included. Values are linear between the last and
// the first plane of the turn, which gives the value at 0 if there is no plane at 0.
void set_turn(BeamTable& table, std::vector<TurnPlane> planes);

[[nodiscard]] double radians_of(double deg);
[[nodiscard]] std::vector<double> radians_of(const std::vector<FileNumber>& angles_deg);

// The shortest text in degrees that reads back as exactly this angle; if no degrees do, the
// nearest.
[[nodiscard]] std::string degrees_text(double angle_rad);

}  // namespace aphotic
