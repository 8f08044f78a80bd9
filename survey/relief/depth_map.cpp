// SPDX-License-Identifier: BSD-3-Clause
#include "survey/relief/depth_map.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/npy_file.h"
#include "image/any_image.h"
#include "image/exr.h"
#include "image/image_size.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

constexpr double kMillimetre = 1e-3;
constexpr std::array kExtensions{
    ".exr", ".npy", ".png", ".tif", ".tiff", ".bin", ".geometric.bin", ".photometric.bin"};

DepthMap read_exr(const fs::path& file) {
    return from_named_exr(file, [&](ExrReader& reader) {
        const std::vector<std::string> channels = reader.channels();
        const auto z = std::ranges::find(channels, "Z");
        if (z == channels.end() && channels.size() > 1)
            throw InputError("{}: found the channels {}; allowed: Z, or one alone",
                             file.string(),
                             fmt::join(channels, ", "));
        const std::string name = z == channels.end() ? channels.front() : *z;
        return DepthMap{.width_px = reader.width_px(),
                        .height_px = reader.height_px(),
                        .depth_m = reader.planes(std::span(&name, 1))};
    });
}

DepthMap read_array(const fs::path& file) {
    NpyArray array = read_npy(file);
    while (array.shape.size() > 2 && array.shape.back() == 1) array.shape.pop_back();
    if (array.shape.size() != 2)
        throw InputError("{}: found an array of shape ({}); allowed: rows and columns",
                         file.string(),
                         fmt::join(array.shape, ", "));
    return {.width_px = static_cast<int>(array.shape[1]),
            .height_px = static_cast<int>(array.shape[0]),
            .depth_m = std::move(array.samples)};
}

// "64&48&1&", then floats, row by row.
DepthMap read_colmap(const fs::path& file) {
    static_assert(std::endian::native == std::endian::little);
    const std::string text = read_text_file(file);
    std::istringstream head(text);
    DepthMap map;
    int channels = 0;
    std::array<char, 3> ends{};
    head >> map.width_px >> ends[0] >> map.height_px >> ends[1] >> channels >> ends[2];
    const bool is_head = head && std::ranges::all_of(ends, [](char end) { return end == '&'; }) &&
                         map.width_px > 0 && map.height_px > 0 && channels == 1;
    const auto start = is_head ? static_cast<std::size_t>(head.tellg()) : std::size_t{0};
    const std::size_t pixels = is_head ? size_of(map.width_px) * size_of(map.height_px) : 0;
    if (!is_head || text.size() - start != pixels * sizeof(float))
        throw InputError("{}: not a COLMAP depth map; allowed: width&height&1& and as many floats",
                         file.string());
    map.depth_m.resize(pixels);
    std::memcpy(map.depth_m.data(), text.data() + start, pixels * sizeof(float));
    return map;
}

// Whether the file's numbers are integers.
bool read_image(const fs::path& file, DepthMap& map) {
    const AnyImage image = open_any_image(file);
    if (image.channels.size() != 1)
        throw InputError("{}: found the channels {}; allowed: one of depths",
                         file.string(),
                         names_of(image.channels));
    map = {.width_px = image.width_px, .height_px = image.height_px, .depth_m = image.samples(0)};
    if (image.full_scale == 0.0) return false;
    for (float& depth : map.depth_m)
        depth = depth >= 1.0F ? 0.0F : depth * static_cast<float>(image.full_scale);
    return true;
}

}  // namespace

DepthMap read_depth_map(const fs::path& file, std::optional<double> unit_m) {
    DepthMap map;
    bool is_integer = false;
    const std::string extension = file.extension().string();
    if (extension == ".exr")
        map = read_exr(file);
    else if (extension == ".npy")
        map = read_array(file);
    else if (extension == ".bin")
        map = read_colmap(file);
    else
        is_integer = read_image(file, map);
    const auto scale = static_cast<float>(unit_m.value_or(is_integer ? kMillimetre : 1.0));
    for (float& depth_m : map.depth_m) {
        depth_m *= scale;
        if (!(depth_m > 0.0F && depth_m <= kMostDepth))
            depth_m = std::numeric_limits<float>::quiet_NaN();
    }
    return map;
}

DepthMap resized(const DepthMap& map, int width_px, int height_px) {
    if (map.width_px == width_px && map.height_px == height_px) return map;
    DepthMap found{.width_px = width_px, .height_px = height_px, .depth_m = {}};
    found.depth_m.reserve(size_of(width_px) * size_of(height_px));
    const auto at = [&](int column, int row) {
        column = std::clamp(column, 0, map.width_px - 1);
        row = std::clamp(row, 0, map.height_px - 1);
        return map.depth_m[size_of(row) * size_of(map.width_px) + size_of(column)];
    };
    for (int row = 0; row < height_px; ++row) {
        const float y = (static_cast<float>(row) + 0.5F) * static_cast<float>(map.height_px) /
                            static_cast<float>(height_px) -
                        0.5F;
        const int j = static_cast<int>(std::floor(y));
        const float v = y - static_cast<float>(j);
        for (int column = 0; column < width_px; ++column) {
            const float x = (static_cast<float>(column) + 0.5F) * static_cast<float>(map.width_px) /
                                static_cast<float>(width_px) -
                            0.5F;
            const int i = static_cast<int>(std::floor(x));
            const float u = x - static_cast<float>(i);
            const std::array<float, 4> four{at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)};
            const auto [least, most] = std::ranges::minmax(four);
            const bool is_smooth =
                std::ranges::all_of(four, [](float depth) { return std::isfinite(depth); }) &&
                most - least <= kDepthJump * least;
            found.depth_m.push_back(is_smooth
                                        ? (1.0F - v) * std::lerp(four[0], four[1], u) +
                                              v * std::lerp(four[2], four[3], u)
                                        : at(i + (u >= 0.5F ? 1 : 0), j + (v >= 0.5F ? 1 : 0)));
        }
    }
    return found;
}

fs::path depth_file(const fs::path& place, const fs::path& image) {
    if (fs::is_regular_file(place)) return place;
    const std::string stem = image.stem().string();
    const std::string name = image.filename().string();
    std::vector<fs::path> found;
    for (const std::string& start : {stem, "depth_" + stem, name}) {
        for (const char* extension : kExtensions) {
            const fs::path file = place / (start + extension);
            if (fs::is_regular_file(file) && !fs::equivalent(file, image) &&
                std::ranges::find(found, file) == found.end())
                found.push_back(file);
        }
    }
    if (found.size() == 1) return found.front();
    if (found.empty())
        throw InputError(
            "found no depth map for it in {}; allowed: {}.exr, .npy, .png, depth_{}.png, "
            "{}.geometric.bin",
            place.string(),
            stem,
            stem,
            name);
    throw InputError("found {} depth maps for it, {} and {}; allowed: one",
                     found.size(),
                     found[0].string(),
                     found[1].string());
}

}  // namespace aphotic
