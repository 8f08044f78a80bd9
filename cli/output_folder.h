// SPDX-License-Identifier: BSD-3-Clause
//
// Whether the output folder has room for a command's files, and the machine memory for its POV-Ray
// processes (scene_gen/resource_needs.h).
#pragma once

#include "base/work_folder.h"
#include "scene_gen/resource_needs.h"
#include "scene_gen/scene_set.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <vector>

namespace aphotic::cli {

void add_needs_option(CLI::App& app, bool& ignore_needs);

// Throws RunError, with the required and the free space, unless the check is to be ignored.
void require_room(const ResourceNeeds& needs,
                  const std::filesystem::path& folder,
                  bool ignore_needs);

// For a render of these scenes into the folder. Frames of an earlier run for the same scenes are
// kept, and need no more room. Without a folder there are no such frames.
[[nodiscard]] ResourceNeeds needs_of(const SceneSet& scenes,
                                     const std::filesystem::path& folder,
                                     int jobs);

// The number of jobs that fit in memory, with a warning if it is smaller.
[[nodiscard]] int jobs_that_fit(const ResourceNeeds& needs, int jobs);

// Before a render: checks that the folder may receive these scenes, and has room for the results.
// Returns the number of jobs that fit.
[[nodiscard]] int require_place_and_room(const SceneSet& scenes,
                                         const std::filesystem::path& folder,
                                         int jobs,
                                         bool ignore_needs);

// For a share of the frames of the folder's scenes, into the share's own folder.
[[nodiscard]] ResourceNeeds needs_of_share(const std::filesystem::path& folder,
                                           WorkShare share,
                                           int jobs);

// For scenes and manifest only.
[[nodiscard]] ResourceNeeds needs_of_scenes(const SceneSet& scenes);

[[nodiscard]] ImageSize image_size(const Manifest& manifest);

}  // namespace aphotic::cli
