// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic plan RIG: what a render would take, before anything is rendered.
#include "cli/command.h"
#include "cli/planning.h"
#include "cli/words.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>

namespace aphotic::cli {
namespace {

struct Options {
    PlanningOptions planning;
    bool json = false;
};

void print_json(const Manifest& manifest) {
    nlohmann::ordered_json json{{"rig_title", manifest.rig_title},
                                {"rig_sha256", manifest.rig_sha256},
                                {"width_px", manifest.width_px},
                                {"height_px", manifest.height_px},
                                {"predicted_error", manifest.predicted_error},
                                {"frames", manifest.frames.size()},
                                {"wavelengths", nlohmann::ordered_json::array()}};
    for (const ManifestWavelength& w : manifest.wavelengths) {
        json["wavelengths"].push_back({{"lambda_nm", w.lambda_nm},
                                       {"weight", w.weight},
                                       {"frame", manifest.frames[w.frame].name},
                                       {"channel", w.channel},
                                       {"exposure_log2", w.exposure_log2}});
    }
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

void print_for_people(const Manifest& manifest) {
    fmt::print("{}: {} x {} pixels, {} in {}\n\n",
               manifest.rig_title,
               manifest.width_px,
               manifest.height_px,
               counted(manifest.wavelengths.size(), "wavelength"),
               counted(manifest.frames.size(), "frame"));
    fmt::print(
        "Against the full spectrum the signals R, G, B will be off by at most {:.2g}, {:.2g}, "
        "{:.2g};\nhalf floats in the frames add up to 4.9e-4.\n\n",
        manifest.predicted_error[0],
        manifest.predicted_error[1],
        manifest.predicted_error[2]);
    fmt::print("{:>12}  {:>12} {:>12} {:>12}  {:>8}  frame\n",
               "lambda (nm)",
               "weight R",
               "weight G",
               "weight B",
               "exposure");
    for (const ManifestWavelength& w : manifest.wavelengths) {
        fmt::print("{:12.3f}  {:12.6g} {:12.6g} {:12.6g}  {:>8}  {} {}\n",
                   w.lambda_nm,
                   w.weight[0],
                   w.weight[1],
                   w.weight[2],
                   fmt::format("2^{}", w.exposure_log2),
                   manifest.frames[w.frame].name,
                   w.channel);
    }
}

}  // namespace

Action configure_plan(CLI::App& app) {
    const auto options = std::make_shared<Options>();
    add_planning_options(app, options->planning);
    app.add_flag("--json", options->json, "the plan as JSON");
    return [options] {
        const Manifest manifest = plan_render(options->planning).scenes.manifest;
        options->json ? print_json(manifest) : print_for_people(manifest);
        return kDone;
    };
}

}  // namespace aphotic::cli
