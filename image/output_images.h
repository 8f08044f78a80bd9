// SPDX-License-Identifier: BSD-3-Clause
//
// The images that both a render and a trace write to their folder, block by block:
//
//   image.exr     the camera's signal: float R, G, B
//   spectral.exr  one float channel per wavelength, and R, G, B; omitted without wavelengths
//
// spectral.exr has the layout of Fichet, Pacanowski and Wilkie, "An OpenEXR layout for spectral
// images", JCGT 10(3), 2021: a channel S0.<wavelength>nm per wavelength, with six decimals and a
// decimal comma.
#pragma once

#include "image/camera_image.h"
#include "image/exr.h"

#include <filesystem>
#include <future>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace aphotic {

// The signals of an image.exr or a spectral.exr.
[[nodiscard]] CameraImage read_signals(const std::filesystem::path& file);

// A wavelength's channel name in spectral.exr, such as S0.550,000000nm.
[[nodiscard]] std::string spectral_channel(double lambda_nm);

class OutputImages {
  public:
    OutputImages(const std::filesystem::path& folder,
                 int width_px,
                 int height_px,
                 std::span<const double> lambda_nm,
                 const ExrAttributes& attributes);

    // The next rows: planes R, G, B, then one per wavelength. Returns at once; compression runs in
    // parallel with the caller.
    void write_rows(int rows, std::vector<float> samples);

    // Renames both files into place. Returns the camera's signal.
    [[nodiscard]] CameraImage finish();

  private:
    CameraImage image_;
    int next_row_ = 0;
    ExrWriter image_file_;
    std::optional<ExrWriter> spectral_file_;
    std::future<void> writing_;  // last, to be joined before the files are destroyed
};

}  // namespace aphotic
