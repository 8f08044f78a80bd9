// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/scene_set.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/sha256.h"
#include "image/exr.h"
#include "image/frame_check.h"
#include "rig/camera/lens_model.h"
#include "rig/geometry_signature.h"
#include "scene_gen/camera_rays.h"
#include "scene_gen/include_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <span>
#include <string>

namespace aphotic {

void require_light_that_counts(std::span<const PlannedWavelength> wavelengths,
                               double frame_error,
                               FrameFormat format) {
    // At this level, a pixel 64 times darker still has full precision; in a PNG, one 4 times
    // darker.
    const double well_log2 = format == FrameFormat::Exr ? -8.0 : -4.0;
    const int held = held_log2(format);
    const auto peak_log2 = [](const PlannedWavelength& w) {
        return std::log2(w.radiance_bound) + w.exposure_log2;
    };
    for (std::size_t c = 0; c < kChannels; ++c) {
        const auto signal = [c](const PlannedWavelength& w) {
            return std::abs(w.weight[c]) * w.radiance_bound;
        };
        double most = 0.0;
        for (const PlannedWavelength& w : wavelengths) most = std::max(most, signal(w));
        const auto counts = [&](const PlannedWavelength& w) {
            return signal(w) > frame_error * most;
        };
        if (std::ranges::none_of(wavelengths, [&](const PlannedWavelength& w) {
                return counts(w) && peak_log2(w) >= well_log2;
            }))
            continue;
        for (const PlannedWavelength& w : wavelengths) {
            if (!counts(w) || peak_log2(w) >= held) continue;
            throw InputError(
                "found light of at most {:.1e} at {} nm, fainter than frames can hold, which "
                "counts in {} with a weight of {:.1e}; allowed: wavelengths that frames can hold, "
                "or of no weight",
                w.radiance_bound,
                w.lambda_nm,
                kChannelNames[c],
                w.weight[c]);
        }
    }
}

std::array<double, kChannels> lamp_signal(const Rig& rig, const LightFamily& family) {
    constexpr double kError = 1e-6;
    const std::vector<WeightedWavelength> wavelengths =
        reference_grid(rig.camera.sensor, family, rig.camera.range, kError);
    std::array<double, kChannels> signal{};
    for (const WeightedWavelength& w : wavelengths) {
        for (const Strobe& strobe : rig.strobes) {
            const double flux = strobe.power * strobe.spectrum.at(w.lambda_nm);
            for (std::size_t c = 0; c < kChannels; ++c) signal[c] += flux * w.weight[c];
        }
    }
    return signal;
}

namespace {

// In the order of PlanMethod.
constexpr std::array kMethodNames{"fitted", "equal bands", "listed"};

ManifestScene noted(const UserScene& scene, const LightFamily& family) {
    ManifestScene note{.file = scene.file.path.string(),
                       .sha256 = scene.digest,
                       .materials = {},
                       .shortest_path_m = family.shortest_path_m,
                       .longest_path_m = family.longest_path_m};
    for (const NamedSpectrum& material : scene.materials) note.materials.push_back(material.name);
    return note;
}

// All texts that the scenes include.
std::string include_text() {
    std::string text;
    for (const IncludeFile& file : include_library()) text += file.text;
    return text;
}

}  // namespace

SceneSet make_scene_set(const Rig& rig, const RenderPlan& plan) {
    SceneSet set;
    Manifest& manifest = set.manifest;
    manifest.wavelengths = plan.wavelengths;
    const std::vector<LampGrid> lamps = scene_lamps(rig, plan.wavelengths, plan.scene);
    set.scenes = make_scenes(rig, lamps, plan.scene, manifest.wavelengths);
    set.ini = render_ini(rig, plan.scene);
    if (rig.camera.lens) set.camera = rig.camera;
    const UserScene* own = plan.scene.user_scene.get();
    if (own != nullptr) set.user_scene = own->file;
    const std::string around = set.ini + include_text() + (own != nullptr ? own->digest : "") +
                               (rig.camera.lens ? lens_model_signature(*rig.camera.lens) : "");
    manifest.aphotic_version = APHOTIC_VERSION;
    manifest.rig_title = rig.title;
    manifest.rig_sha256 = rig.digest;
    manifest.width_px = rig.camera.width_px;
    manifest.height_px = rig.camera.height_px;
    if (plan.scene.format == FrameFormat::Png16) manifest.png.emplace();
    if (rig.camera.vignetting) {
        manifest.camera.emplace();
        set.vignetting = vignetting_plane(rig.camera);
        manifest.camera->vignetting_sha256 = sha256_of_floats(set.vignetting);
    }
    if (const auto& veil = plan.scene.povray_veil) {
        ManifestPovrayVeil& note = manifest.veil.emplace().povray.emplace();
        note.samples = veil->sampling.samples;
        for (const PhaseFunction& lobe : veil->sampling.lobes) note.lobes.push_back(lobe.name);
        note.takes_surfaces_off = own != nullptr;
        note.error = veil->error;
    } else if (rig.water.scatters()) {
        set.scattering = rig;
        manifest.veil = ManifestVeil{.fog_m = fog_m(rig, plan.scene)};
    }
    manifest.geometry = geometry_signature(own != nullptr ? rig_of_scene(rig, *own) : rig);
    for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
        manifest.strobes.push_back({.name = rig.strobes[s].name,
                                    .lamps_across = lamps[s].across,
                                    .lamps_along = lamps[s].along});
    }
    if (own != nullptr) manifest.scene = noted(*own, plan.family);
    manifest.method = kMethodNames.at(static_cast<std::size_t>(plan.method));
    manifest.tolerance = plan.tolerance;
    manifest.frame_error = plan.frame_error;
    manifest.quality = plan.quality;
    manifest.no_promise = plan.no_promise;
    manifest.lamp_signal = lamp_signal(rig, plan.family);
    for (const FrameScene& scene : set.scenes) {
        // Settings and includes affect pixels as the scene does, so the checksum covers them all.
        manifest.frames.push_back({.name = scene.name,
                                   .scene_sha256 = sha256_of_text(scene.sdl + around),
                                   .image_sha256 = ""});
    }
    require_light_that_counts(manifest.wavelengths, manifest.frame_error, plan.scene.format);
    return set;
}

