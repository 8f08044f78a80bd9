// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/render_plan.h"

#include "base/degrees.h"
#include "base/error.h"
#include "base/offered.h"
#include "light/dispersion.h"
#include "scene_gen/camera_rays.h"
#include "scene_gen/certificate.h"
#include "scene_gen/povray_veil.h"
#include "scene_gen/veil_planes.h"
#include "spectral/wavelength_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace aphotic {

namespace {

// The least tolerance to try, relative to the error of veil and frames, which does not depend on
// the wavelengths.
constexpr double kVeilsNext = 1.1;

std::vector<double> wavelengths_of(std::span<const WeightedWavelength> rule) {
    std::vector<double> lambda_nm;
    for (const WeightedWavelength& w : rule) lambda_nm.push_back(w.lambda_nm);
    return lambda_nm;
}

// The rig as shown in the frames.
Rig lit_rig(const Rig& rig, const SceneOptions& options) {
    return options.user_scene ? rig_of_scene(rig, *options.user_scene) : rig;
}

LightFamily family_of(const Rig& rig, const PlanRequest& request) {
    const UserScene* scene = request.scene.user_scene.get();
    LightFamily family = light_family(lit_rig(rig, request.scene));
    std::optional<PathRange> paths = request.paths;
    if (!paths && scene != nullptr) paths = scene->paths;
    if (paths) {
        family.shortest_path_m = paths->shortest_m;
        family.longest_path_m = paths->longest_m;
    }
    return family;
}

// Behind a port, frames are counted instead of wavelengths: three wavelengths that cannot share a
// frame cost three frames.
int wavelengths_per_step(const Rig& rig, const SceneOptions& scene) {
    return disperses(rig) ? 1 : scene.wavelengths_per_frame;
}

// The effect of a shift on an object has no bound.
double pixel_shift(const Rig& rig, const SceneOptions& scene) {
    return rig.objects.empty() && !scene.user_scene ? scene.pixel_shift : 0.0;
}

// As many wavelengths as kinds of light distinguish them all on one path; a few more serve the
// others.
int most_wavelengths(const LightFamily& family) {
    constexpr int kUsual = PlanTarget{}.most;
    constexpr int kFewMore = 8;
    return std::max(kUsual, static_cast<int>(family.sources.size()) + kFewMore);
}

// Groups the wavelengths into frames, and fits the weights to these, or evaluates those of bands.
void share_frames(const Rig& rig,
                  const QuadratureFitter& fitter,
                  std::span<const double> lambda_nm,
                  RenderPlan& plan,
                  const std::vector<WeightedWavelength>& bands = {}) {
    plan.wavelengths = in_frames(rig, lambda_nm, plan.scene);
    const std::vector<FrameLight> frames = frames_light(fitter, plan.wavelengths);
    FittedRule rule =
        bands.empty() ? fitter.fit(frames, plan.frame_error)
                      : FittedRule{.wavelengths = bands, .quality = fitter.judge(bands, frames)};
    take_weights(rule, plan.wavelengths);
    std::span<const PlannedWavelength> in_view;
    if (!plan.scene.user_scene) in_view = plan.wavelengths;
    certify(rig, fitter, frames, in_view, rule);
    plan.quality = with_veil(rule.quality, plan.veil_error);
    if (!std::isfinite(plan.promise())) {
        throw InputError(
            "found weights that give a channel light to which it is blind, so nothing can be "
            "promised; allowed: fitted wavelengths, without --bands");
    }
}

// The fewest wavelengths that achieve the tolerance, also by the certificate: if they satisfy only
// the fit, it is repeated for a smaller tolerance. If sharing frames behind a port exceeds the
// tolerance, no frame is shared. The result is the plan's promise, above the tolerance if no such
// plan is found.
double best_promise(double tolerance,
                    const Rig& rig,
                    const QuadratureFitter& fitter,
                    const PlanRequest& request,
                    RenderPlan& plan) {
    constexpr int kMostTrials = 4;
    constexpr double kStricter = 0.7;
    const double fixed = plan.frame_error + plan.veil_error;
    if (plan.veil_error > 0.0 && tolerance <= fixed) return kVeilsNext * fixed;
    PlanTarget target{.tolerance = tolerance - plan.veil_error,
                      .frame_error = plan.frame_error,
                      .step = wavelengths_per_step(rig, request.scene),
                      .most = most_wavelengths(plan.family)};
    plan.tolerance = tolerance;
    plan.scene.bailout = kRayShare * tolerance;
    double promise = std::numeric_limits<double>::infinity();
    for (int trial = 0; trial < kMostTrials; ++trial) {
        const FittedRule rule = plan_wavelengths(fitter, rig.camera.range, target);
        const double fitted = rule.promise(plan.frame_error);
        // If the fit's own error is too large, there is no plan, whatever its promise.
        if (fitted > target.tolerance) return trial == 0 ? fitted + plan.veil_error : promise;
        const std::vector<double> lambda_nm = wavelengths_of(rule.wavelengths);
        plan.scene.pixel_shift = pixel_shift(rig, request.scene);
        share_frames(rig, fitter, lambda_nm, plan);
        if (plan.promise() > tolerance && plan.scene.pixel_shift > 0.0) {
            plan.scene.pixel_shift = 0.0;
            share_frames(rig, fitter, lambda_nm, plan);
        }
        promise = std::min(promise, plan.promise());
        if (promise <= tolerance) return promise;
        const double allowed = tolerance - plan.frame_error;
        target.tolerance = plan.frame_error + kStricter * (target.tolerance - plan.frame_error) *
                                                  allowed / (plan.promise() - plan.frame_error);
    }
    return promise;
}

// If it cannot be achieved, the message suggests a tolerance that was tried: searches are not
// monotonic, so a larger tolerance may fail where this one works.
void plan_to_tolerance(const Rig& rig,
                       const QuadratureFitter& fitter,
                       const PlanRequest& request,
                       RenderPlan& plan) {
    constexpr double kNext = 1.3;
    double promise = best_promise(request.tolerance, rig, fitter, request, plan);
    if (promise <= request.tolerance) return;
    const double least = promise;
    for (double offered = at_least(promise); offered <= 1.0;
         offered = at_least(std::max(promise, kNext * offered))) {
        promise = best_promise(offered, rig, fitter, request, plan);
        if (promise > offered) continue;
        throw InputError("tolerance: found {}; allowed: {}, which {} wavelengths achieve{}",
                         request.tolerance,
                         offered,
                         plan.wavelengths.size(),
                         plan.veil_error > 0.0
                             ? fmt::format("; the veil alone is off by {:.2g}", plan.veil_error)
                             : "");
    }
    throw InputError(
        "tolerance: found {}, but no plan for this rig achieves even 1: the best found promises "
        "{:.3g}; allowed: --fitted, which accepts whatever error N wavelengths have",
        request.tolerance,
        least);
}

// Paths that no plan serves are most likely caused by a misplaced decimal point in the focal
// length: no lens without distortion sees more than 135 degrees.
[[noreturn]] void refuse(const Rig& rig, const std::string& why) {
    constexpr double kMostView_rad = 150.0 * kRadiansPerDegree;
    constexpr double kMillimetresPerMetre = 1e3;
    const Camera& camera = rig.camera;
    const double half_m =
        0.5 * camera.pixel_pitch_m * std::hypot(camera.width_px, camera.height_px);
    const double view_rad = 2.0 * std::atan(half_m / camera.focal_length_m);
    if (view_rad <= kMostView_rad) throw InputError(why);
    throw InputError(
        "{}; or another camera.focal_length_mm: {:.6g} gives a field of view of {:.1f} degrees "
        "from corner to corner, and no lens without distortion exceeds 135",
        why,
        kMillimetresPerMetre * camera.focal_length_m,
        view_rad / kRadiansPerDegree);
}

// POV-Ray's samples at a shadow's edge have no error bound.
void add_povray_veil(const Rig& rig, int samples, RenderPlan& plan) {
    const bool is_user_scene = plan.scene.user_scene != nullptr;
    const std::vector<LampGrid> lamps = scene_lamps(rig, plan.wavelengths, plan.scene);
    plan.scene.povray_veil =
        plan_povray_veil(rig,
                         plan.family,
                         {.samples = samples,
                          .lamps = lamps,
                          .is_user_scene = is_user_scene,
                          .fits_weights = plan.method != PlanMethod::EqualBands,
                          .frame_error = plan.frame_error},
                         plan.wavelengths);
    plan.quality = with_povray_veil(plan.quality, *plan.scene.povray_veil);
    if (is_user_scene || !rig.objects.empty())
        plan.no_promise.push_back("POV-Ray samples the veil, whose shadows have no error bound");
}

}  // namespace

