// SPDX-License-Identifier: BSD-3-Clause
//
// From frames to images: the camera's signal and each pixel's spectral radiance.
//
//   L(lambda_j) = 2^-e_j F_j
//   S_c         = sum_j w_cj L(lambda_j)        plus the veil's, where the water scatters
//
// in one loop over the frames' layers (manifest.h). A veil by POV-Ray has layers of its own; any
// other is read from a file.
//
// F_j   sample of the frame of wavelength j, in its channel      e_j   the frame's exposure
// L     spectral radiance       [unit of the lamp's spectrum / (m^2 sr)]
// w_cj  weight of wavelength j in channel c: band width times response, or fitted
// S_c   signal of channel c, linear; nothing else scales it
//
// Scaling by a power of two is exact; the sums run in double, in the frames' order, so the
// images do not depend on threads. Frames are read in blocks of rows: memory is a few images,
// whatever the number of wavelengths.
#pragma once

#include "image/output_images.h"
#include "spectral/manifest.h"

#include <filesystem>
#include <functional>

namespace aphotic {

// How many rows of the image are in memory at a time.
[[nodiscard]] int rows_per_block(int width_px, std::size_t wavelengths);

// Called with the share of the work done, 0 to 1.
using ProgressReport = std::function<void(double)>;

// Reads the frames of folder and writes folder/image.exr and folder/spectral.exr. A frame that is
// missing, is not the one recorded in the manifest, or has a bad sample is a RunError.
CameraImage integrate(const std::filesystem::path& folder,
                      const Manifest& manifest,
                      const ProgressReport& report = {});

// Writes signals only, to images/image.exr, for the weights of another rig, whose radiance the
// frames do not hold. The veil, if the manifest has one, is veil_path(images).
CameraImage integrate_signals(const std::filesystem::path& folder,
                              const Manifest& manifest,
                              const std::filesystem::path& images,
                              const ProgressReport& report = {});

}  // namespace aphotic
