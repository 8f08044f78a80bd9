// SPDX-License-Identifier: BSD-3-Clause
//
// The wavelengths that share a frame, and the refractive indices with which it is rendered.
//
// A frame has three channels, which POV-Ray never mixes, so three wavelengths share it. Behind a
// dispersing port this requires nearly equal wavelengths, since a frame has one set of indices:
// neighbours share a frame if the first and the last are shifted against each other by no more than
// a bound (light/dispersion.h), and the frame is rendered at the wavelength halfway.
#pragma once

#include "rig/rig.h"

#include <cstddef>
#include <span>
#include <vector>

namespace aphotic {

inline constexpr double kPixelShift = 0.25;

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
