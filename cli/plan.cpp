// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic plan RIG: the resources and the promised error of a render, before anything is rendered.
#include "base/atomic_file.h"
#include "base/words.h"
#include "cli/command.h"
#include "cli/option_words.h"
#include "cli/outcome.h"
#include "cli/output_folder.h"
#include "cli/planning.h"
#include "cli/terminal.h"
#include "light/dispersion.h"
#include "report/plot.h"
#include "report/svg.h"
#include "rig/file/rig_template.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

namespace aphotic::cli {
namespace {

using Json = nlohmann::ordered_json;

struct PlanCommandOptions {
    PlanningOptions planning;
    std::string plot;
    bool json = false;
};

// Behind a port: the shift between wavelengths, and the additional frames that it requires.
struct PortCost {
    double spread_px = 0.0;
    double shared_px = 0.0;  // the most within one frame
    std::size_t frames_without = 0;
};

PortCost port_cost(const PlannedRender& planned) {
    const std::vector<PlannedWavelength>& all = planned.plan.wavelengths;
    const auto shift_px = [&](const PlannedWavelength& a, const PlannedWavelength& b) {
        return corner_shift_px(planned.rig, a.lambda_nm, b.lambda_nm);
    };
    PortCost cost{.spread_px = shift_px(all.front(), all.back())};
    // In a frame, the last wavelength is the farthest from the first.
    const PlannedWavelength* first = &all.front();
    for (const PlannedWavelength& w : all) {
        if (w.frame != first->frame) first = &w;
        cost.shared_px = std::max(cost.shared_px, shift_px(*first, w));
    }
    const auto per_frame = static_cast<std::size_t>(planned.plan.scene.wavelengths_per_frame);
    cost.frames_without = (all.size() + per_frame - 1) / per_frame;
    return cost;
}

Json wavelengths_of(const Manifest& manifest) {
    Json all = Json::array();
    for (const PlannedWavelength& w : manifest.wavelengths) {
        all.push_back({{"lambda_nm", w.lambda_nm},
                       {"weight", w.weight},
                       {"frame", manifest.frames[w.frame].name},
                       {"channel", kChannelNames[w.channel]},
                       {"exposure_log2", w.exposure_log2},
                       {"index_nm", w.index_nm}});
    }
    return all;
}

// The needs of a render into an empty folder, with as many frames at a time as there are cores.
struct PlannedNeeds {
    ResourceNeeds render;
    FileSizes files;
    int jobs = 1;
};

PlannedNeeds planned_needs(const SceneSet& scenes) {
    const int jobs = all_cores();
    return {.render = needs_of(scenes, "", jobs),
            .files = largest_files(image_size(scenes.manifest)),
            .jobs = jobs};
}

Json json_of(const PlannedNeeds& needs) {
    return {{"jobs", needs.jobs},
            {"folder_bytes", needs.render.folder_bytes},
            {"temporary_bytes", needs.render.temporary_bytes},
            {"memory_bytes", needs.render.memory_bytes},
            {"job_memory_bytes", needs.render.job_memory_bytes},
            {"files",
             {{"frame", needs.files.frame_bytes},
              {"image.exr", needs.files.image_bytes},
              {"spectral.exr", needs.files.spectral_bytes},
              {"preview.png", needs.files.preview_bytes}}}};
}

void print_needs(const PlannedNeeds& needs, std::size_t frames, bool has_scene) {
    const auto words = [](std::uint64_t bytes) { return bytes_in_words(bytes); };
    say("\nIt will take at most, with {}:\n"
        "  {} of disk: {} of {} each, spectral.exr {}, image.exr {}, preview.png {}\n",
        counted(static_cast<std::size_t>(needs.jobs), "job"),
        words(needs.render.folder_bytes),
        counted(frames, "frame"),
        words(needs.files.frame_bytes),
        words(needs.files.spectral_bytes),
        words(needs.files.image_bytes),
        words(needs.files.preview_bytes));
    if (needs.render.temporary_bytes > 0) {
        say("  {} of disk in /tmp, while POV-Ray renders\n", words(needs.render.temporary_bytes));
    }
    say("  {} of memory, each POV-Ray {}{}\n",
        words(needs.render.memory_bytes),
        words(needs.render.job_memory_bytes),
        has_scene ? " besides what the scene's own files take" : "");
}

struct Planned {
    PlannedRender render;
    SceneSet scenes;
    std::string rig_file;
    std::vector<UnmeasuredLine> unmeasured;
};

Json to_json(const std::vector<UnmeasuredLine>& unmeasured) {
    Json lines = Json::array();
    for (const auto& [line, text] : unmeasured) lines.push_back({{"line", line}, {"text", text}});
    return lines;
}

void print_unmeasured(const Planned& made) {
    if (made.unmeasured.empty()) return;
    say("\nStill guesses of the template; measure each, or delete its mark:\n");
    for (const auto& [line, text] : made.unmeasured)
        say("  {}:{}: {}\n", made.rig_file, line, text);
}

Json to_json(const Planned& made) {
    const PlannedRender& planned = made.render;
    const SceneSet& scenes = made.scenes;
    const Manifest& manifest = scenes.manifest;
    const RenderPlan& plan = planned.plan;
    Json json{{"rig_title", manifest.rig_title},
              {"rig_sha256", manifest.rig_sha256},
              {"width_px", manifest.width_px},
              {"height_px", manifest.height_px},
              {"method", manifest.method},
              {"tolerance", plan.tolerance},
              {"paths_m", {plan.family.shortest_path_m, plan.family.longest_path_m}},
              {"sources", plan.family.sources.size()},
              {"frame_error", plan.frame_error},
              {"frames", manifest.frames.size()},
              {"wavelengths", wavelengths_of(manifest)},
              {"omissions", Json::array()},
              {"needs", json_of(planned_needs(scenes))},
              {"unmeasured", to_json(made.unmeasured)}};
    if (manifest.rig_settings) json["rig_settings"] = manifest.rig_settings->keys;
    put_promises(json, manifest);
    put_model_error(json, planned.model);
    if (disperses(planned.rig)) {
        const PortCost cost = port_cost(planned);
        json["port"] = {{"spread_px", cost.spread_px},
                        {"shared_px", cost.shared_px},
                        {"pixel_shift", plan.scene.pixel_shift},
                        {"frames_without_port", cost.frames_without}};
    }
    for (const Omission& omission : plan.omissions) {
        json["omissions"].push_back({{"what", omission.what}, {"reason", omission.reason}});
    }
    return json;
}

void print_promise(const RenderPlan& plan) {
    if (!plan.no_promise.empty()) {
        print_no_promise(plan.no_promise);
        say("\n");
        return;
    }
    say("{:>9}  {:>12}  {:>13}  {:>8}\n", "channel", "error", "amplification", "promise");
    for (std::size_t c = 0; c < kChannels; ++c) {
        const RuleQuality& q = plan.quality[c];
        say("{:>9}  {:12.2g}  {:13.3f}  {:8.3g}\n",
            kChannelNames[c],
            q.error,
            q.amplification,
            q.promise(plan.frame_error));
    }
    if (plan.scene.povray_veil) {
        say("No pixel's signal should be off the full spectrum by more than the promise, for which "
            "the\nveil was measured.\n");
        return;
    }
    say("No pixel's signal will be off the full spectrum by more than the promise, which is the\n"
        "error of the wavelengths and their weights plus the frames' own {:.3g}, amplified.\n\n",
        plan.frame_error);
}

void print_wavelengths(const Manifest& manifest) {
    say("{:>12}  {:>12} {:>12} {:>12}  {:>8}  frame\n",
        "lambda (nm)",
        "weight R",
        "weight G",
        "weight B",
        "exposure");
    for (const PlannedWavelength& w : manifest.wavelengths) {
        say("{:12.3f}  {:12.6g} {:12.6g} {:12.6g}  {:>8}  {} {}\n",
            w.lambda_nm,
            w.weight[0],
            w.weight[1],
            w.weight[2],
            fmt::format("2^{}", w.exposure_log2),
            manifest.frames[w.frame].name,
            kChannelNames[w.channel]);
    }
}

void print_port(const PlannedRender& planned) {
    const PortCost cost = port_cost(planned);
    say("\nThe port spreads these wavelengths over {:.3g} pixels at the image's corner.",
        cost.spread_px);
    if (planned.plan.frames() > cost.frames_without)
        say(" {} instead of\n{} keep those of one frame within {:.3g} pixels of each other.",
            counted(planned.plan.frames(), "frame"),
            cost.frames_without,
            planned.plan.scene.pixel_shift);
    say("\n");
}

void print(const Planned& made) {
    const PlannedRender& planned = made.render;
    const SceneSet& scenes = made.scenes;
    const Manifest& manifest = scenes.manifest;
    const RenderPlan& plan = planned.plan;
    say("{}: {} x {} pixels, {} in {}, {}\n",
        manifest.rig_title,
        manifest.width_px,
        manifest.height_px,
        counted(manifest.wavelengths.size(), "wavelength"),
        counted(manifest.frames.size(), "frame"),
        plan.tolerance > 0.0 ? fmt::format("fitted to a tolerance of {}", plan.tolerance)
                             : manifest.method);
    if (const UserScene* scene = plan.scene.user_scene.get()) {
        std::vector<std::string> names;
        for (const NamedSpectrum& material : scene->materials) names.push_back(material.name);
        say("The scene {} uses {}; its paths were measured on it\n",
            scene->file.path.string(),
            names.empty() ? "no spectrum by name" : fmt::format("{}", fmt::join(names, ", ")));
    }
    say("{} of light, on paths of {:.3g} to {:.3g} m from lamp to floor to camera\n\n",
        counted(plan.family.sources.size(), "kind"),
        plan.family.shortest_path_m,
        plan.family.longest_path_m);
    print_promise(plan);
    if (planned.model) {
        print_model_error(planned.model);
        say("\n");
    }
    if (const std::string veil = povray_veil_in_words(manifest); !veil.empty()) say("{}\n", veil);
    print_wavelengths(manifest);
    if (disperses(planned.rig)) print_port(planned);
    print_needs(planned_needs(scenes), manifest.frames.size(), manifest.scene.has_value());
    if (!plan.omissions.empty()) say("\nLeft out:\n");
    for (const Omission& omission : plan.omissions) {
        say("  {}: {}\n", omission.what, omission.reason);
    }
    print_unmeasured(made);
}

// --- The plot -----------------------------------------------------------------------------------

std::string source_name(const std::vector<Spectrum>& source) {
    std::string name;
    for (const Spectrum& curve : source) name += (name.empty() ? "" : " on ") + curve.name();
    return name;
}

// Spectral shape: its largest value is 1.
PlotCurve light_on(const LightFamily& family,
                   const std::vector<Spectrum>& source,
                   double path_m,
                   WavelengthRange range) {
    constexpr int kSteps = 640;
    PlotCurve curve;
    for (int i = 0; i <= kSteps; ++i) {
        const double nm = std::lerp(range.first_nm, range.last_nm, i / double{kSteps});
        double light = std::exp(-family.water.attenuation_per_m(nm) * path_m);
        for (const Spectrum& factor : source) light *= factor.at(nm);
        curve.x.push_back(nm);
        curve.y.push_back(light);
    }
    const double most = *std::ranges::max_element(curve.y);
    if (most > 0.0) {
        for (double& y : curve.y) y /= most;
    }
    return curve;
}

Plot light_panel(const Rig& rig, const RenderPlan& plan) {
    const LightFamily& family = plan.family;
    Plot panel{.title = rig.title,
               .x_label = "wavelength (nm)",
               .y_label = "light, relative to its peak",
               .curves = {}};
    for (const PlannedWavelength& w : plan.wavelengths) panel.marks_x.push_back(w.lambda_nm);
    for (std::size_t s = 0; s < family.sources.size(); ++s) {
        for (const double path_m : {family.shortest_path_m, family.longest_path_m}) {
            PlotCurve curve = light_on(family, family.sources[s], path_m, rig.camera.range);
            curve.label = fmt::format("{}, {:.3g} m", source_name(family.sources[s]), path_m);
            curve.tone = s;
            curve.dashed = path_m != family.shortest_path_m;
            panel.curves.push_back(std::move(curve));
        }
    }
    return panel;
}

double largest_error(const std::vector<QuadratureFitter::PathError>& errors) {
    double largest = 0.0;
    for (const auto& at : errors) {
        for (const double e : at.error) largest = std::max(largest, std::abs(e));
    }
    return largest;
}

Plot error_panel(const Rig& rig, const RenderPlan& plan) {
    const QuadratureFitter fitter(rig.camera.sensor, plan.family, rig.camera.range);
    FittedRule rule{.quality = plan.quality};
    for (const PlannedWavelength& w : plan.wavelengths) {
        rule.wavelengths.push_back({.lambda_nm = w.lambda_nm, .weight = w.weight});
    }
    const std::vector<FrameLight> frames = frames_light(fitter, plan.wavelengths);

    std::vector<QuadratureFitter::PathError> worst;
    std::size_t of_source = 0;
    for (std::size_t s = 0; s < plan.family.sources.size(); ++s) {
        auto errors = fitter.errors_over_path(rule, frames, s);
        if (!worst.empty() && largest_error(errors) <= largest_error(worst)) continue;
        worst = std::move(errors);
        of_source = s;
    }
    Plot panel{.title = fmt::format("{} wavelengths and their weights: {}",
                                    plan.wavelengths.size(),
                                    source_name(plan.family.sources[of_source])),
               .x_label = "path from lamp to floor to camera (m)",
               .y_label = "relative error of the signal",
               .curves = {}};
    for (std::size_t c = 0; c < kChannels; ++c) {
        PlotCurve curve{.label = std::string(kChannelNames[c]), .x = {}, .y = {}};
        curve.tone = kChannelTones[c];
        for (const auto& at : worst) {
            curve.x.push_back(at.path_m);
            curve.y.push_back(at.error[c]);
        }
        panel.curves.push_back(std::move(curve));
    }
    return panel;
}

// The light from each material over its shortest and its longest path, with the wavelengths marked;
// below it, the error of each channel over path length, for the material with the largest error.
void plot_plan(const Rig& rig, const RenderPlan& plan, const std::filesystem::path& file) {
    write_plots(std::array{light_panel(rig, plan), error_panel(rig, plan)}, file);
}

}  // namespace

Action configure_plan(CLI::App& app) {
    const auto options = std::make_shared<PlanCommandOptions>();
    add_option(app, "--plot", options->plot);
    add_json(app, options->json);
    add_planning_options(app, options->planning);
    return [options] {
        PlannedRender render = plan_rig(options->planning);
        SceneSet scenes = scenes_of(render, options->planning);
        if (!options->plot.empty()) plot_plan(render.rig, render.plan, options->plot);
        const std::string& file = options->planning.rig_file;
        show(Planned{.render = std::move(render),
                     .scenes = std::move(scenes),
                     .rig_file = file,
                     .unmeasured = unmeasured_lines(read_text_file(file))},
             options->json);
        return kDone;
    };
}

}  // namespace aphotic::cli
