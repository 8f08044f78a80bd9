// SPDX-License-Identifier: BSD-3-Clause
//
// From frames to images: the camera's signal and the spectral radiance of every pixel.
//
//   L(lambda_j) = 2^-e_j F_j
//   S_c         = sum_j w_cj L(lambda_j)
//
// F_j   what the frame of wavelength j holds, in its channel      e_j   the frame's exposure
// L     spectral radiance       [unit of the lamp's spectrum / (m^2 sr)]
// w_cj  weight of wavelength j in channel c: band width times response, or fitted
// S_c   signal of channel c, linear; nothing else scales it
//
// Scaling by a power of two is exact; the sums run in double, in the manifest's order, so the
// images do not depend on threads. Frames are read in blocks of rows: memory is a few images,
// whatever the number of wavelengths.
//
// spectral.exr has the layout of Fichet, Pacanowski and Wilkie, "An OpenEXR layout for spectral
// images", JCGT 10(3), 2021: a float channel S0.<wavelength>nm per wavelength, with six decimals
// and a decimal comma, and R, G, B (here the camera's signal) beside them.
#pragma once

#include "spectral/manifest.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace aphotic {

// R, G, B planar: all rows of R, then of G, then of B.
struct CameraImage {
    int width_px = 0;
    int height_px = 0;
    std::vector<float> samples;
};

// Called with the share of the work that is done, 0 to 1.
using ProgressReport = std::function<void(double)>;

// Reads the frames of folder and writes folder/image.exr and folder/spectral.exr. A frame that
// is missing, not the one that the manifest notes, or holds a bad sample is a RunError.
CameraImage integrate(const std::filesystem::path& folder,
                      const Manifest& manifest,
                      const ProgressReport& report = {});

// The channel of a wavelength in spectral.exr, such as S0.550,000000nm.
[[nodiscard]] std::string spectral_channel(double lambda_nm);

}  // namespace aphotic
