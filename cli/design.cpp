// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic design RIG --vary KEY,... -o DIR: better places for a rig's strobes, and the gain.
#include "lightmap/design.h"

#include "base/degrees.h"
#include "base/error.h"
#include "base/json_text.h"
#include "base/progress.h"
#include "base/words.h"
#include "cli/command.h"
#include "cli/options.h"
#include "cli/rig_file.h"
#include "cli/terminal.h"
#include "lightmap/design_files.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace aphotic::cli {
namespace {

namespace fs = std::filesystem;

struct DesignCommandOptions {
    std::string rig;
    fs::path folder;
    DesignRequest request;
    double turn_deg = 30.0;
    std::optional<Ends> altitude_m;
    std::optional<Ends> pitch_deg;
    std::optional<Ends> roll_deg;
    bool strict = false;
    bool json = false;
};

DesignRequest request_of(const DesignCommandOptions& options, const Rig& rig) {
    DesignRequest request = options.request;
    request.freedom.turn_rad = options.turn_deg * kRadiansPerDegree;
    request.envelope = envelope_of(rig.sled);
    Envelope& envelope = request.envelope;
    if (options.altitude_m) envelope.altitude_m = *options.altitude_m;
    for (const auto& [given_deg, ends_rad] : {std::pair{&options.pitch_deg, &envelope.pitch_rad},
                                              {&options.roll_deg, &envelope.roll_rad}}) {
        if (!*given_deg) continue;
        for (std::size_t i = 0; i < ends_rad->size(); ++i)
            ends_rad->at(i) = kRadiansPerDegree * (*given_deg)->at(i);
    }
    return request;
}

void print_design(const Rig& rig, const DesignRequest& request, const DesignResult& result) {
    const LightFigures& start = result.start.figures;
    const LightFigures& best = result.best.figures;
    say("{}: {}, {} evaluated; the worst of {}\n",
        rig.title,
        counted(result.numbers, "free number"),
        counted(static_cast<std::size_t>(result.evaluations), "design"),
        counted(result.best.poses.size(), "pose"));
    if (!result.is_better) say("  nothing better than the start was found\n");
    const auto line = [](const std::string& name, double before, double after) {
        constexpr double kPercent = 100.0;
        say("  {:<34} {:>8.4f} {:>8.4f} {:>+7.1f} %\n",
            name,
            before,
            after,
            kPercent * (after / before - 1.0));
    };
    say("  {:<34} {:>8} {:>8} {:>9}\n", "", "start", "design", "gain");
    line("evenness, least over mean", start.evenness, best.evenness);
    line("signal to noise, of the start's", 1.0, best.signal_to_noise / start.signal_to_noise);
    line(fmt::format("coverage, over {:g} of the brightest", request.level),
         start.coverage,
         best.coverage);
    say("  the trade, signal to noise (of the start's) and evenness:\n");
    for (const Design& one : result.front)
        say("    {:>8.4f} {:>8.4f}\n",
            one.figures.signal_to_noise / start.signal_to_noise,
            one.figures.evenness);
}

ExitStatus design_rig(const DesignCommandOptions& options) {
    const RigText text = read_rig_text_as_set(options.rig);
    const Rig rig = text.rig();
    check_plausible(rig, options.rig, options.strict);
    DesignRequest request = request_of(options, rig);
    naming(options.rig, [&] {  // refused before a folder is made
        return DesignSpace(text, request.freedom, corner_poses(request.envelope));
    });
    const FolderLock lock = claim_folder(options.folder);
    const DesignResult result = [&] {
        ProgressLine line;
        request.progress = [&](int done, int of_all) {
            line.show("designing", static_cast<double>(done) / of_all);
        };
        return naming(options.rig, [&] { return design(text, request); });
    }();
    write_design(text, request, result, options.folder);
    if (options.json) {
        say_text(json_text(design_json(rig, request, result)));
        return kDone;
    }
    print_design(rig, request, result);
    for (const char* file : {kDesignedRig, kDesignNumbers, kDesignPage})
        say("  {}\n", (options.folder / file).string());
    return kDone;
}

void add_envelope(CLI::App& app, DesignCommandOptions& options) {
    const OptionGroup group(app, "Envelope");
    const auto tilts = in_range(-kMostTilt_deg, kMostTilt_deg);
    add_range(
        app, "--altitude", options.altitude_m, in_range(kLeastAltitude_m, kMostAltitude_m), 1);
    add_range(app, "--pitch", options.pitch_deg, tilts, 1);
    add_range(app, "--roll", options.roll_deg, tilts, 1);
}

void add_freedom(CLI::App& app, DesignCommandOptions& options) {
    constexpr double kMostRoom_m = 1000.0;
    constexpr double kMostTurn_deg = 80.0;
    DesignFreedom& freedom = options.request.freedom;
    add_option(app, "--vary", freedom.keys)->delimiter(',')->required();
    add_option(app, "--within", freedom.within_m)->check(in_range(0.0, kMostRoom_m));
    add_option(app, "--box", freedom.boxes);
    add_option(app, "--turn", options.turn_deg)->check(in_range(0.0, kMostTurn_deg));
}

}  // namespace

Action configure_design(CLI::App& app) {
    constexpr int kLeastEvaluations = 10;
    constexpr int kMostEvaluations = 10'000'000;
    const auto options = std::make_shared<DesignCommandOptions>();
    DesignRequest& request = options->request;
    request.threads = all_cores();
    add_rig(app, options->rig);
    add_strict_option(app, options->strict);
    add_output_folder(app, options->folder)->required();
    add_freedom(app, *options);
    add_envelope(app, *options);
    add_option(app, "--for", request.goal)->transform(word_of(kDesignGoals));
    add_option(app, "--keep", request.keep)->check(in_range(0.0, 1.0));
    add_option(app, "--level", request.level)->check(in_range(0.0, 1.0));
    add_option(app, "--evaluations", request.evaluations)
        ->check(in_range(kLeastEvaluations, kMostEvaluations));
    add_option(app, "--seed", request.seed);
    add_jobs(app, request.threads);
    add_json(app, options->json);
    return [options] { return design_rig(*options); };
}

}  // namespace aphotic::cli