double frame_error(const Rig& rig) {
    const bool has_emitter =
        std::ranges::any_of(rig.strobes, [](const Strobe& s) { return s.emitter.has_value(); });
    return kFrameError + (has_emitter ? kLampError : 0.0);
}

std::vector<PlannedWavelength> in_frames(const Rig& rig,
                                         std::span<const double> lambda_nm,
                                         const SceneOptions& options) {
    const Rig lit = lit_rig(rig, options);
    std::vector<PlannedWavelength> wavelengths;
    std::size_t first = 0;  // of the frame
    for (const double nm : lambda_nm) {
        PlannedWavelength w{.lambda_nm = nm, .light = source_light(lit, nm)};
        w.channel = wavelengths.size() - first;
        const bool joins =
            w.channel > 0 && w.channel < static_cast<std::size_t>(options.wavelengths_per_frame) &&
            corner_shift_px(rig, wavelengths[first].lambda_nm, nm) <= options.pixel_shift;
        if (!joins) {
            first = wavelengths.size();
            w.channel = 0;
        }
        if (first > 0) w.frame = wavelengths.back().frame + (joins ? 0 : 1);
        wavelengths.push_back(std::move(w));
        for (PlannedWavelength& in_frame : std::span(wavelengths).subspan(first))
            in_frame.index_nm = std::midpoint(wavelengths[first].lambda_nm, nm);
    }
    return wavelengths;
}

