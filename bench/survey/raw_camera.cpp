// SPDX-License-Identifier: BSD-3-Clause
#include "bench/survey/raw_camera.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace aphotic::survey {

std::size_t rggb_channel(int column, int row) {
    return static_cast<std::size_t>(column % 2 + row % 2);
}

std::vector<std::uint16_t> raw_mosaic(const CameraImage& image,
                                      const RawCamera& camera,
                                      std::optional<std::uint64_t> noise_seed) {
    std::mt19937_64 random(noise_seed.value_or(0));
    std::normal_distribution<double> read_noise(0.0, camera.read_noise_e);
    const auto pixels = image.samples.size() / kChannels;
    std::vector<std::uint16_t> mosaic;
    mosaic.reserve(pixels);
    for (int row = 0; row < image.height_px; ++row) {
        for (int column = 0; column < image.width_px; ++column) {
            const float signal = image.samples[rggb_channel(column, row) * pixels + mosaic.size()];
            double electrons = camera.full_well_e * signal / camera.full_signal;
            if (noise_seed) {
                std::poisson_distribution<int> shots(std::max(electrons, 1e-9));
                electrons = shots(random) + read_noise(random);
            }
            const double number =
                camera.black + (camera.white - camera.black) * electrons / camera.full_well_e;
            mosaic.push_back(static_cast<std::uint16_t>(
                std::clamp(std::round(number), 0.0, static_cast<double>(camera.white))));
        }
    }
    return mosaic;
}

}  // namespace aphotic::survey
