// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic generate RIG -o DIR: the scenes alone, for plain POV-Ray; `aphotic integrate DIR` takes
// it from there.
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/words.h"
#include "cli/command.h"
#include "cli/needs_check.h"
#include "cli/options.h"
#include "cli/outcome.h"
#include "cli/output_folder.h"
#include "cli/planning.h"
#include "plugin/render.h"
#include "rig/rig_reader.h"
#include "scene_gen/quick_look.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace aphotic::cli {
namespace {

struct GenerateCommandOptions {
    PlanningOptions planning;
    std::string folder;
    std::string quick_look;
    bool json = false;
};

ExitStatus write_quick_look(const GenerateCommandOptions& options) {
    const Rig rig = read_rig(options.planning.rig_file);
    write_text_file(
        options.quick_look,
        quick_look_sdl(rig, std::filesystem::path(options.planning.rig_file).parent_path()));
    fmt::print("{}: what aphotic.inc takes of this rig for a quick look\n", options.quick_look);
    return kDone;
}

// Plain povray runs in the scene's folder: paths from there, so that both may be carried elsewhere.
void print_own_scene(const SceneSet& scenes, const Manifest& manifest, const std::string& folder) {
    const std::filesystem::path home = scenes.scene_file.parent_path();
    const std::string here = std::filesystem::relative(folder, home).generic_string();
    fmt::print(
        "{}: {} for {} of {} in {}/povray\n"
        "Render them in the scene's folder, for example with\n"
        "  (cd {} && for scene in {}/povray/band_*.pov; do povray {} \"+I\\\"$scene\\\"\"; done)\n"
        "then run\n"
        "  aphotic integrate {}\n",
        manifest.rig_title,
        counted(manifest.frames.size(), "frame"),
        counted(manifest.wavelengths.size(), "wavelength"),
        scenes.scene_file.filename().string(),
        folder,
        shell_word(home.string()),
        shell_word(here),
        shell_word(fmt::format("\"{}/povray/render.ini\"", here)),
        shell_word(folder));
}

ExitStatus generate_scenes(const GenerateCommandOptions& options) {
    if (!options.quick_look.empty()) return write_quick_look(options);
    if (options.folder.empty()) {
        throw InputError("--output or --quick-look: found neither; allowed: one of them");
    }
    const SceneSet scenes = scenes_of(plan_rig(options.planning), options.planning);
    require_place_for_scenes(options.folder, scenes);
    require_room(needs_of_scenes(scenes), options.folder, options.planning.ignore_needs);
    const FolderLock lock = claim_folder(options.folder);
    const Manifest manifest = generate(options.folder, scenes);
    if (options.json) {
        nlohmann::ordered_json json{{"folder", options.folder},
                                    {"scenes", nlohmann::json::array()}};
        for (const ManifestFrame& frame : manifest.frames) {
            json["scenes"].push_back(scene_path(options.folder, frame).string());
        }
        fmt::print("{}\n", dumped(json));
        return kDone;
    }
    if (!scenes.scene_file.empty()) {
        print_own_scene(scenes, manifest, options.folder);
        return kDone;
    }
    fmt::print(
        "{}: {} for {} in {}/povray\n"
        "Render them there, for example with\n"
        "  (cd {}/povray && for scene in band_*.pov; do povray render.ini +I$scene; done)\n"
        "then run\n"
        "  aphotic integrate {}\n",
        manifest.rig_title,
        counted(manifest.frames.size(), "scene"),
        counted(manifest.wavelengths.size(), "wavelength"),
        options.folder,
        shell_word(options.folder),
        shell_word(options.folder));
    return kDone;
}

Action configure_generate(CLI::App& app) {
    const auto options = std::make_shared<GenerateCommandOptions>();
    CLI::Option* folder = add_output_folder(app, options->folder);
    app.add_option("--quick-look",
                   options->quick_look,
                   "Write the rig to FILE instead: as aphotic_quick.inc beside a scene of your "
                   "own, it shows plain POV-Ray the scene by this rig's light")
        ->type_name("FILE")
        ->excludes(folder);
    add_needs_option(app, options->planning.ignore_needs);
    add_json(app, options->json);
    add_planning_options(app, options->planning);
    return [options] { return generate_scenes(*options); };
}

}  // namespace

const Command kGenerate{
    "generate", kRenderingCommands, "Write the POV-Ray scenes and stop", configure_generate};

}  // namespace aphotic::cli
