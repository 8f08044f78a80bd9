// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic integrate DIR: the frames of a folder to images, wherever they were rendered; with --rig,
// to those of a rig of other water, lamps, materials or sensor.
#include "base/atomic_file.h"
#include "base/error.h"
#include "cli/command.h"
#include "cli/needs_check.h"
#include "cli/option_checks.h"
#include "cli/outcome.h"
#include "cli/output_folder.h"
#include "rig/rig_reader.h"
#include "scene_gen/reweighting.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <system_error>
#include <thread>
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
    PreviewOptions preview;
    bool ignore_needs = false;
    bool json = false;
};

// Beside the frames' own images, so that neither takes the other's place.
fs::path images_folder(const IntegrateCommandOptions& options) {
    if (!options.images_folder.empty()) return options.images_folder;
    if (options.rig_file.empty()) return options.folder;
    return fs::path(options.folder) / ("as-" + fs::path(options.rig_file).stem().string());
}

// Images of other frames, of another rig, or traced have the same names.
void require_own_folder(const fs::path& images, const IntegrateCommandOptions& options) {
    std::error_code none;
    const bool is_of_frames = fs::equivalent(images, options.folder, none);
    if (is_of_frames && options.rig_file.empty()) return;
    for (const fs::path& notes : {manifest_path(images), images / "trace.json"}) {
        if (!fs::exists(notes)) continue;
        throw InputError(fmt::format(
            "{}: found the notes of a render or trace; allowed: a folder without, for these images "
            "would take the place of its own",
            notes.string()));
    }
}

Manifest manifest_of(const IntegrateCommandOptions& options) {
    Manifest manifest = read_manifest(options.folder);
    if (options.rig_file.empty()) return manifest;
    Rig rig = read_rig(options.rig_file);
    if (manifest.scene) {
        UserScene scene;
        scene.materials = scene_materials(manifest.scene->materials, rig, manifest.scene->file);
        rig = rig_of_scene(std::move(rig), scene);
    }
    try {
        return reintegrate(rig, manifest, options.tolerance);
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", options.rig_file, error.what()));
    }
}

// What the image is made of, for whoever finds it later.
Json account_of(const IntegrateCommandOptions& options, const Manifest& manifest) {
    Json account{{"rig_title", manifest.rig_title},
                 {"rig_sha256", manifest.rig_sha256},
                 {"frames_of", fs::absolute(options.folder).lexically_normal().string()},
                 {"tolerance", manifest.tolerance},
                 {"frame_error", manifest.frame_error},
                 {"wavelengths", Json::array()}};
    put_promises(account, manifest);
    for (const ManifestWavelength& w : manifest.wavelengths) {
        account["wavelengths"].push_back({{"lambda_nm", w.lambda_nm}, {"weight", w.weight}});
    }
    return account;
}

ExitStatus integrate_frames(const IntegrateCommandOptions& options) {
    const fs::path images = images_folder(options);
    require_own_folder(images, options);
    // Frames that cannot serve, and images that have no room, leave no folder behind.
    require_room(images_needs(image_size(manifest_of(options))), images, options.ignore_needs);
    const std::vector<FolderLock> locks = claim_folders(images, options.folder);
    const Manifest manifest = manifest_of(options);  // as it stands now that nobody changes it
    Json outcome = integrate_folder(options.folder, manifest, options.preview, images);
    outcome["title"] = manifest.rig_title;
    if (!options.rig_file.empty()) {
        write_text_file(images / "integration.json", dumped(account_of(options, manifest)) + "\n");
    }
    options.json ? fmt::print("{}\n", dumped(outcome)) : print_outcome(outcome);
    return kDone;
}

}  // namespace

Action configure_integrate(CLI::App& app) {
    const auto options = std::make_shared<IntegrateCommandOptions>();
    app.add_option("DIR", options->folder, "a folder of `aphotic render` or `aphotic generate`")
        ->required();
    auto* rig = app.add_option("--rig",
                               options->rig_file,
                               "a rig of the same geometry but other water, lamps, materials or "
                               "sensor: its image, from these frames");
    app.add_option("--tolerance",
                   options->tolerance,
                   "with --rig: relative error that no pixel's signal is to exceed")
        ->check(in_range(0.0, 1.0))
        ->needs(rig)
        ->capture_default_str();
    app.add_option("-o,--output",
                   options->images_folder,
                   "the folder for the images; by default DIR, with --rig DIR/as-RIG")
        ->type_name("DIR");
    add_preview_options(app, options->preview);
    add_needs_option(app, options->ignore_needs);
    app.add_flag("--json", options->json, "say what was made as JSON");
    return [options] { return integrate_frames(*options); };
}

}  // namespace aphotic::cli
