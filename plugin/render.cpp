// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/render.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/sha256.h"
#include "base/work_folder.h"
#include "image/exr.h"
#include "image/frame_check.h"
#include "image/png_frame.h"
#include "scene_gen/user_scene.h"
#include "scene_gen/veil_planes.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
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
        check_frame(image, wanted.width_px, wanted.height_px);
        return true;
    } catch (const RunError&) {
        return false;
    }
}

// Whether the same scene was rendered before, and its image is as recorded.
bool still_holds(const fs::path& folder,
                 const ManifestFrame& earlier,
                 const ManifestFrame& wanted,
                 const Manifest& manifest) {
    return earlier.done() && earlier.scene_sha256 == wanted.scene_sha256 &&
           fs::exists(image_path(folder, earlier)) &&
           sha256_of_file(image_path(folder, earlier)) == earlier.image_sha256 &&
           is_whole(image_path(folder, earlier), manifest);
}

// Records the images of the earlier run that are still valid.
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

// Removes the reference tracer's images, which next to a manifest would be taken for the render's.
void take_away_a_trace(const fs::path& folder) {
    if (!is_traced(folder / "image.exr") && !is_traced(folder / "spectral.exr")) return;
    for (const char* file : {"trace.json", "preview.png", "spectral.exr", "image.exr"})
        take_away(folder / file);
}

// Frames of the earlier run that this one does not have, and the images made from them.
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

// Renders these, and records each in the manifest when it is done.
void run_noted(const PovRay& povray,
               const fs::path& folder,
               const std::vector<ManifestFrame>& frames,
               const SceneFile& scene,
               const RunOptions& options,
               Manifest& manifest) {
    RunOptions run = options;
    run.scene = scene;
    if (manifest.png) {
        // A fog's light is limited to 1: without a surface in view, it is white.
        const bool has_fog = manifest.veil && manifest.veil->fog_m > 0.0;
        run.convert = [has_fog, fog = manifest.frames.back().name](const ManifestFrame& frame,
                                                                   const fs::path& image) {
            exr_of_png_frame(image,
                             has_fog && frame.name == fog ? White::IsWhite : White::IsClipped);
        };
    }
    run.checked = [&](const ManifestFrame& frame, const fs::path& image) {
        for (ManifestFrame& noted : manifest.frames) {
            if (noted.name == frame.name) noted.image_sha256 = sha256_of_file(image);
        }
        write_manifest(folder, manifest);
    };
    run_frames(povray, folder, frames, manifest.width_px, manifest.height_px, run);
}

// The digest of the user's scene for which scenes were written.
fs::path scene_note(const fs::path& folder) {
    return folder / "povray" / "scene.sha256";
}

void write_scenes_and_note(const fs::path& folder, const SceneSet& set) {
    write_scenes(folder, set);
    if (set.user_scene.path.empty()) {
        take_away(scene_note(folder));
    } else {
        write_text_file(scene_note(folder), set.user_scene.digest);
    }
}

// For scenes written earlier: the digest must be the same, or frames would show two scenes.
SceneFile scene_in(const fs::path& folder, const Manifest& manifest) {
    if (!manifest.scene) return {};
    SceneFile scene = scene_file_at(manifest.scene->file);
    const fs::path note = scene_note(folder);
    if (!fs::exists(note) || read_text_file(note) != scene.digest)
        throw InputError(
            "{}: found scenes made from an older {}; allowed: scenes from the current one, by "
            "`aphotic generate`",
            folder.string(),
            scene.path.string());
    return scene;
}

// POV-Ray's input for these frames: their scenes, the settings, and the includes.
void copy_scenes(const fs::path& from,
                 const fs::path& to,
                 const std::vector<ManifestFrame>& frames) {
    make_folder(to / "povray");
    const auto copy = [](const fs::path& source, const fs::path& place) {
        write_text_file(place, read_text_file(source));
    };
    for (const auto& entry : fs::directory_iterator(from / "povray")) {
        const fs::path extension = entry.path().extension();
        if (extension == ".inc" || extension == ".ini")
            copy(entry.path(), to / "povray" / entry.path().filename());
    }
    for (const ManifestFrame& frame : frames) copy(scene_path(from, frame), scene_path(to, frame));
}

enum class Frames { ToBeRendered, Done };

