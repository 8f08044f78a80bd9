// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/render.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/sha256.h"
#include "image/frame_check.h"
#include "image/traced_image.h"
#include "scene_gen/user_scene.h"
#include "scene_gen/veil_planes.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <system_error>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

std::optional<ManifestFrame> frame_named(const Manifest& manifest, const std::string& name) {
    const auto found = std::ranges::find(manifest.frames, name, &ManifestFrame::name);
    return found == manifest.frames.end() ? std::nullopt : std::optional(*found);
}

std::optional<Manifest> earlier_manifest(const fs::path& folder) {
    if (!fs::exists(manifest_path(folder))) return std::nullopt;
    try {
        return read_manifest(folder);
    } catch (const InputError& error) {
        throw InputError("{}; nothing was changed. Remove that file to render everything again",
                         error.what());
    }
}

bool is_whole(const fs::path& image, const Manifest& wanted) {
    try {
        check_frame(image, wanted.width_px, wanted.height_px + wanted.rows_above());
        return true;
    } catch (const RunError&) {
        return false;
    }
}

// The same scene, drawn before, its image as it was noted.
bool still_holds(const fs::path& folder,
                 const ManifestFrame& earlier,
                 const ManifestFrame& wanted,
                 const Manifest& manifest) {
    return earlier.done() && earlier.scene_sha256 == wanted.scene_sha256 &&
           fs::exists(image_path(folder, earlier)) &&
           sha256_of_file(image_path(folder, earlier)) == earlier.image_sha256 &&
           is_whole(image_path(folder, earlier), manifest);
}

// Notes the images of the earlier run that still hold.
void keep_what_holds(const fs::path& folder, const Manifest& earlier, Manifest& manifest) {
    for (ManifestFrame& frame : manifest.frames) {
        const auto before = frame_named(earlier, frame.name);
        if (before && still_holds(folder, *before, frame, manifest)) {
            frame.image_sha256 = before->image_sha256;
        }
    }
}

void take_away(const fs::path& file) {
    std::error_code error;
    fs::remove(file, error);
    if (error) {
        throw RunError("{}: cannot be removed: {}", file.string(), error.message());
    }
}

// The reference tracer's, which beside a manifest would be taken for the render's.
void take_away_a_trace(const fs::path& folder) {
    if (!is_traced(folder / "image.exr") && !is_traced(folder / "spectral.exr")) return;
    for (const char* file : {"trace.json", "preview.png", "spectral.exr", "image.exr"})
        take_away(folder / file);
}

// Frames of the earlier run that this one does not have, and the images made of them.
void take_away_what_is_past(const fs::path& folder,
                            const std::optional<Manifest>& earlier,
                            const Manifest& wanted) {
    take_away_a_trace(folder);
    if (!earlier) return;
    for (const ManifestFrame& frame : earlier->frames) {
        if (frame_named(wanted, frame.name)) continue;
        take_away(scene_path(folder, frame));
        take_away(image_path(folder, frame));
        take_away(log_path(folder, frame));
    }
    const auto is_same = [](const ManifestFrame& a, const ManifestFrame& b) {
        return a.name == b.name && a.scene_sha256 == b.scene_sha256;
    };
    if (earlier->rig_sha256 == wanted.rig_sha256 &&
        std::ranges::equal(earlier->frames, wanted.frames, is_same)) {
        return;
    }
    for (const char* image : {"image.exr", "spectral.exr", "preview.png"})
        take_away(folder / image);
}

enum class Frames { ToBeRendered, Done };

// Of the bare floor it is known beforehand; else when the frames are there, of which one tells how
// far each pixel sees.
void note_veil(const fs::path& folder, const SceneSet& set, Frames frames, Manifest& manifest) {
    if (!set.scattering) return;
    if ((manifest.veil->fog_m > 0.0) != (frames == Frames::Done)) return;
    manifest.veil = write_veil(folder, *set.scattering, manifest);
}

}  // namespace

RenderResult render(const PovRay& povray,
                    const fs::path& folder,
                    const SceneSet& set,
                    const RunOptions& options) {
    require_place_for_scenes(folder, set);
    make_folder(folder);
    RenderResult result{.manifest = set.manifest, .rendered = 0, .kept = 0};
    result.manifest.povray_version = povray.version;

    const std::optional<Manifest> earlier = earlier_manifest(folder);
    if (earlier && earlier->povray_version == povray.version) {
        keep_what_holds(folder, *earlier, result.manifest);
    }
    std::vector<ManifestFrame> missing;
    std::ranges::remove_copy_if(
        result.manifest.frames, std::back_inserter(missing), &ManifestFrame::done);
    result.rendered = missing.size();
    result.kept = set.scenes.size() - missing.size();
    take_away_what_is_past(folder, earlier, result.manifest);
    for (const ManifestFrame& frame : missing) take_away(image_path(folder, frame));
    write_scenes(folder, set);
    note_veil(folder, set, Frames::ToBeRendered, result.manifest);
    write_manifest(folder, result.manifest);

    RunOptions run = options;
    run.scene_folder = set.scene_file.parent_path();
    run.one_at_a_time = set.scene_writes_files;
    run.checked = [&](const ManifestFrame& frame, const fs::path& image) {
        // A frame of a scene that was edited under way may be of either.
        if (!set.scene_file.empty()) require_unchanged(set.scene_file, set.scene_files_digest);
        for (ManifestFrame& noted : result.manifest.frames) {
            if (noted.name == frame.name) noted.image_sha256 = sha256_of_file(image);
        }
        write_manifest(folder, result.manifest);
    };
    run_frames(povray,
               folder,
               missing,
               set.manifest.width_px,
               set.manifest.height_px + set.manifest.rows_above(),
               run);
    note_veil(folder, set, Frames::Done, result.manifest);
    write_manifest(folder, result.manifest);
    return result;
}

Manifest generate(const fs::path& folder, const SceneSet& set) {
    require_place_for_scenes(folder, set);
    make_folder(folder);
    Manifest manifest = set.manifest;
    const std::optional<Manifest> earlier = earlier_manifest(folder);
    if (earlier) {
        manifest.povray_version = earlier->povray_version;
        keep_what_holds(folder, *earlier, manifest);
    }
    for (const ManifestFrame& frame : manifest.frames) {
        if (frame.done()) continue;
        const auto before = earlier ? frame_named(*earlier, frame.name) : std::nullopt;
        // One rendered by hand, which was never noted, may be this one.
        const bool may_be_this =
            before && !before->done() && before->scene_sha256 == frame.scene_sha256;
        if (!may_be_this) take_away(image_path(folder, frame));
    }
    take_away_what_is_past(folder, earlier, manifest);
    write_scenes(folder, set);
    note_veil(folder, set, Frames::ToBeRendered, manifest);
    write_manifest(folder, manifest);
    return manifest;
}

}  // namespace aphotic
