// SPDX-License-Identifier: BSD-3-Clause
//
// Whether the folder that a command writes to has room for all that may come, and the machine
// memory for the POV-Rays that it runs (scene_gen/resource_needs.h).
#pragma once

#include "base/work_folder.h"
#include "scene_gen/resource_needs.h"
#include "scene_gen/scene_set.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <vector>

namespace aphotic::cli {

void add_needs_option(CLI::App& app, bool& ignore_needs);

// Throws RunError, which says what is needed and what is free, unless it is to be ignored.
void require_room(const ResourceNeeds& needs,
                  const std::filesystem::path& folder,
                  bool ignore_needs);

// Of a render of these scenes into the folder. Frames that an earlier run left there of the same
// scenes are kept, and take no more room. Without a folder, none are there.
[[nodiscard]] ResourceNeeds needs_of(const SceneSet& scenes,
                                     const std::filesystem::path& folder,
                                     int jobs);

// As many of the jobs as have memory, and a warning where these are fewer.
[[nodiscard]] int jobs_that_fit(const ResourceNeeds& needs, int jobs);

// Before a render: whether the folder may take these scenes, and has room for what comes of them.
// Returns the jobs that fit.
[[nodiscard]] int require_place_and_room(const SceneSet& scenes,
                                         const std::filesystem::path& folder,
                                         int jobs,
                                         bool ignore_needs);

// Of a share of the frames of scenes that are in the folder, into the share's own.
[[nodiscard]] ResourceNeeds needs_of_share(const std::filesystem::path& folder,
                                           WorkShare share,
                                           int jobs);

// Of scenes and manifest alone.
[[nodiscard]] ResourceNeeds needs_of_scenes(const SceneSet& scenes);

[[nodiscard]] ImageSize image_size(const Manifest& manifest);

}  // namespace aphotic::cli
