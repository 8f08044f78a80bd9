// SPDX-License-Identifier: BSD-3-Clause
//
// Images of any format that OpenImageIO reads, and its filters.
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

// One plane of from_width x from_height samples at another size, the image's edges in place, by one
// of OpenImageIO's filters, such as "lanczos3". An unknown filter is an InputError.
struct PlaneSize {
    int width_px = 0;
    int height_px = 0;
};
[[nodiscard]] std::vector<float> resized(std::vector<float> plane,
                                         PlaneSize from,
                                         PlaneSize to,
                                         const std::string& filter);

}  // namespace aphotic::cli
