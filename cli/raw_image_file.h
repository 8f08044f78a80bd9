// SPDX-License-Identifier: BSD-3-Clause
//
// Raw images as files of any format that OpenImageIO reads, in the camera's own numbers less the
// black level.
#pragma once

#include "lightmap/raw_image.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <string>

namespace aphotic::cli {

struct RawFileOptions {
    std::string mosaic;  // "RGGB" and its kin; empty: R, G, B
    double black_level = 0.0;
};
void add_raw_file_options(CLI::App& app, RawFileOptions& options);

// An InputError when it cannot be read, or does not hold what the options say: one channel for a
// mosaic, else R, G and B. Of many images one is passed over: messages do not name it, for
// print_skipped() does.
[[nodiscard]] RawImage read_raw_image(const std::filesystem::path& file,
                                      const RawFileOptions& options);

// An InputError unless it is as large as the first.
void check_same_size(const RawImage& image, const RawImage& first);

void print_skipped(const std::filesystem::path& file, const std::string& why);

}  // namespace aphotic::cli
