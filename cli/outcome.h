// SPDX-License-Identifier: BSD-3-Clause
//
// From finished frames to pictures, and what is said about them.
#pragma once

#include "image/preview.h"
#include "spectral/manifest.h"
#include "spectral/quadrature_fit.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <array>
#include <filesystem>
#include <string>

namespace aphotic::cli {

void add_preview_options(CLI::App& app, PreviewOptions& options);

// JSON as it is printed.
[[nodiscard]] std::string dumped(const nlohmann::ordered_json& json);

// Where the images are, their size, and the least, mean and largest signal of each channel.
[[nodiscard]] nlohmann::ordered_json outcome_of(const std::filesystem::path& folder,
                                                const CameraImage& image);

// Integrates the frames of `folder` into `images`, the same folder or another: then the signals
// alone. Writes image.exr, spectral.exr and preview.png, and returns what there is to say of them.
[[nodiscard]] nlohmann::ordered_json integrate_folder(const std::filesystem::path& folder,
                                                      const Manifest& manifest,
                                                      const PreviewOptions& preview,
                                                      const std::filesystem::path& images);

// What a plan or a manifest promises, per channel: error, amplification and promise. Null where a
// scene of the user's voids it; no_promise in the JSON then says why.
void put_promises(nlohmann::ordered_json& json, const Manifest& manifest);

// Why there is no promise, for people.
void print_no_promise(const std::vector<std::string>& reasons);

// The same for people: of a whole integration, or of its images alone.
void print_outcome(const nlohmann::ordered_json& outcome);
void print_signals(const nlohmann::ordered_json& outcome);

}  // namespace aphotic::cli
