// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic trace RIG -o DIR: the same images by the reference tracer, without POV-Ray.
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/progress.h"
#include "base/words.h"
#include "cli/command.h"
#include "cli/needs_check.h"
#include "cli/option_checks.h"
#include "cli/outcome.h"
#include "cli/output_folder.h"
#include "cli/planning.h"
#include "image/output_images.h"
#include "image/row_blocks.h"
#include "image/traced_image.h"
#include "spectral/manifest.h"
#include "validation/tracer.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <thread>

namespace aphotic::cli {
namespace {

struct TraceCommandOptions {
    PlanningOptions planning;
    std::string folder;
    int threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    PreviewOptions preview;
    bool json = false;
};

// Its images have the same names, and would be held against the reference as if POV-Ray had made
// them.
void require_no_render(const std::filesystem::path& folder) {
    if (!std::filesystem::exists(manifest_path(folder))) return;
    throw InputError(
        fmt::format("{}: found the manifest of a render; allowed: a folder without one, for the "
                    "traced images would take the place of the rendered ones",
                    manifest_path(folder).string()));
}

// What the images are exact to, and how many pixels lie where that does not hold.
void note_errors(const Tracer& tracer, nlohmann::ordered_json& outcome) {
    outcome["spectral_error"] = kSpectralError;
    nlohmann::ordered_json emitters = nlohmann::ordered_json::array();
    for (std::size_t s = 0; s < tracer.rig().strobes.size(); ++s) {
        const Strobe& strobe = tracer.rig().strobes[s];
        if (!strobe.emitter) continue;
        emitters.push_back({{"strobe", strobe.name},
                            {"lamps_across", tracer.lamps(s).across},
                            {"lamps_along", tracer.lamps(s).along}});
    }
    if (!emitters.empty()) {
        outcome["emitter_error"] = kEmitterError;
        outcome["emitters"] = emitters;
    }
    const std::vector<unsigned char> marks = tracer.on_edges(tracer.rig().camera.range);
    outcome["on_edges"] = marks.size() - static_cast<std::size_t>(std::ranges::count(marks, 0));
}

void print_errors(const nlohmann::ordered_json& outcome) {
    if (outcome.contains("emitters")) {
        for (const auto& emitter : outcome["emitters"]) {
            fmt::print("  strobe '{}' has a size: {} x {} lamps, exact to {:.0e} of its light\n",
                       emitter["strobe"].get<std::string>(),
                       emitter["lamps_across"].get<int>(),
                       emitter["lamps_along"].get<int>(),
                       outcome["emitter_error"].get<double>());
        }
    }
    const auto on_edges = outcome["on_edges"].get<std::size_t>();
    if (on_edges > 0) {
        fmt::print(
            "  {} on edges, where that does not hold: of cones, shadows or things, by "
            "rounding, by a port's dispersion or in an emitter's penumbra\n",
            counted(on_edges, "pixel"));
    }
}

ExitStatus trace_rig(const TraceCommandOptions& options) {
    const PlannedRender planned = plan_rig(options.planning);
    if (!planned.rig.scene.empty()) {
        fmt::print(stderr,
                   "aphotic: the rig's floor and objects are traced; {} is POV-Ray's to read\n",
                   planned.rig.scene.string());
    }
    const Camera& camera = planned.rig.camera;
    TraceOptions request{.signals = true, .planes_nm = {}, .threads = options.threads};
    for (const WeightedWavelength& w : planned.plan.rule.wavelengths) {
        request.planes_nm.push_back(w.lambda_nm);
    }

    require_room(images_needs({.width_px = camera.width_px,
                               .height_px = camera.height_px,
                               .wavelengths = request.planes_nm.size()}),
                 options.folder,
                 options.planning.ignore_needs);

    const auto start = std::chrono::steady_clock::now();
    const Tracer tracer(planned.rig, request);
    const FolderLock lock = claim_folder(options.folder);
    require_no_render(options.folder);
    set_exr_threads(options.threads);
    OutputImages images(options.folder,
                        camera.width_px,
                        camera.height_px,
                        request.planes_nm,
                        {{"aphotic:version", APHOTIC_VERSION},
                         {"aphotic:rig_title", planned.rig.title},
                         {"aphotic:rig_sha256", planned.rig.digest},
                         {kRendererAttribute, kReferenceTracer}});
    {
        ProgressLine line;
        const int block = traced_rows(camera.width_px, tracer.planes(), options.threads);
        for (int row = 0; row < camera.height_px; row += block) {
            const int rows = std::min(block, camera.height_px - row);
            const std::vector<double> samples = tracer.rows(row, rows);
            images.write_rows(rows, {samples.begin(), samples.end()});
            line.show("tracing", static_cast<double>(row + rows) / camera.height_px);
        }
    }
    const CameraImage image = images.finish();
    write_preview(image,
                  lamp_signal(planned.rig, planned.plan.family),
                  options.preview,
                  std::filesystem::path(options.folder) / "preview.png");
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;

    nlohmann::ordered_json outcome = outcome_of(options.folder, image);
    outcome["title"] = planned.rig.title;
    outcome["rig_sha256"] = planned.rig.digest;
    outcome["wavelengths"] = request.planes_nm.size();
    outcome["grid"] = tracer.grid_size();
    note_errors(tracer, outcome);
    outcome["threads"] = options.threads;
    outcome["trace_s"] = elapsed.count();
    write_text_file(std::filesystem::path(options.folder) / "trace.json", dumped(outcome) + "\n");
    if (options.json) {
        fmt::print("{}\n", dumped(outcome));
        return kDone;
    }
    fmt::print(
        "{}: {} x {} pixels traced over {} wavelengths, exact to {:.0e} of a signal off "
        "the edges, in {:.1f} s\n",
        planned.rig.title,
        image.width_px,
        image.height_px,
        tracer.grid_size(),
        kSpectralError,
        elapsed.count());
    print_errors(outcome);
    print_signals(outcome);
    return kDone;
}

}  // namespace

Action configure_trace(CLI::App& app) {
    constexpr int kMostThreads = 1024;
    const auto options = std::make_shared<TraceCommandOptions>();
    add_wavelength_options(app, options->planning);
    app.add_option("-o,--output", options->folder, "the folder to write to")
        ->required()
        ->type_name("DIR");
    app.add_option("--threads", options->threads, "threads to trace with; by default the cores")
        ->check(in_range(1, kMostThreads))
        ->capture_default_str();
    add_preview_options(app, options->preview);
    add_needs_option(app, options->planning.ignore_needs);
    app.add_flag("--json", options->json, "say what was made as JSON");
    app.footer(
        "image.exr holds the signals over the full spectrum; the wavelengths chosen are the\n"
        "planes of spectral.exr. POV-Ray is not needed.");
    return [options] { return trace_rig(*options); };
}

}  // namespace aphotic::cli
