// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic validate RIG -o DIR: the rig through POV-Ray and through the reference, compared.
#include "cli/terminal.h"
#include "validation/validation.h"

#include "base/error.h"
#include "base/progress.h"
#include "cli/command.h"
#include "cli/options.h"
#include "cli/outcome.h"
#include "cli/output_folder.h"
#include "cli/planning.h"
#include "cli/rendered_images.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>

namespace aphotic::cli {
namespace {

namespace fs = std::filesystem;

struct ValidateCommandOptions {
    PlanningOptions planning;
    std::string folder;
    std::string rendered_folder;
    std::size_t monte_carlo = 0;  // paths per place; 0: no Monte Carlo
    int jobs = all_cores();
    bool json = false;
};

// Renders the rig into the folder, as `aphotic render` does.
struct Rendering {
    Manifest manifest;
    double render_s = 0.0;
    double integrate_s = 0.0;
};

Rendering render_here(const ValidateCommandOptions& options,
                      const PovRay& povray,
                      const SceneSet& scenes,
                      int jobs) {
    const RenderedFrames frames = render_frames(
        run_options(options.planning, jobs),
        [&](const RunOptions& run) { return render(povray, options.folder, scenes, run); });
    Rendering rendering{.manifest = frames.result.manifest, .render_s = frames.povray_s};
    rendering.integrate_s =
        integrate_folder(options.folder, rendering.manifest, {}, options.folder).seconds;
    return rendering;
}

void require_promise(const std::string& what, const std::vector<std::string>& no_promise) {
    if (no_promise.empty()) return;
    throw InputError(
        "{}: has no error bound to validate against ({}); allowed: a scene whose render has one",
        what,
        fmt::join(no_promise, "; "));
}

// Refuses a render that cannot be compared with the rig's reference.
Manifest rendered_manifest(const std::string& folder, const Rig& rig) {
    Manifest manifest = read_manifest(folder);
    require_rendered(folder);
    require_promise(folder, manifest.no_promise);
    if (manifest.width_px == rig.camera.width_px && manifest.height_px == rig.camera.height_px)
        return manifest;
    throw InputError("{}: found images of {} x {} pixels; allowed: the rig's {} x {}",
                     folder,
                     manifest.width_px,
                     manifest.height_px,
                     rig.camera.width_px,
                     rig.camera.height_px);
}

// The ratio of model to truth at a place, with the truth's standard error.
void print_model(const ModelCheck& model) {
    if (model.places.empty()) return;
    const auto ratio = [](double of_model, const Estimate& truth) {
        if (!(truth.mean > 0.0)) return std::string("-");
        return fmt::format(
            "{:.4f} +- {:.4f}", of_model / truth.mean, truth.standard_error / truth.mean);
    };
    say("  The reference over light of all orders, {} paths per place:\n", model.paths);
    say("  {:>3}  {:>6}  {:>14}  {:>6}  {:>18}  {:>18}  {:>18}\n",
        "",
        "nm",
        "column, row",
        "veil",
        "floor",
        "veil",
        "sum");
    for (const ModelPlace& place : model.places) {
        say("  {:>3}  {:6.1f}  {:>14}  {:6.3f}  {:>18}  {:>18}  {:>18}\n",
            kChannelNames[place.channel],
            place.lambda_nm,
            fmt::format("{}, {}", place.column, place.row),
            place.veil / (place.floor + place.veil),
            ratio(place.floor, place.truth.floor),
            ratio(place.veil, place.truth.veil),
            ratio(place.floor + place.veil, place.truth.sum));
    }
    const auto rms = model.rms();
    say("  off by {:.2g} (R), {:.2g} (G), {:.2g} (B), rms\n", rms[0], rms[1], rms[2]);
}

// Over the comparisons, the largest share of pixels on edges, and the largest error there.
std::string edges_in_words(const ValidationReport& report) {
    constexpr double kPercent = 100.0;
    const EdgeSummary edges = report.edges();
    std::string words =
        edges.share == 0.0
            ? "no pixel is on an edge"
            : fmt::format(
                  "{:.2g} % of the pixels are on edges, without a bound; largest |e| there {:.2g}",
                  kPercent * edges.share,
                  edges.max_error);
    if (edges.share_in_penumbrae > 0.0) {
        words += fmt::format(
            "\n  {:.2g} % of the pixels are in penumbrae, compared with the render's own lamps; "
            "from an emitter of more lamps they differ by up to {:.2g}",
            kPercent * edges.share_in_penumbrae,
            edges.max_error_of_penumbrae);
    }
    return words;
}

void print_verdict(const ValidationReport& report, const std::string& folder) {
    const Comparison& worst = report.worst();
    say("{}: {}; {}\n",
        report.rig.title,
        report.holds() ? "POV-Ray and the reference agree within their bounds"
                       : "POV-Ray and the reference DISAGREE",
        edges_in_words(report));
    say("  {:>10}  {:>9}  {:>9}  {:>9}  {:>9}  {:>9}  {}\n",
        "",
        "max |e|",
        "99.9 %",
        "rms",
        "mean",
        "bound",
        "on edges");
    const auto print_row = [](const Comparison& c) {
        say("  {:>10}  {:9.2e}  {:9.2e}  {:9.2e}  {:9.1e}  {:9.2e}  {}{}\n",
            c.name,
            c.max_error,
            c.percentile_999,
            c.rms_error,
            c.mean_error,
            c.bound,
            c.on_edges,
            c.holds() ? "" : "  <-- out of bounds");
    };
    for (const Comparison& channel : report.channels) print_row(channel);
    Comparison wavelengths =
        *std::ranges::max_element(report.wavelengths, {}, &Comparison::max_error);
    print_row(wavelengths);
    say("  worst against its bound: {} at column {}, row {}: {:.3g} of {:.3g}\n",
        worst.name,
        worst.column,
        worst.row,
        worst.max_error,
        worst.bound);
    if (report.has_veil()) say("  {}\n", veil_in_words(report.veil_share));
    print_model(report.model);
    say("  {}/report.html      to read\n  {}/validation.json  for programs\n", folder, folder);
}

ExitStatus validate_rig(const ValidateCommandOptions& options) {
    const PlannedRender planned = plan_rig(options.planning);
    const bool is_rendered = !options.rendered_folder.empty();
    const UserScene* const scene = planned.plan.scene.user_scene.get();
    require_promise(scene != nullptr ? scene->file.path.string() : options.planning.rig_file,
                    planned.plan.no_promise);
    // All invalid input is refused before a folder is made.
    PovRay povray;
    int jobs = options.jobs;
    if (is_rendered) {
        (void)rendered_manifest(options.rendered_folder, planned.rig);
    } else {
        povray = povray_for(planned, options.planning, options.folder);
        jobs = require_place_and_room(scenes_of(planned, options.planning),
                                      options.folder,
                                      options.jobs,
                                      options.planning.ignore_needs);
    }
    const std::vector<FolderLock> locks =
        claim_folders(options.folder, is_rendered ? options.rendered_folder : options.folder);
    Rendering rendering;
    if (is_rendered) {
        rendering.manifest = rendered_manifest(options.rendered_folder, planned.rig);
        if (rendering.manifest.rig_sha256 != planned.rig.digest) {
            warn("{} was rendered from another rig file than {}; continuing",
                 options.rendered_folder,
                 options.planning.rig_file);
        }
    } else {
        rendering = render_here(options, povray, scenes_of(planned, options.planning), jobs);
    }
    const fs::path images = is_rendered ? options.rendered_folder : options.folder;

    if (rendering.manifest.scene) {
        warn("the reference traces the rig's floor and objects, not {}",
             rendering.manifest.scene->file);
    }
    ValidationReport report = [&] {
        ProgressLine line;
        return validate(planned.rig,
                        images_in(images, planned.rig, rendering.manifest, planned.plan.family),
                        options.jobs,
                        [&](double share) { line.show("tracing", share); });
    }();
    if (options.monte_carlo > 0) {
        ProgressLine line;
        report.model =
            check_model(planned.rig, options.monte_carlo, options.jobs, [&](double share) {
                line.show("tracing light of all orders", share);
            });
    }
    if (rendering.manifest.scene) report.scene_file = rendering.manifest.scene->file;
    report.aphotic_version = APHOTIC_VERSION;
    report.povray_version = rendering.manifest.povray_version;
    report.lamp_signal = rendering.manifest.lamp_signal;
    report.frames = rendering.manifest.frames.size();
    report.jobs = options.jobs;
    report.render_s = rendering.render_s;
    report.integrate_s = rendering.integrate_s;
    const fs::path folder = options.folder;
    write_validation_json(report, folder / "validation.json");
    write_validation_html(report, folder / "report.html");
    if (options.json) {
        say_text(validation_json(report));
    } else {
        print_verdict(report, options.folder);
    }
    return report.holds() ? kDone : kAnswerIsNo;
}

}  // namespace

Action configure_validate(CLI::App& app) {
    const auto options = std::make_shared<ValidateCommandOptions>();
    add_output_folder(app, options->folder)->required();
    add_option(app, "--rendered", options->rendered_folder);
    constexpr double kMostPaths = 1e9;
    add_option(app, "--monte-carlo", options->monte_carlo)->check(in_range(1, kMostPaths));
    add_jobs(app, options->jobs);
    add_needs_option(app, options->planning.ignore_needs);
    add_json(app, options->json);
    add_planning_options(app, options->planning);
    return [options] { return validate_rig(*options); };
}

}  // namespace aphotic::cli
