// SPDX-License-Identifier: BSD-3-Clause
//
// Raw images as files of any format that OpenImageIO reads, in the camera's own numbers less the
// black level; and what was made of them as float EXR.
#pragma once

#include "lightmap/raw_image.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <string>

namespace aphotic::cli {

struct RawFileOptions {
    std::string mosaic;  // "RGGB" and its kin; empty: R, G, B
    double black = 0.0;
};
void add_raw_file_options(CLI::App& app, RawFileOptions& options);

// An InputError when it cannot be read, or does not hold what the options say: one channel for a
// mosaic, else R, G and B.
[[nodiscard]] RawImage read_raw_image(const std::filesystem::path& file,
                                      const RawFileOptions& options);

// An InputError unless it is as large as the first, and of its kind.
void check_same_size(const std::filesystem::path& file,
                     const RawImage& image,
                     const RawImage& first);

}  // namespace aphotic::cli
