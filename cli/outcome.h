// SPDX-License-Identifier: BSD-3-Clause
//
// From finished frames to pictures, and what is said about it: the end of `render` and the whole
// of `integrate`.
#pragma once

#include "spectral/manifest.h"
#include "spectral/preview.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <filesystem>

namespace aphotic::cli {

void add_preview_options(CLI::App& app, PreviewOptions& options);

// Writes image.exr, spectral.exr and preview.png, and returns what there is to say of them.
[[nodiscard]] nlohmann::ordered_json integrate_folder(const std::filesystem::path& folder,
                                                      const Manifest& manifest,
                                                      const PreviewOptions& preview);

// The same for people.
void print_outcome(const nlohmann::ordered_json& outcome);

}  // namespace aphotic::cli
