// SPDX-License-Identifier: BSD-3-Clause
#include "cli/plan_plot.h"

#include "report/plot.h"
#include "report/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace aphotic::cli {
namespace {

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
    FittedRule rule{.wavelengths = {}, .quality = plan.quality};
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

}  // namespace

void plot_plan(const Rig& rig, const RenderPlan& plan, const std::filesystem::path& file) {
    write_plots(std::array{light_panel(rig, plan), error_panel(rig, plan)}, file);
}

}  // namespace aphotic::cli
