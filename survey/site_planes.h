// SPDX-License-Identifier: BSD-3-Clause
//
// A raw image as planes of one kind of site each, so that what works on planes works on mosaics
// too: R, G and B of an image of colours; the one plane of a mono
// camera; of a mosaic the four sites of its pattern, row by row,
// each every other pixel across and down. A mosaic of odd width or height has one more site of the
// first.
#pragma once

#include "survey/raw_image.h"

#include <vector>

namespace aphotic {

struct SitePlane {
    int width_px = 0;
    int height_px = 0;
    std::vector<float> samples;  // row by row
};

[[nodiscard]] std::vector<SitePlane> site_planes(const RawImage& image);

// Puts the planes back where site_planes() took them from.
void put_site_planes(const std::vector<SitePlane>& planes, RawImage& image);

}  // namespace aphotic
