// SPDX-License-Identifier: BSD-3-Clause
//
// From the camera's signal to its file's contents, by the linear model of EMVA 1288 (release 4.0),
// whose dark signal is the black level:
//
//   mu = g S_c(pixel)                electrons; c is the channel of the pixel's own filter
//   e  = min(Poisson(mu), saturation_e) + read_noise_e N(0, 1)
//   DN = round(black + K e), kept within 0 and white
//
// S_c  the signal, linear        g  electrons of a signal of 1        K  gain [DN per electron]
//
// Without noise e = min(mu, saturation_e). For even light the mean is thus black + K mu, and the
// variance K^2 (read_noise_e^2 + mu) + 1/12, that of rounding; without light it is that of read
// noise and rounding. Dark current and differences from pixel to pixel (DSNU, PRNU) are omitted.
#pragma once

#include "image/camera_image.h"
#include "image/image_tags.h"
#include "rig/rig.h"
#include "survey/images/raw_image.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace aphotic {

struct RawCamera {
    Mosaic mosaic = Mosaic::Rggb;
    double black_dn = 64.0;
    double white_dn = 4095.0;  // of 12 bits
    // Like an interline CCD with pixels of 6.45 um, common in such cameras; a full well gives the
    // largest number.
    double gain_dn_per_e = 4031.0 / 15000.0;
    double read_noise_e = 8.0;
    double saturation_e = 15000.0;
    double electrons_per_signal = 1.0;  // g
    ShotExposure shot{};                // for its files' Exif
};

// Defaults are as above; a missing gain or saturation follows from the other: a full well gives
// white. An InputError if white is not above black or not a 16-bit number, for a mosaic with a mono
// camera, or for mono with a colour camera.
[[nodiscard]] RawCamera raw_camera_of(const Readout& readout, bool is_mono = false);

[[nodiscard]] nlohmann::ordered_json to_json(const RawCamera& camera);

// Row by row; for a mono camera the signal is that of red. noise: the survey's seed and the image's
// number, on which alone it depends; empty: no noise.
struct NoiseOf {
    std::uint64_t seed = 0;
    int image = 0;
};
[[nodiscard]] std::vector<std::uint16_t> raw_samples(const CameraImage& image,
                                                     const RawCamera& camera,
                                                     std::optional<NoiseOf> noise);

}  // namespace aphotic