namespace {

// POV-Ray reads the text after a '[' in the name of its settings file as a section.
void require_no_bracket(const std::filesystem::path& folder) {
    if (std::filesystem::absolute(folder).string().find('[') == std::string::npos) return;
    throw InputError(
        "{}: found a '[' in the folder's path; allowed: none, since POV-Ray cannot read its "
        "settings there",
        folder.string());
}

// A setting ends with its line, and a path in it with the next quotation mark.
void require_place_in_settings(const std::string& path) {
    const auto is_plain = [](unsigned char c) { return c >= ' ' && c < 0x7F && c != '"'; };
    if (std::ranges::all_of(path, is_plain)) return;
    throw InputError(
        "{}: found a path with non-ASCII letters, a quotation mark or a line break; allowed: none, "
        "since POV-Ray cannot read them",
        path);
}

// The path as named in the settings, relative to the user's scene's folder.
std::string path_from_scene(const std::filesystem::path& povray, const SceneSet& set) {
    // Absolute, for a folder that does not exist yet.
    const std::filesystem::path here = std::filesystem::absolute(povray);
    return std::filesystem::relative(here, set.user_scene.path.parent_path()).generic_string();
}

// POV-Ray runs in the user's scene's folder, which contains its own includes and pictures.
std::string ini_for(const std::filesystem::path& povray, const SceneSet& set) {
    if (set.user_scene.path.empty()) return set.ini + "Output_File_Name=frames/\n";
    const std::string here = path_from_scene(povray, set);
    return fmt::format(
        "; To be run in the folder of {0}, with +I\"{1}/<frame>.pov\".\n"
        "{2}Library_Path=\"{1}\"\nOutput_File_Name=\"{1}/frames/\"\n",
        set.user_scene.path.filename().string(),
        here,
        set.ini);
}

}  // namespace

void require_place_for_scenes(const std::filesystem::path& folder, const SceneSet& set) {
    require_no_bracket(folder);
    if (!set.user_scene.path.empty())
        require_place_in_settings(path_from_scene(folder / "povray", set));
}

void write_scenes(const std::filesystem::path& folder, const SceneSet& set) {
    const std::filesystem::path povray = folder / "povray";
    make_folder(povray / "frames");
    write_text_file(povray / "render.ini", ini_for(povray, set));
    for (const IncludeFile& file : include_library()) {
        write_text_file(povray / file.name, std::string(file.text));
    }
    if (set.camera) write_text_file(povray / kCameraRaysFile, camera_rays_sdl(*set.camera));
    if (!set.vignetting.empty()) {
        write_exr(vignetting_path(folder),
                  set.manifest.width_px,
                  set.manifest.height_px,
                  {"Y"},
                  set.vignetting);
    }
    for (std::size_t f = 0; f < set.scenes.size(); ++f) {
        write_text_file(scene_path(folder, set.manifest.frames[f]), set.scenes[f].sdl);
    }
}

}  // namespace aphotic
