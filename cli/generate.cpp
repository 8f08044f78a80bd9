// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic generate RIG -o DIR: the scenes alone, for plain POV-Ray; `aphotic integrate DIR` then
// makes the images.
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/words.h"
#include "cli/command.h"
#include "cli/options.h"
#include "cli/outcome.h"
#include "cli/output_folder.h"
#include "cli/planning.h"
#include "cli/rig_file.h"
#include "cli/terminal.h"
#include "plugin/render.h"
#include "scene_gen/quick_look.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace aphotic::cli {
namespace {

namespace fs = std::filesystem;

struct GenerateCommandOptions {
    PlanningOptions planning;
    std::string folder;
    std::string quick_look;
    bool json = false;
};

ExitStatus write_quick_look(const GenerateCommandOptions& options) {
    const Rig rig = read_plausible_rig(options.planning.rig_file, options.planning.strict);
    write_text_file(options.quick_look,
                    quick_look_sdl(rig, fs::path(options.planning.rig_file).parent_path()));
    say("{}: this rig for a quick look with aphotic.inc\n", options.quick_look);
    return kDone;
}

struct Generated {
    Manifest manifest;
    std::string folder;
    fs::path own_scene;  // the user's; may be empty
};

nlohmann::ordered_json to_json(const Generated& made) {
    nlohmann::ordered_json json{{"folder", made.folder}, {"scenes", nlohmann::json::array()}};
    for (const ManifestFrame& frame : made.manifest.frames) {
        json["scenes"].push_back(scene_path(made.folder, frame).string());
    }
    return json;
}

// The command that renders all frames. For a user's scene plain povray runs in its folder: paths
// are relative to it, so that both can be moved.
std::string povray_loop(const Generated& made) {
    if (made.own_scene.empty()) {
        return fmt::format(
            "(cd {}/povray && for scene in *.pov; do povray render.ini +I$scene; done)",
            shell_word(made.folder));
    }
    const fs::path home = made.own_scene.parent_path();
    const std::string here = fs::relative(made.folder, home).generic_string();
    return fmt::format(
        "(cd {} && for scene in {}/povray/*.pov; do povray {} \"+I\\\"$scene\\\"\"; done)",
        shell_word(home.string()),
        shell_word(here),
        shell_word(fmt::format("\"{}/povray/render.ini\"", here)));
}

void print(const Generated& made) {
    const bool is_own = !made.own_scene.empty();
    say("{}: {} for {}{} in {}/povray\n"
        "Render them {}, for example with\n"
        "  {}\n"
        "then run\n"
        "  aphotic integrate {}\n",
        made.manifest.rig_title,
        counted(made.manifest.frames.size(), is_own ? "frame" : "scene"),
        counted(made.manifest.wavelengths.size(), "wavelength"),
        is_own ? " of " + made.own_scene.filename().string() : "",
        made.folder,
        is_own ? "in the scene's folder" : "there",
        povray_loop(made),
        shell_word(made.folder));
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
    show(
        Generated{
            generate(options.folder, scenes, all_cores()), options.folder, scenes.user_scene.path},
        options.json);
    return kDone;
}

}  // namespace

Action configure_generate(CLI::App& app) {
    const auto options = std::make_shared<GenerateCommandOptions>();
    CLI::Option* folder = add_output_folder(app, options->folder);
    add_option(app, "--quick-look", options->quick_look)->excludes(folder);
    add_needs_option(app, options->planning.ignore_needs);
    add_json(app, options->json);
    add_planning_options(app, options->planning);
    return [options] { return generate_scenes(*options); };
}

}  // namespace aphotic::cli
