// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic plan RIG: what a render would take and what it promises, before anything is rendered.
#include "base/words.h"
#include "cli/command.h"
#include "cli/needs_check.h"
#include "cli/outcome.h"
#include "cli/plan_plot.h"
#include "cli/planning.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <thread>

namespace aphotic::cli {
namespace {

using Json = nlohmann::ordered_json;

struct PlanCommandOptions {
    PlanningOptions planning;
    std::string plot;
    bool json = false;
};

// Behind a port: how far the wavelengths lie apart, and the frames that this costs.
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
    // In a frame the last is the farthest from the first.
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

// What a render into an empty folder would take, as many frames at a time as there are cores.
struct PlannedNeeds {
    DiskNeeds render;
    FileSizes files;
    int jobs = 1;
};

PlannedNeeds planned_needs(const SceneSet& scenes) {
    const int jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    return {.render = needs_of(scenes, "", jobs),
            .files = largest_files(image_size(scenes.manifest)),
            .jobs = jobs};
}

Json json_of(const PlannedNeeds& needs) {
    return {{"jobs", needs.jobs},
            {"folder_bytes", needs.render.folder_bytes},
            {"temporary_bytes", needs.render.temporary_bytes},
            {"files",
             {{"frame", needs.files.frame_bytes},
              {"image.exr", needs.files.image_bytes},
              {"spectral.exr", needs.files.spectral_bytes},
              {"preview.png", needs.files.preview_bytes}}}};
}

void print_needs(const PlannedNeeds& needs, std::size_t frames) {
    const auto words = [](std::uint64_t bytes) { return bytes_in_words(bytes); };
    fmt::print(
        "\nIt will take at most, with {}:\n"
        "  {} of disk: {} of {} each, spectral.exr {}, image.exr {}, preview.png {}\n",
        counted(static_cast<std::size_t>(needs.jobs), "job"),
        words(needs.render.folder_bytes),
        counted(frames, "frame"),
        words(needs.files.frame_bytes),
        words(needs.files.spectral_bytes),
        words(needs.files.image_bytes),
        words(needs.files.preview_bytes));
    if (needs.render.temporary_bytes > 0) {
        fmt::print("  {} of disk in /tmp, while POV-Ray renders\n",
                   words(needs.render.temporary_bytes));
    }
}

void print_json(const PlannedRender& planned, const SceneSet& scenes) {
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
              {"needs", json_of(planned_needs(scenes))}};
    put_promises(json, manifest);
    if (planned.rig.camera.port) {
        const PortCost cost = port_cost(planned);
        json["port"] = {{"spread_px", cost.spread_px},
                        {"shared_px", cost.shared_px},
                        {"pixel_shift", plan.scene.pixel_shift},
                        {"frames_without_port", cost.frames_without}};
    }
    for (const Omission& omission : plan.omissions) {
        json["omissions"].push_back({{"what", omission.what}, {"reason", omission.reason}});
    }
    fmt::print("{}\n", dumped(json));
}

void print_promise(const RenderPlan& plan) {
    if (!plan.no_promise.empty()) {
        print_no_promise(plan.no_promise);
        fmt::print("\n");
        return;
    }
    fmt::print("{:>9}  {:>12}  {:>13}  {:>8}\n", "channel", "error", "amplification", "promise");
    for (std::size_t c = 0; c < kChannels; ++c) {
        const RuleQuality& q = plan.quality[c];
        fmt::print("{:>9}  {:12.2g}  {:13.3f}  {:8.3g}\n",
                   kChannelNames[c],
                   q.error,
                   q.amplification,
                   q.promise(plan.frame_error));
    }
    fmt::print(
        "No pixel's signal will be off the full spectrum by more than the promise, which is the\n"
        "error of the wavelengths and their weights plus the frames' own {:.3g}, amplified.\n\n",
        plan.frame_error);
}

void print_wavelengths(const Manifest& manifest) {
    fmt::print("{:>12}  {:>12} {:>12} {:>12}  {:>8}  frame\n",
               "lambda (nm)",
               "weight R",
               "weight G",
               "weight B",
               "exposure");
    for (const PlannedWavelength& w : manifest.wavelengths) {
        fmt::print("{:12.3f}  {:12.6g} {:12.6g} {:12.6g}  {:>8}  {} {}\n",
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
    fmt::print(
        "\nThe port spreads these wavelengths over {:.3g} pixels at the image's corner. {} instead "
        "of\n{} keep those of one frame within {:.3g} of each other.\n",
        cost.spread_px,
        counted(planned.plan.frames(), "frame"),
        cost.frames_without,
        planned.plan.scene.pixel_shift);
}

void print_for_people(const PlannedRender& planned, const SceneSet& scenes) {
    const Manifest& manifest = scenes.manifest;
    const RenderPlan& plan = planned.plan;
    fmt::print("{}: {} x {} pixels, {} in {}, {}\n",
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
        fmt::print(
            "The scene {} uses {}; its paths were measured on it\n",
            scene->file.string(),
            names.empty() ? "no spectrum by name" : fmt::format("{}", fmt::join(names, ", ")));
    }
    fmt::print("{} of light, on paths of {:.3g} to {:.3g} m from lamp to floor to camera\n\n",
               counted(plan.family.sources.size(), "kind"),
               plan.family.shortest_path_m,
               plan.family.longest_path_m);
    print_promise(plan);
    print_wavelengths(manifest);
    if (planned.rig.camera.port) print_port(planned);
    print_needs(planned_needs(scenes), manifest.frames.size());
    if (plan.omissions.empty()) return;
    fmt::print("\nLeft out:\n");
    for (const Omission& omission : plan.omissions) {
        fmt::print("  {}: {}\n", omission.what, omission.reason);
    }
}

Action configure_plan(CLI::App& app) {
    const auto options = std::make_shared<PlanCommandOptions>();
    app.add_option("--plot",
                   options->plot,
                   "Plot the light, the wavelengths and the error over path length")
        ->type_name("FILE.svg");
    add_json(app, options->json, "Print the plan as JSON");
    add_planning_options(app, options->planning);
    return [options] {
        const PlannedRender planned = plan_rig(options->planning);
        const SceneSet scenes = scenes_of(planned, options->planning);
        if (!options->plot.empty()) plot_plan(planned.rig, planned.plan, options->plot);
        options->json ? print_json(planned, scenes) : print_for_people(planned, scenes);
        return kDone;
    };
}

}  // namespace

const Command kPlan{"plan",
                    kRenderingCommands,
                    "Show the wavelengths, frames and error bound of a render",
                    configure_plan};

}  // namespace aphotic::cli
