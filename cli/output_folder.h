// SPDX-License-Identifier: BSD-3-Clause
//
// Whether the folder that a command writes to has room for all that may come
// (scene_gen/disk_estimate.h).
#pragma once

#include "base/work_folder.h"
#include "scene_gen/disk_estimate.h"
#include "scene_gen/scene_set.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <vector>

namespace aphotic::cli {

void add_needs_option(CLI::App& app, bool& ignore_needs);

// Throws RunError, which says what is needed and what is free, unless it is to be ignored.
void require_room(const DiskNeeds& needs, const std::filesystem::path& folder, bool ignore_needs);

// Of a render of these scenes into the folder. Frames that an earlier run left there of the same
// scenes are kept, and take no more room. Without a folder, none are there.
[[nodiscard]] DiskNeeds needs_of(const SceneSet& scenes,
                                 const std::filesystem::path& folder,
                                 int jobs);

// Before a render: whether the folder may take these scenes, and has room for what comes of them.
void require_place_and_room(const SceneSet& scenes,
                            const std::filesystem::path& folder,
                            int jobs,
                            bool ignore_needs);

// Of a share of the frames of scenes that are there, into its own folder.
[[nodiscard]] DiskNeeds needs_of_share(const Manifest& whole,
                                       const std::filesystem::path& own,
                                       WorkShare share,
                                       int jobs);

// Of scenes and manifest alone.
[[nodiscard]] DiskNeeds needs_of_scenes(const SceneSet& scenes);

[[nodiscard]] ImageSize image_size(const Manifest& manifest);

}  // namespace aphotic::cli
