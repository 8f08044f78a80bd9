// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic stress -o DIR: both renderers at the extremes, against an answer in long double.
#include "validation/stress.h"

#include "base/error.h"
#include "base/progress.h"
#include "base/words.h"
#include "cli/command.h"
#include "cli/options.h"
#include "cli/output_folder.h"
#include "cli/rendered_images.h"
#include "cli/terminal.h"
#include "plugin/render.h"
#include "scene_gen/render_plan.h"
#include "scene_gen/scene_set.h"
#include "spectral/integrator.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace aphotic::cli {
namespace {

namespace fs = std::filesystem;

struct StressCommandOptions {
    std::string folder;
    std::string povray;
    double stall_timeout_s = kStall_s;
    std::string only;
    int width_px = 24;
    int jobs = all_cores();
    bool json = false;
};

RenderedImages render_case(const PovRay& povray,
                           double stall_s,
                           const Rig& rig,
                           const StressCase& asked,
                           const fs::path& folder) {
    PlanRequest request;
    request.wavelengths_nm = asked.wavelengths_nm;
    if (asked.peak_log2) request.scene.peak_log2 = *asked.peak_log2;
    const RenderPlan plan = plan_render(rig, request);
    const RenderResult result =
        render(povray, folder, make_scene_set(rig, plan), {.jobs = 1, .stall_s = stall_s});
    integrate(folder, result.manifest);
    return images_in(folder, rig, result.manifest, plan.family);
}

void print_found(const std::vector<StressFound>& found, const std::string& folder) {
    const auto surprises =
        std::ranges::count_if(found, [](const StressFound& one) { return !one.as_expected(); });
    for (const StressFound& one : found) {
        if (one.as_expected()) continue;
        say("  {}: {}: {}: expected: {}; found: {}{}\n",
            one.asked.name,
            one.asked.extreme,
            one.asked.value,
            answer_word(one.asked.expected),
            answer_word(one.answer),
            one.said.empty() ? "" : " (" + one.said + ")");
    }
    say("{}, {} not as expected\n", counted(found.size(), "case"), surprises);
    say("  {0}/stress.md    to read\n  {0}/stress.json  for programs\n", folder);
}

ExitStatus stress(const StressCommandOptions& options) {
    const PovRay povray = find_povray(options.povray);
    std::vector<StressCase> cases = stress_cases(options.width_px);
    std::erase_if(cases, [&](const StressCase& asked) {
        return asked.name.find(options.only) == std::string::npos;
    });
    if (cases.empty()) {
        throw InputError("--only: found '{}'; allowed: part of a case's name", options.only);
    }
    const FolderLock lock = claim_folder(options.folder);
    const StressRender render = [&](const Rig& rig, const StressCase& asked, const fs::path& to) {
        return render_case(povray, options.stall_timeout_s, rig, asked, to);
    };
    ProgressLine line;
    const std::vector<StressFound> found =
        measure_stress(cases, options.folder, options.jobs, render, [&](std::size_t done) {
            line.show(fmt::format("{} of {} cases", done, cases.size()),
                      static_cast<double>(done) / static_cast<double>(cases.size()));
        });
    line.wipe();
    write_stress(found, options.folder);
    if (options.json) {
        say_text(stress_json(found));
    } else {
        print_found(found, options.folder);
    }
    return std::ranges::all_of(found, &StressFound::as_expected) ? kDone : kAnswerIsNo;
}

Action configure_stress(CLI::App& app) {
    constexpr int kMostWidth_px = 1360;
    const auto options = std::make_shared<StressCommandOptions>();
    add_output_folder(app, options->folder)->required();
    app.add_option("--width", options->width_px, "Render images N pixels wide")
        ->check(in_range(1, kMostWidth_px))
        ->capture_default_str();
    app.add_option("--only", options->only, "Run only cases whose folder's name contains TEXT")
        ->type_name("TEXT");
    add_jobs(app, options->jobs, "Run 2 N cases at a time");
    add_json(app, options->json, "Print stress.json");
    add_povray_options(app, options->povray, options->stall_timeout_s);
    app.footer(
        "Exit status 0 when every case comes out as it should, 1 when not. Each case leaves its "
        "rig in its folder: `aphotic validate DIR/CASE/rig.toml -o OUT` looks closer.");
    return [options] { return stress(*options); };
}

}  // namespace

const Command kStress{"stress",
                      kCheckCommands,
                      "Test both renderers at extremes against a long-double answer",
                      configure_stress};

}  // namespace aphotic::cli
