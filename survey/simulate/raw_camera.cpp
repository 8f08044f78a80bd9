// SPDX-License-Identifier: BSD-3-Clause
#include "survey/simulate/raw_camera.h"

#include "base/error.h"
#include "survey/images/camera_numbers.h"
#include "survey/simulate/random_draw.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace aphotic {

RawCamera raw_camera_of(const Readout& readout, bool is_mono) {
    RawCamera camera;
    if (is_mono) camera.mosaic = Mosaic::Mono;
    if (!readout.bayer.empty()) camera.mosaic = mosaic_named(readout.bayer).value();
    if ((camera.mosaic == Mosaic::Mono) != is_mono) {
        throw InputError("bayer: found {}; allowed: {}",
                         mosaic_name(camera.mosaic),
                         is_mono ? "mono, since the rig's response has one channel"
                                 : "a colour pattern, since the rig's response has three channels");
    }
    camera.black_dn = readout.black_level_dn.value_or(camera.black_dn);
    camera.white_dn = readout.white_level_dn.value_or(camera.white_dn);
    camera.read_noise_e = readout.read_noise_e.value_or(camera.read_noise_e);
    camera.shot = shot_of(readout);
    constexpr double kMost = std::numeric_limits<std::uint16_t>::max();
    if (camera.white_dn <= camera.black_dn || camera.white_dn > kMost) {
        throw InputError("white_level_dn: found {}; allowed: over the black level, {}, to {}",
                         camera.white_dn,
                         camera.black_dn,
                         kMost);
    }
    const double numbers = camera.white_dn - camera.black_dn;
    if (readout.gain_dn_per_e && !readout.saturation_e) {
        camera.gain_dn_per_e = *readout.gain_dn_per_e;
        camera.saturation_e = numbers / camera.gain_dn_per_e;
    } else {
        camera.saturation_e = readout.saturation_e.value_or(camera.saturation_e);
        camera.gain_dn_per_e = readout.gain_dn_per_e.value_or(numbers / camera.saturation_e);
    }
    return camera;
}

nlohmann::ordered_json to_json(const RawCamera& camera) {
    nlohmann::ordered_json json{{"bayer", mosaic_name(camera.mosaic)},
                                {"black_level_dn", camera.black_dn},
                                {"white_level_dn", camera.white_dn},
                                {"gain_dn_per_e", camera.gain_dn_per_e},
                                {"read_noise_e", camera.read_noise_e},
                                {"saturation_e", camera.saturation_e},
                                {"electrons_per_signal", camera.electrons_per_signal}};
    constexpr double kMillisecondsPerSecond = 1e3;
    if (camera.shot.time_s) json["exposure_ms"] = *camera.shot.time_s * kMillisecondsPerSecond;
    if (camera.shot.iso) json["iso"] = *camera.shot.iso;
    if (camera.shot.f_number) json["f_number"] = *camera.shot.f_number;
    return json;
}

std::vector<std::uint16_t> raw_samples(const CameraImage& image,
                                       const RawCamera& camera,
                                       std::optional<NoiseOf> noise) {
    // Seeded unlike the flight.
    RandomSource random =
        noise ? random_of(noise->seed + 0x9E3779B97F4A7C15U, noise->image) : RandomSource();
    const std::size_t pixels = image.samples.size() / kChannels;
    std::vector<std::uint16_t> samples;
    samples.reserve(pixels);
    for (int row = 0; row < image.height_px; ++row) {
        for (int column = 0; column < image.width_px; ++column) {
            const auto c = static_cast<std::size_t>(channel_at(camera.mosaic, column, row));
            double electrons =
                camera.electrons_per_signal * image.samples[c * pixels + samples.size()];
            if (noise) electrons = poisson(random, electrons);
            electrons = std::min(electrons, camera.saturation_e);
            if (noise) electrons += camera.read_noise_e * normal(random);
            const double number = camera.black_dn + camera.gain_dn_per_e * electrons;
            samples.push_back(
                static_cast<std::uint16_t>(std::clamp(std::round(number), 0.0, camera.white_dn)));
        }
    }
    return samples;
}

}  // namespace aphotic
