// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/sdl.h"

#include "rig/geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace aphotic {

// Seventeen significant digits carry a double through text unchanged.
std::string sdl_number(double value) {
    return fmt::format("{:.17g}", value);
}

std::string sdl_vector(const Channels& v) {
    return fmt::format("<{}, {}, {}>", sdl_number(v[0]), sdl_number(v[1]), sdl_number(v[2]));
}

std::string sdl_point(const Eigen::Vector3d& sled) {
    const Eigen::Vector3d pov = to_povray(sled);
    return sdl_vector({pov.x(), pov.y(), pov.z()});
}

std::string sdl_letters(std::string_view text) {
    std::string letters = sdl_comment(text);
    std::ranges::replace(letters, '"', '\'');
    std::ranges::replace(letters, '\\', '/');
    std::ranges::replace_if(
        letters, [](unsigned char c) { return c >= 0x80; }, '?');
    return letters;
}

std::string sdl_text(std::string_view text) {
    return fmt::format("\"{}\"", sdl_letters(text));
}

std::string sdl_comment(std::string_view text) {
    std::string safe(text);
    std::replace_if(
        safe.begin(), safe.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
    return safe;
}

}  // namespace aphotic