std::vector<FrameLight> frames_light(const QuadratureFitter& fitter,
                                     std::span<const PlannedWavelength> wavelengths) {
    const std::optional<Spectrum>& tilt = fitter.family().tilt;
    std::vector<FrameLight> frames;
    for (const PlannedWavelength& w : wavelengths) {
        frames.push_back(fitter.frame_at(w.lambda_nm));
        if (tilt) frames.back().tilt = tilt->at(w.index_nm);
    }
    return frames;
}

void take_weights(const FittedRule& rule, std::span<PlannedWavelength> wavelengths) {
    for (std::size_t j = 0; j < wavelengths.size(); ++j) {
        wavelengths[j].weight = rule.wavelengths[j].weight;
    }
}

namespace {

RenderPlan plan_direct_light(const Rig& rig, const PlanRequest& request) {
    if (request.scene.format == FrameFormat::Png16 && request.scene.veil_samples) {
        throw InputError(
            "--frame-format: found png16 with --veil povray, whose lobes cancel and leave such "
            "frames too few digits; allowed: exr, or --veil quadrature");
    }
    const int least_px = least_width_px(request.scene.antialias > 0);
    if (rig.camera.lens && rig.camera.width_px < least_px) {
        throw InputError(
            "camera: found {} columns with a calibrated lens; allowed: {} or more, since POV-Ray "
            "finds no rays for fewer",
            rig.camera.width_px,
            least_px);
    }
    const WavelengthRange range = rig.camera.range;
    RenderPlan plan{.method = PlanMethod::Fitted,
                    .tolerance = 0.0,
                    .family = family_of(rig, request),
                    .frame_error = frame_error(rig),
                    .veil_error = rig.water.scatters() && !request.scene.veil_samples
                                      ? veil_plane_error(rig)
                                      : 0.0,
                    .scene = request.scene,
                    .omissions = omissions(rig, request.scene.user_scene != nullptr)};
    plan.scene.pixel_shift = pixel_shift(rig, request.scene);
    if (request.scene.user_scene) plan.no_promise = request.scene.user_scene->no_promise;
    const QuadratureFitter fitter(rig.camera.sensor, plan.family, range);
    std::vector<double> lambda_nm;
    std::vector<WeightedWavelength> bands;
    if (request.bands) {
        plan.method = PlanMethod::EqualBands;
        bands = equal_bands(rig.camera.sensor, range, *request.bands);
        lambda_nm = wavelengths_of(bands);
    } else if (!request.wavelengths_nm.empty()) {
        plan.method = PlanMethod::Listed;
        require_wavelengths(range, request.wavelengths_nm);
        lambda_nm = request.wavelengths_nm;
    } else if (request.fitted) {
        lambda_nm = best_wavelengths(fitter, range, *request.fitted, plan.frame_error);
    } else {
        try {
            plan_to_tolerance(rig, fitter, request, plan);
        } catch (const InputError& error) {
            refuse(rig, error.what());
        }
        return plan;
    }
    plan.scene.bailout = kRayShare * plan.frame_error;
    share_frames(rig, fitter, lambda_nm, plan, bands);
    return plan;
}

}  // namespace

RenderPlan plan_render(const Rig& rig, const PlanRequest& request) {
    RenderPlan plan = plan_direct_light(rig, request);
    if (!rig.water.scatters() || !request.scene.veil_samples) return plan;
    const int samples = *request.scene.veil_samples;
    add_povray_veil(rig, samples, plan);
    // The most additional wavelengths for the veil, whose paths vary more.
    constexpr int kMostMore = 9;
    const int fewest = static_cast<int>(plan.wavelengths.size());
    const int step = wavelengths_per_step(rig, request.scene);
    PlanRequest more = request;
    for (int n = fewest + step; n <= fewest + kMostMore && plan.tolerance > 0.0 &&
                                worst_error(plan.scene.povray_veil->quality) > request.tolerance;
         n += step) {
        more.fitted = n;
        plan = plan_direct_light(rig, more);
        plan.tolerance = request.tolerance;
        plan.scene.bailout = kRayShare * request.tolerance;
        add_povray_veil(rig, samples, plan);
    }
    return plan;
}

}  // namespace aphotic
