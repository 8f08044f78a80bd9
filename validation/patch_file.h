// SPDX-License-Identifier: BSD-3-Clause
//
// The rectangles of an image that show patches of known colour: CSV with a header row, columns in
// any order, possibly among others.
//
//   patch,x,y,w,h,reference
//   panel fore,120,80,40,40,0.18
//
// x, y, w, h  pixels, from 0 at the image's top left
// reference   the patch's colour; may be omitted:
//               grey          grey, of unknown reflectance
//               0.18          grey of this reflectance
//               66.2 14.5 17  a colour in CIELAB under D65
//               light-skin    a patch of the colour chart (spectral/colour_chart.h)
//
// Empty lines and lines that begin with # are skipped. An error is an InputError that names the
// line.
#pragma once

#include "spectral/colour_difference.h"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aphotic {

struct Patch {
    std::string name;
    int x_px = 0;
    int y_px = 0;
    int width_px = 0;
    int height_px = 0;
    std::string reference{};  // as written; patches of the same reference are of one kind
    bool is_grey = false;
    std::optional<Lab> lab{};  // empty: unknown
    std::size_t line = 0;
};

// name is for messages.
[[nodiscard]] std::vector<Patch> parse_patches(const std::string& name, std::string_view text);

}  // namespace aphotic
