// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic generate RIG -o DIR: the scenes alone, for plain POV-Ray; `aphotic integrate DIR` takes
// it from there.
#include "cli/command.h"
#include "cli/planning.h"
#include "cli/words.h"
#include "plugin/render.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace aphotic::cli {
namespace {

struct Options {
    PlanningOptions planning;
    std::string folder;
    bool json = false;
};

ExitStatus generate_scenes(const Options& options) {
    const SceneSet scenes = scenes_of(plan_rig(options.planning), options.planning);
    const Manifest manifest = generate(options.folder, scenes);
    if (options.json) {
        nlohmann::ordered_json json{{"folder", options.folder},
                                    {"scenes", nlohmann::json::array()}};
        for (const ManifestFrame& frame : manifest.frames) {
            json["scenes"].push_back(scene_path(options.folder, frame).string());
        }
        fmt::print("{}\n", json.dump(2));
        return kDone;
    }
    fmt::print(
        "{}: {} for {} in {}/povray\n"
        "Render them there, for example with\n"
        "  (cd {}/povray && for scene in band_*.pov; do povray render.ini +I$scene; done)\n"
        "and then say\n"
        "  aphotic integrate {}\n",
        manifest.rig_title,
        counted(manifest.frames.size(), "scene"),
        counted(manifest.wavelengths.size(), "wavelength"),
        options.folder,
        options.folder,
        options.folder);
    return kDone;
}

}  // namespace

Action configure_generate(CLI::App& app) {
    const auto options = std::make_shared<Options>();
    add_planning_options(app, options->planning);
    app.add_option("-o,--output", options->folder, "the folder to write to")
        ->required()
        ->type_name("DIR");
    app.add_flag("--json", options->json, "say what was written as JSON");
    return [options] { return generate_scenes(*options); };
}

}  // namespace aphotic::cli
