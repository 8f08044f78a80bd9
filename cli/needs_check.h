// SPDX-License-Identifier: BSD-3-Clause
//
// Before any work: whether there is the disk that it may take (scene_gen/disk_estimate.h).
#pragma once

#include "scene_gen/disk_estimate.h"
#include "scene_gen/scene_set.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <string>

namespace aphotic::cli {

void add_needs_option(CLI::App& app, bool& ignore_needs);

// Throws RunError, which says what is needed and what is free, unless it is to be ignored.
void require_room(const DiskNeeds& needs, const std::filesystem::path& folder, bool ignore_needs);

// Of a render of these scenes into the folder. Frames that an earlier run left there of the same
// scenes are kept, and take no more room. Without a folder, none are there.
[[nodiscard]] DiskNeeds needs_of(const SceneSet& scenes,
                                 const std::filesystem::path& folder,
                                 int jobs);

// Of scenes and manifest alone.
[[nodiscard]] DiskNeeds needs_of_scenes(const SceneSet& scenes);

[[nodiscard]] ImageSize image_size(const Manifest& manifest);

}  // namespace aphotic::cli
