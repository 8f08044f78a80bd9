// SPDX-License-Identifier: BSD-3-Clause
//
// Words of POV-Ray's scene description language: numbers that read back to the same bits, texts
// that cannot be anything but texts.
#pragma once

#include <Eigen/Core>

#include <array>
#include <string>
#include <string_view>

namespace aphotic {

// What a frame's channels red, green and blue hold.
using Channels = std::array<double, 3>;

[[nodiscard]] std::string sdl_number(double value);
[[nodiscard]] std::string sdl_vector(const Channels& v);

// A point or a direction of the sled's frame, in POV-Ray's.
[[nodiscard]] std::string sdl_point(const Eigen::Vector3d& sled);

// What a text in POV-Ray's language can hold of this one: ASCII, without quotation marks,
// backslashes and line ends. POV-Ray itself makes a blank of any letter beyond ASCII, and then
// takes texts that differ in such letters alone for equal.
[[nodiscard]] std::string sdl_letters(std::string_view text);

// sdl_letters in quotes. What would end it, escape from it or break the line is replaced.
[[nodiscard]] std::string sdl_text(std::string_view text);

// For a comment, which ends with its line.
[[nodiscard]] std::string sdl_comment(std::string_view text);

}  // namespace aphotic
