// SPDX-License-Identifier: BSD-3-Clause
//
// Terms of POV-Ray's scene description language: numbers that read back to the same bits, and texts
// that cannot be read as anything else.
#pragma once

#include <Eigen/Core>

#include <array>
#include <string>
#include <string_view>

namespace aphotic {

// The light in a frame's channels red, green and blue.
using Channels = std::array<double, 3>;

[[nodiscard]] std::string sdl_number(double value);
[[nodiscard]] std::string sdl_vector(const Channels& v);

// A point or a direction of the sled's frame, in POV-Ray's frame.
[[nodiscard]] std::string sdl_point(const Eigen::Vector3d& sled);

// The part of a text that POV-Ray's language can represent: ASCII, without quotation marks,
// backslashes and line ends. POV-Ray itself turns any letter beyond ASCII into a blank, and then
// treats texts that differ only in such letters as equal.
[[nodiscard]] std::string sdl_letters(std::string_view text);

// sdl_letters in quotes. Characters that would end the string, escape from it or break the line are
// replaced.
[[nodiscard]] std::string sdl_text(std::string_view text);

// For a comment, which ends with its line.
[[nodiscard]] std::string sdl_comment(std::string_view text);

}  // namespace aphotic
