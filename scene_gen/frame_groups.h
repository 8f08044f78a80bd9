// SPDX-License-Identifier: BSD-3-Clause
//
// The wavelengths that share a frame, and the refractive indices with which it is rendered.
//
// A frame has three channels, which POV-Ray never mixes, so three wavelengths share it. Behind a
// dispersing port this requires nearly equal wavelengths: a frame has one set of indices, and the
// image of a wavelength rendered with another's indices is shifted by
//
//   shift = |P(lambda_a) - P(lambda_b)| / |P(lambda_b) - P'(lambda_b)|     [pixel]
//
// P   intersection of the corner's ray with the plane at the sled's altitude across the
//     camera's axis            P'  the same, one pixel nearer to the image's middle
//
// Neighbouring wavelengths share a frame if the first and the last are shifted against each other
// by no more than a bound; the frame is rendered at the wavelength halfway.
#pragma once

#include "rig/rig.h"

#include <cstddef>
#include <span>
#include <vector>

namespace aphotic {

inline constexpr double kPixelShift = 0.25;

// Shift of lambda_a_nm's image against lambda_b_nm's at the corner [pixel]; 0 without a port.
[[nodiscard]] double corner_shift_px(const Rig& rig, double lambda_a_nm, double lambda_b_nm);

struct FrameGroup {
    std::size_t first = 0;  // of the wavelengths
    std::size_t count = 0;
    double index_nm = 0.0;  // of the frame's refractive indices
};

// Groups of at most per_frame wavelengths, which are increasing.
[[nodiscard]] std::vector<FrameGroup> frame_groups(const Rig& rig,
                                                   std::span<const double> lambda_nm,
                                                   int per_frame,
                                                   double pixel_shift);

}  // namespace aphotic
