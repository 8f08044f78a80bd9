// SPDX-License-Identifier: BSD-3-Clause
#include "cli/model_error.h"

#include "base/error.h"
#include "base/progress.h"
#include "cli/options.h"
#include "cli/terminal.h"

#include <algorithm>

namespace aphotic::cli {

void add_model_tolerance(CLI::App& app, double& tolerance) {
    constexpr double kAny = 1e9;
    add_option(app, "--model-tolerance", tolerance)->check(in_range(0.0, kAny));
}

std::optional<ManifestModel> model_error(const Rig& rig,
                                         const std::string& rig_file,
                                         double tolerance,
                                         std::string_view altitude_by) {
    if (!rig.water.scatters()) return std::nullopt;
    ProgressLine line;
    const ModelCheck check = check_model(rig, kModelPaths, all_cores(), [&](double share) {
        line.show("estimating the model error", share);
    });
    const ManifestModel model{.error = check.rms()};
    const auto worst = std::ranges::max_element(model.error);
    if (*worst > tolerance) {
        throw InputError(
            "{}: found an estimated {:.2g} of {}'s signal (rms, at {} m) in what the model leaves "
            "out of water that scatters: light scattered more than once, and blur; allowed: "
            "--model-tolerance {}. Lower altitudes ({}) and wider beams reduce it",
            rig_file,
            *worst,
            kChannelNames[static_cast<std::size_t>(worst - model.error.begin())],
            rig.sled.altitude_m,
            tolerance,
            altitude_by);
    }
    return model;
}

void print_model_error(const std::optional<ManifestModel>& model) {
    if (!model) return;
    say("  model error estimate, of scattering: {:.2g} (R), {:.2g} (G), {:.2g} (B), rms\n",
        model->error[0],
        model->error[1],
        model->error[2]);
}

void put_model_error(nlohmann::ordered_json& json, const std::optional<ManifestModel>& model) {
    if (!model) return;
    for (std::size_t c = 0; c < kChannels; ++c)
        json["model_error"][std::string(kChannelNames[c])] = model->error[c];
}

}  // namespace aphotic::cli
