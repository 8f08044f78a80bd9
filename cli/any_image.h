// SPDX-License-Identifier: BSD-3-Clause
//
// Images of any format that OpenImageIO reads.
//
// OpenImageIO brings some two hundred libraries with it, which take 0.3 s and 100 MB to load: a
// part of the command by itself, aphotic_any_image.so, loads it when such an image is asked for.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace aphotic::cli {

struct AnyImage {
    int width_px = 0;
    int height_px = 0;
    std::vector<std::string> channels;
    // The samples of one channel, rows from the top, as stored, integers scaled to 0..1.
    std::function<std::vector<float>(std::size_t channel)> samples;
};

// An image that cannot be read is an InputError; a program installed without the part, a RunError.
[[nodiscard]] AnyImage open_any_image(const std::filesystem::path& file);

}  // namespace aphotic::cli
