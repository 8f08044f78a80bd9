// SPDX-License-Identifier: BSD-3-Clause
//
// From the camera's signal to what its file holds: a mosaic of 12 bits under RGGB filters.
//
//   e   = F S_c(pixel) / W                 electrons; c is the channel of the pixel's own filter
//   e'  = Poisson(e) + r Gauss             with noise; without it e' = e
//   DN  = round(black + (white - black) e' / F), kept within 0 and white
//
// S_c    the signal, linear                     W   the signal that fills the well
// F      the full well [electrons]              r   read noise [electrons]
#pragma once

#include "image/output_images.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace aphotic::survey {

struct RawCamera {
    double full_signal = 1.0;  // W
    int black = 64;
    int white = 4095;
    // As of an interline CCD with pixels of 6.45 um, a common kind in such cameras.
    double full_well_e = 15000.0;
    double read_noise_e = 8.0;
};

// Red at even rows and columns, blue at odd ones, green elsewhere. No seed: no noise.
[[nodiscard]] std::size_t rggb_channel(int column, int row);
[[nodiscard]] std::vector<std::uint16_t> raw_mosaic(const CameraImage& image,
                                                    const RawCamera& camera,
                                                    std::optional<std::uint64_t> noise_seed);

}  // namespace aphotic::survey
