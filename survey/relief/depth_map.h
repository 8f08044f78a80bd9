// SPDX-License-Identifier: BSD-3-Clause
//
// The depth of each pixel of an image, as other programs write it, one file per image:
//
//   .exr   channel Z, or the only one    metres          DeepSeaRenderer, renderers
//   .npy   NumPy's array, rows first     metres          oplab_pipeline
//   .bin   COLMAP's NAME.geometric.bin   its unit        COLMAP, whose unit must be metres
//   .png, .tif ... of integers           millimetres     SUCRe, stereo sleds
//
// Depth is along the camera's axis, or the length of the path from the entrance pupil. 0, NaN,
// infinities, the largest integer and values over kMostDepth metres are holes: NaN here.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace aphotic {

inline constexpr float kMostDepth = 1e5F;

struct DepthMap {
    int width_px = 0;
    int height_px = 0;
    std::vector<float> depth_m{};  // row by row; NaN: unknown
};

// unit_m: of the file's numbers; empty: as above. An InputError, which names the file, if it cannot
// be read or has no channel of depths.
[[nodiscard]] DepthMap read_depth_map(const std::filesystem::path& file,
                                      std::optional<double> unit_m = {});

// At another size, the image's edges in place: linear between the four nearest, or the nearest one
// if one of these is a hole or they differ by more than kDepthJump of themselves.
inline constexpr float kDepthJump = 0.02F;
[[nodiscard]] DepthMap resized(const DepthMap& map, int width_px, int height_px);

// The file of an image among those of a folder: the image's name without extension, or with it, or
// after `depth_`. `place` may also be a file, for a single image. An InputError if there is none,
// or more than one.
[[nodiscard]] std::filesystem::path depth_file(const std::filesystem::path& place,
                                               const std::filesystem::path& image);

}  // namespace aphotic
