// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic integrate DIR: makes images from the frames of a folder, wherever they were rendered;
// with --rig, those of a rig with other water, lamps, materials or sensor.
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/work_folder.h"
#include "cli/command.h"
#include "cli/model_error.h"
#include "cli/options.h"
#include "cli/outcome.h"
#include "cli/output_folder.h"
#include "cli/rig_file.h"
#include "plugin/render.h"
#include "scene_gen/reweighting.h"
#include "scene_gen/veil_planes.h"

#include <filesystem>
#include <memory>
#include <system_error>
#include <vector>

namespace aphotic::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct IntegrateCommandOptions {
    std::string folder;
    std::string rig_file;
    std::string images_folder;
    double tolerance = 1e-3;
    double model_tolerance = kModelTolerance;
    bool strict = false;
    PreviewOptions preview;
    bool ignore_needs = false;
    bool json = false;
};

// Next to the frames' own images, so that neither replaces the other.
fs::path images_folder(const IntegrateCommandOptions& options) {
    if (!options.images_folder.empty()) return options.images_folder;
    if (options.rig_file.empty()) return options.folder;
    return fs::path(options.folder) / ("as-" + fs::path(options.rig_file).stem().string());
}

// Images of other frames, of another rig, or by the tracer have the same names.
void require_own_folder(const fs::path& images, const IntegrateCommandOptions& options) {
    std::error_code none;
    const bool is_of_frames = fs::equivalent(images, options.folder, none);
    if (is_of_frames && options.rig_file.empty()) return;
    for (const fs::path& notes : {manifest_path(images), images / "trace.json"}) {
        if (!fs::exists(notes)) continue;
        throw InputError(
            "{}: found the record of a render or trace; allowed: a folder without one, since these "
            "images would replace its own",
            notes.string());
    }
}

Manifest manifest_of(const IntegrateCommandOptions& options) {
    Manifest manifest = read_manifest(options.folder);
    if (options.rig_file.empty()) return manifest;
    Rig rig = read_rig_as_set(options.rig_file);
    if (manifest.scene) {
        UserScene scene;
        scene.materials = scene_materials(manifest.scene->materials, rig, manifest.scene->file);
        rig = rig_of_scene(std::move(rig), scene);
    }
    manifest =
        naming(options.rig_file, [&] { return reintegrate(rig, manifest, options.tolerance); });
    manifest.rig_settings = rig_settings();
    manifest.model = model_error(rig, options.rig_file, options.model_tolerance);
    return manifest;
}

// The provenance of the image, kept with it.
Json account_of(const IntegrateCommandOptions& options, const Manifest& manifest) {
    Json account{{"rig_title", manifest.rig_title},
                 {"rig_sha256", manifest.rig_sha256},
                 {"frames_of", fs::absolute(options.folder).lexically_normal().string()},
                 {"tolerance", manifest.tolerance},
                 {"frame_error", manifest.frame_error},
                 {"wavelengths", Json::array()}};
    if (manifest.rig_settings) account["rig_settings"] = manifest.rig_settings->keys;
    put_promises(account, manifest);
    put_model_error(account, manifest.model);
    for (const PlannedWavelength& w : manifest.wavelengths) {
        account["wavelengths"].push_back({{"lambda_nm", w.lambda_nm}, {"weight", w.weight}});
    }
    return account;
}

ExitStatus integrate_frames(const IntegrateCommandOptions& options) {
    if (!options.rig_file.empty())
        check_plausible(read_rig_as_set(options.rig_file), options.rig_file, options.strict);
    const fs::path images = images_folder(options);
    require_own_folder(images, options);
    if (!share_folders(options.folder).empty()) {
        const FolderLock lock(options.folder, FolderUse::Write);
        join_frames(options.folder);
    }
    // No folder is left if frames are unusable or disk space is insufficient.
    require_room(images_needs(image_size(manifest_of(options))), images, options.ignore_needs);
    const std::vector<FolderLock> locks = claim_folders(images, options.folder);
    Manifest manifest = manifest_of(options);  // read again under the lock
    if (!options.rig_file.empty()) {
        manifest.veil =
            write_veil_of_signals(images, read_rig_as_set(options.rig_file), manifest, all_cores());
    }
    const Integration integration =
        integrate_folder(options.folder, manifest, options.preview, images);
    if (!options.rig_file.empty()) {
        write_text_file(images / "integration.json", json_text(account_of(options, manifest)));
    }
    show(integration, options.json);
    return kDone;
}

}  // namespace

Action configure_integrate(CLI::App& app) {
    const auto options = std::make_shared<IntegrateCommandOptions>();
    add_option(app, "DIR", options->folder)->required();
    add_output_folder(app, options->images_folder);
    auto* rig = add_option(app, "--rig", options->rig_file);
    add_option(app, "--tolerance", options->tolerance)->check(in_range(0.0, 1.0))->needs(rig);
    add_model_tolerance(app, options->model_tolerance);
    add_strict_option(app, options->strict);
    add_needs_option(app, options->ignore_needs);
    add_json(app, options->json);
    add_preview_options(app, options->preview);
    return [options] { return integrate_frames(*options); };
}

}  // namespace aphotic::cli
