// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic trace RIG -o DIR: the same images by the reference tracer, without POV-Ray.
#include "base/atomic_file.h"
#include "base/error.h"
#include "base/progress.h"
#include "base/stopwatch.h"
#include "base/words.h"
#include "cli/command.h"
#include "cli/options.h"
#include "cli/outcome.h"
#include "cli/output_folder.h"
#include "cli/planning.h"
#include "cli/terminal.h"
#include "image/exr.h"
#include "spectral/manifest.h"
#include "validation/traced_images.h"

#include <algorithm>
#include <memory>

namespace aphotic::cli {
namespace {

struct TraceCommandOptions {
    PlanningOptions planning;
    std::string folder;
    int threads = all_cores();
    PreviewOptions preview;
    bool json = false;
};

// The tracer's images have the same names, and would be compared with the reference as if POV-Ray
// had made them.
void require_no_render(const std::filesystem::path& folder) {
    if (!std::filesystem::exists(manifest_path(folder))) return;
    throw InputError(
        "{}: found the manifest of a render; allowed: a folder without one, since the traced "
        "images would replace the rendered ones",
        manifest_path(folder).string());
}

struct TracedEmitter {
    std::string strobe;
    EmitterLamps lamps;
};

struct Traced {
    MadeImages images;
    std::string title;
    std::string rig_sha256;
    std::size_t wavelengths = 0;  // the planes of spectral.exr
    std::size_t grid = 0;         // wavelengths of the signals
    std::vector<TracedEmitter> emitters;
    std::size_t on_edges = 0;  // pixels to which the errors do not apply
    std::optional<ManifestModel> model{};
    int threads = 1;
    double seconds = 0.0;
};

nlohmann::ordered_json to_json(const Traced& traced) {
    nlohmann::ordered_json json = to_json(traced.images);
    json["title"] = traced.title;
    json["rig_sha256"] = traced.rig_sha256;
    json["wavelengths"] = traced.wavelengths;
    json["grid"] = traced.grid;
    json["spectral_error"] = kSpectralError;
    if (!traced.emitters.empty()) json["emitter_error"] = kEmitterError;
    for (const TracedEmitter& emitter : traced.emitters) {
        json["emitters"].push_back({{"strobe", emitter.strobe},
                                    {"lamps_across", emitter.lamps.across},
                                    {"lamps_along", emitter.lamps.along}});
    }
    put_model_error(json, traced.model);
    json["on_edges"] = traced.on_edges;
    json["threads"] = traced.threads;
    json["trace_s"] = traced.seconds;
    return json;
}

void print(const Traced& traced) {
    say("{}: {} x {} pixels traced over {} wavelengths, exact to {:.0e} of a signal off the edges, "
        "in {:.1f} s\n",
        traced.title,
        traced.images.width_px,
        traced.images.height_px,
        traced.grid,
        kSpectralError,
        traced.seconds);
    for (const TracedEmitter& emitter : traced.emitters) {
        say("  strobe '{}' is traced as {} x {} lamps, exact to {:.0e} of its light\n",
            emitter.strobe,
            emitter.lamps.across,
            emitter.lamps.along,
            kEmitterError);
    }
    if (traced.on_edges > 0) {
        say("  {} on the edge of a cone, shadow, object or penumbra, or where a port disperses "
            "one: no such bound there\n",
            counted(traced.on_edges, "pixel"));
    }
    print_model_error(traced.model);
    print(traced.images);
}

std::vector<TracedEmitter> traced_emitters(const Tracer& tracer) {
    std::vector<TracedEmitter> emitters;
    for (std::size_t s = 0; s < tracer.rig().strobes.size(); ++s) {
        const Strobe& strobe = tracer.rig().strobes[s];
        if (strobe.emitter) emitters.push_back({strobe.name, tracer.lamps(s)});
    }
    return emitters;
}

ExitStatus trace_rig(const TraceCommandOptions& options) {
    const PlannedRender planned = plan_rig(options.planning);
    if (!planned.rig.scene.empty()) {
        warn("tracing the rig's floor and objects; only POV-Ray can read {}",
             planned.rig.scene.string());
    }
    const Camera& camera = planned.rig.camera;
    TraceOptions request{.signals = true, .planes_nm = {}, .threads = options.threads};
    for (const PlannedWavelength& w : planned.plan.wavelengths) {
        request.planes_nm.push_back(w.lambda_nm);
    }

    require_room(images_needs({.width_px = camera.width_px,
                               .height_px = camera.height_px,
                               .wavelengths = request.planes_nm.size()}),
                 options.folder,
                 options.planning.ignore_needs);

    const Stopwatch watch;
    const Tracer tracer(planned.rig, request);
    const FolderLock lock = claim_folder(options.folder);
    require_no_render(options.folder);
    set_exr_threads(options.threads);
    const CameraImage image = [&] {
        ProgressLine line;
        return write_traced_images(
            tracer, request, options.folder, APHOTIC_VERSION, planned.model, [&](double share) {
                line.show("tracing", share);
            });
    }();
    write_preview(image,
                  lamp_signal(planned.rig, planned.plan.family),
                  options.preview,
                  std::filesystem::path(options.folder) / "preview.png");
    const double trace_s = watch.seconds();

    const std::vector<unsigned char> marks = tracer.on_edges(camera.range);
    const Traced traced{
        .images = made_images(options.folder, image),
        .title = planned.rig.title,
        .rig_sha256 = planned.rig.digest,
        .wavelengths = request.planes_nm.size(),
        .grid = tracer.grid_size(),
        .emitters = traced_emitters(tracer),
        .on_edges = marks.size() - static_cast<std::size_t>(std::ranges::count(marks, 0)),
        .model = planned.model,
        .threads = options.threads,
        .seconds = trace_s};
    write_text_file(std::filesystem::path(options.folder) / "trace.json",
                    json_text(to_json(traced)));
    show(traced, options.json);
    return kDone;
}

}  // namespace

Action configure_trace(CLI::App& app) {
    const auto options = std::make_shared<TraceCommandOptions>();
    add_output_folder(app, options->folder)->required();
    add_jobs(app, options->threads);
    add_needs_option(app, options->planning.ignore_needs);
    add_json(app, options->json);
    add_wavelength_options(app, options->planning);
    add_preview_options(app, options->preview);
    return [options] { return trace_rig(*options); };
}

}  // namespace aphotic::cli
