// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic integrate DIR: the frames of a folder to images, wherever they were rendered.
#include "cli/command.h"
#include "cli/outcome.h"

#include <fmt/format.h>

#include <memory>

namespace aphotic::cli {
namespace {

struct Options {
    std::string folder;
    PreviewOptions preview;
    bool json = false;
};

}  // namespace

Action configure_integrate(CLI::App& app) {
    const auto options = std::make_shared<Options>();
    app.add_option("DIR", options->folder, "a folder of `aphotic render` or `aphotic generate`")
        ->required();
    add_preview_options(app, options->preview);
    app.add_flag("--json", options->json, "say what was made as JSON");
    return [options] {
        const Manifest manifest = read_manifest(options->folder);
        nlohmann::ordered_json outcome =
            integrate_folder(options->folder, manifest, options->preview);
        outcome["title"] = manifest.rig_title;
        if (options->json) {
            fmt::print("{}\n", dumped(outcome));
        } else {
            print_outcome(outcome);
        }
        return kDone;
    };
}

}  // namespace aphotic::cli