// For the bare floor it is computed beforehand; otherwise when the frames exist, one of which shows
// the distance that each pixel sees.
void note_veil(
    const fs::path& folder, const SceneSet& set, Frames frames, int threads, Manifest& manifest) {
    if (!set.scattering) return;
    if ((manifest.veil->fog_m > 0.0) != (frames == Frames::Done)) return;
    manifest.veil = write_veil(folder, *set.scattering, manifest, threads);
}

}  // namespace

RenderResult render(const PovRay& povray,
                    const fs::path& folder,
                    const SceneSet& set,
                    const RunOptions& options) {
    require_format(povray, set.manifest.frame_format());
    require_place_for_scenes(folder, set);
    make_folder(folder);
    RenderResult result{.manifest = set.manifest, .rendered = 0, .kept = 0};
    result.manifest.povray_version = povray.version;

    join_frames(folder);
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
    write_scenes_and_note(folder, set);
    note_veil(folder, set, Frames::ToBeRendered, options.jobs, result.manifest);
    write_manifest(folder, result.manifest);

    run_noted(povray, folder, missing, set.user_scene, options, result.manifest);
    note_veil(folder, set, Frames::Done, options.jobs, result.manifest);
    write_manifest(folder, result.manifest);
    return result;
}

RenderResult render_share(const PovRay& povray,
                          const fs::path& folder,
                          WorkShare share,
                          const RunOptions& options) {
    const Manifest whole = read_manifest(folder);
    require_format(povray, whole.frame_format());
    const SceneFile scene = scene_in(folder, whole);
    std::vector<ManifestFrame> frames = share_of(whole.frames, share);
    std::erase_if(frames, &ManifestFrame::done);
    const fs::path own = share_folder(folder, share);
    copy_scenes(folder, own, frames);
    RenderResult result{.manifest = whole};
    result.manifest.povray_version = povray.version;
    for (ManifestFrame& frame : result.manifest.frames) frame.image_sha256.clear();
    const std::optional<Manifest> earlier = earlier_manifest(own);
    if (earlier && earlier->povray_version == povray.version)
        keep_what_holds(own, *earlier, result.manifest);
    const std::size_t all = frames.size();
    std::erase_if(frames, [&](const ManifestFrame& frame) {
        return frame_named(result.manifest, frame.name)->done();
    });
    result.rendered = frames.size();
    result.kept = all - frames.size();
    write_manifest(own, result.manifest);
    run_noted(povray, own, frames, scene, options, result.manifest);
    return result;
}

std::size_t join_frames(const fs::path& folder) {
    const std::vector<fs::path> shares = share_folders(folder);
    if (shares.empty()) return 0;
    Manifest manifest = read_manifest(folder);
    std::size_t count = 0;
    for (const fs::path& share : shares) {
        const FolderLock lock(share, FolderUse::Write);
        const std::optional<Manifest> made = earlier_manifest(share);
        if (!made) continue;
        const auto has_frame = [](const Manifest& one) {
            return std::ranges::any_of(one.frames, &ManifestFrame::done);
        };
        if (!has_frame(manifest)) manifest.povray_version = made->povray_version;
        if (has_frame(*made) && made->povray_version != manifest.povray_version)
            throw InputError(
                "{}: found frames by POV-Ray {}; allowed: by {}, like the others. Remove it and "
                "render its frames again",
                share.string(),
                made->povray_version,
                manifest.povray_version);
        for (ManifestFrame& frame : manifest.frames) {
            const std::optional<ManifestFrame> own = frame_named(*made, frame.name);
            if (frame.done() || !own || !still_holds(share, *own, frame, manifest)) continue;
            make_folder(folder / "povray" / "frames");
            make_folder(folder / "povray" / "logs");
            fs::rename(image_path(share, *own), image_path(folder, frame));
            fs::rename(log_path(share, *own), log_path(folder, frame));
            frame.image_sha256 = own->image_sha256;
            ++count;
        }
        write_manifest(folder, manifest);
        fs::remove_all(share / "povray");
        remove_joined(share, {manifest_path(share).filename()});
    }
    return count;
}

Manifest generate(const fs::path& folder, const SceneSet& set, int threads) {
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
        // A frame rendered by hand, which was never recorded, may be this one.
        const bool may_be_this =
            before && !before->done() && before->scene_sha256 == frame.scene_sha256;
        if (!may_be_this) take_away(image_path(folder, frame));
    }
    take_away_what_is_past(folder, earlier, manifest);
    write_scenes_and_note(folder, set);
    note_veil(folder, set, Frames::ToBeRendered, threads, manifest);
    write_manifest(folder, manifest);
    return manifest;
}

}  // namespace aphotic
