// SPDX-License-Identifier: BSD-3-Clause
#include "cli/output_folder.h"
#include "cli/option_words.h"

#include "base/disk_space.h"
#include "base/error.h"
#include "base/free_memory.h"
#include "base/words.h"
#include "cli/terminal.h"
#include "scene_gen/camera_rays.h"
#include "scene_gen/include_library.h"

#include <algorithm>
#include <optional>

namespace aphotic::cli {

namespace fs = std::filesystem;

namespace {

const fs::path kPovrayTemporary = "/tmp";  // POV-Ray 3.7 uses no other

std::uint64_t parsed_bytes(const SceneSet& scenes) {
    std::uint64_t bytes = scenes.camera ? bytes_of_rays(*scenes.camera) : 0;
    for (const IncludeFile& file : include_library()) bytes += file.text.size();
    std::size_t longest = 0;
    for (const FrameScene& scene : scenes.scenes) longest = std::max(longest, scene.sdl.size());
    return bytes + longest;
}

std::uint64_t scenes_bytes(const SceneSet& scenes) {
    constexpr std::uint64_t kDiskBlock_bytes = 4096;   // the size of the smallest file
    constexpr std::uint64_t kWavelength_bytes = 1024;  // of the manifest, twice the observed size
    std::uint64_t bytes = scenes.ini.size() + 3 * kDiskBlock_bytes +
                          kWavelength_bytes * scenes.manifest.wavelengths.size();
    for (const FrameScene& scene : scenes.scenes) bytes += scene.sdl.size() + kDiskBlock_bytes;
    for (const IncludeFile& file : include_library()) bytes += file.text.size() + kDiskBlock_bytes;
    if (scenes.camera) bytes += bytes_of_rays(*scenes.camera) + kDiskBlock_bytes;
    return bytes;
}

// The folder's scenes have their includes, complete; scenes all have the same length.
std::uint64_t parsed_bytes(const fs::path& folder) {
    std::uint64_t includes = 0;
    std::uint64_t longest = 0;
    for (const auto& file : fs::directory_iterator(folder / "povray")) {
        if (file.path().extension() == ".inc") includes += file.file_size();
        if (file.path().extension() == ".pov") longest = std::max(longest, file.file_size());
    }
    return includes + longest;
}

// An unreadable manifest is reported by the render.
std::optional<Manifest> earlier_manifest(const fs::path& folder) {
    if (folder.empty() || !fs::exists(manifest_path(folder))) return std::nullopt;
    try {
        return read_manifest(folder);
    } catch (const InputError&) {
        return std::nullopt;
    }
}

std::size_t frames_to_render(const SceneSet& scenes, const fs::path& folder) {
    const std::optional<Manifest> earlier = earlier_manifest(folder);
    if (!earlier) return scenes.manifest.frames.size();
    const auto is_there = [&](const ManifestFrame& frame) {
        return std::ranges::any_of(earlier->frames, [&](const ManifestFrame& before) {
            return before.done() && before.name == frame.name &&
                   before.scene_sha256 == frame.scene_sha256 &&
                   fs::exists(image_path(folder, before));
        });
    };
    return scenes.manifest.frames.size() -
           static_cast<std::size_t>(std::ranges::count_if(scenes.manifest.frames, is_there));
}

}  // namespace

void add_needs_option(CLI::App& app, bool& ignore_needs) {
    add_flag(app, "--ignore-needs", ignore_needs);
}

void require_room(const ResourceNeeds& needs, const fs::path& folder, bool ignore_needs) {
    if (ignore_needs) return;
    const FreeDisk free{.folder_bytes = free_disk_bytes(folder),
                        .temporary_bytes = free_disk_bytes(kPovrayTemporary),
                        .is_one_disk = on_one_disk(folder, kPovrayTemporary)};
    const std::string lacking = shortage(needs, free, folder.string());
    if (lacking.empty()) return;
    throw RunError(
        "{}. Nothing was started; --ignore-needs starts anyway, since images often compress",
        lacking);
}

ResourceNeeds needs_of(const SceneSet& scenes, const fs::path& folder, int jobs) {
    return render_needs({.size = image_size(scenes.manifest),
                         .frames = frames_to_render(scenes, folder),
                         .scenes_bytes = scenes_bytes(scenes),
                         .parsed_bytes = parsed_bytes(scenes),
                         .jobs = jobs});
}

int jobs_that_fit(const ResourceNeeds& needs, int jobs) {
    const std::uint64_t free_bytes = free_memory_bytes();
    const int fitting = jobs_with_memory(needs, free_bytes, jobs);
    if (static_cast<std::uint64_t>(jobs) * needs.job_memory_bytes > free_bytes) {
        warn(
            "renders {} at a time, since POV-Ray takes up to {} of memory for each, and {} is free",
            counted(static_cast<std::size_t>(fitting), "frame"),
            bytes_in_words(needs.job_memory_bytes),
            bytes_in_words(free_bytes));
    }
    return fitting;
}

int require_place_and_room(const SceneSet& scenes,
                           const fs::path& folder,
                           int jobs,
                           bool ignore_needs) {
    require_place_for_scenes(folder, scenes);
    const ResourceNeeds needs = needs_of(scenes, folder, jobs);
    require_room(needs, folder, ignore_needs);
    return jobs_that_fit(needs, jobs);
}

ResourceNeeds needs_of_share(const fs::path& folder, WorkShare share, int jobs) {
    const Manifest whole = read_manifest(folder);
    const fs::path own = share_folder(folder, share);
    const std::vector<ManifestFrame> frames = share_of(whole.frames, share);
    const auto missing = std::ranges::count_if(frames, [&](const ManifestFrame& frame) {
        return !frame.done() && !fs::exists(image_path(own, frame));
    });
    return render_needs({.size = image_size(whole),
                         .frames = static_cast<std::size_t>(missing),
                         .scenes_bytes = 0,
                         .parsed_bytes = parsed_bytes(folder),
                         .jobs = jobs});
}

ResourceNeeds needs_of_scenes(const SceneSet& scenes) {
    return {.folder_bytes = scenes_bytes(scenes)};
}

ImageSize image_size(const Manifest& manifest) {
    return {.width_px = manifest.width_px,
            .height_px = manifest.height_px,
            .wavelengths = manifest.wavelengths.size(),
            .frames = manifest.frame_format()};
}

}  // namespace aphotic::cli
