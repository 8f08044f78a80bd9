// SPDX-License-Identifier: BSD-3-Clause
#include "image/frame_check.h"

#include "base/error.h"
#include "image/exr.h"

#include <algorithm>
#include <vector>

namespace aphotic {

namespace fs = std::filesystem;

void check_samples(const fs::path& file,
                   const std::string& channel,
                   std::span<const float> samples,
                   int width_px,
                   int first_row) {
    // Written so that NaN fails.
    const auto is_good = [](float value) { return value >= 0.0F && value < kLargestHalf; };
    const auto bad = std::find_if_not(samples.begin(), samples.end(), is_good);
    if (bad == samples.end()) return;
    const auto index = bad - samples.begin();
    throw RunError("{}: channel {} is {} at column {}, row {}; allowed: 0 to below {}",
                   file.string(),
                   channel,
                   *bad,
                   index % width_px,
                   first_row + index / width_px,
                   kLargestHalf);
}

void check_size(
    const fs::path& file, int found_width_px, int found_height_px, int width_px, int height_px) {
    if (found_width_px == width_px && found_height_px == height_px) return;
    throw RunError("{}: found {} x {} pixels; allowed: {} x {}",
                   file.string(),
                   found_width_px,
                   found_height_px,
                   width_px,
                   height_px);
}

void check_frame(const fs::path& file, int width_px, int height_px) {
    constexpr int kRows = 64;
    ExrReader frame(file);
    check_size(file, frame.width_px(), frame.height_px(), width_px, height_px);
    const std::vector<std::string> channels{"R", "G", "B"};
    for (int row = 0; row < height_px; row += kRows) {
        const int rows = std::min(kRows, height_px - row);
        const auto plane = static_cast<std::size_t>(rows) * static_cast<std::size_t>(width_px);
        std::vector<float> samples(channels.size() * plane);
        frame.read_rows(row, rows, channels, samples);
        for (std::size_t c = 0; c < channels.size(); ++c) {
            const auto part = std::span(samples).subspan(c * plane, plane);
            check_samples(file, channels[c], part, width_px, row);
        }
    }
}

}  // namespace aphotic
