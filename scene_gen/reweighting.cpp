// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/reweighting.h"

#include "base/error.h"
#include "base/offered.h"
#include "light/dispersion.h"
#include "rig/geometry_signature.h"
#include "rig/solid.h"
#include "scene_gen/certificate.h"
#include "scene_gen/scene_set.h"
#include "scene_gen/veil_planes.h"
#include "spectral/wavelength_search.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace aphotic {

namespace {

void require_same_signature(const Rig& changed, const Manifest& manifest) {
    std::map<std::string, std::string> found = geometry_signature(changed);
    std::map<std::string, std::string> allowed = manifest.geometry;
    for (const auto& [key, text] : allowed) found.try_emplace(key, "none");
    for (const auto& [key, text] : found) {
        const std::string& frames = allowed.try_emplace(key, "none").first->second;
        if (text == frames) continue;
        throw InputError(
            "{}: found {}; allowed: {}, as the frames were rendered", key, text, frames);
    }
}

// The frames' light, in the order of light_family_by_strobe(lit).
std::vector<FrameLight> light_in(const Manifest& manifest,
                                 const Rig& changed,
                                 const LightFamily& family) {
    std::vector<FrameLight> frames;
    const std::size_t materials = materials_of(changed).size();
    for (const PlannedWavelength& w : manifest.wavelengths) {
        const auto& [attenuation_per_m, flux, reflectances] = w.light;
        if (flux.size() != changed.strobes.size() || reflectances.size() != materials) {
            throw InputError(
                "found {} strobes and {} further materials; allowed: {} and {}, as "
                "the frames were rendered",
                changed.strobes.size(),
                materials - 1,
                flux.size(),
                static_cast<int>(reflectances.size()) - 1);
        }
        FrameLight frame{.lambda_nm = w.lambda_nm,
                         .attenuation_per_m = attenuation_per_m,
                         .sources = {},
                         .tilt = family.tilt ? family.tilt->at(w.index_nm) : 0.0};
        for (std::size_t s = 0; s < changed.strobes.size(); ++s) {
            const Strobe& strobe = changed.strobes[s];
            if (strobe.power == 0.0) {
                if (flux[s] == 0.0) continue;
                throw InputError(
                    "strobe '{}': found power 0; allowed: more, since the frames hold its light",
                    strobe.name);
            }
            for (const double reflectance : reflectances) {
                frame.sources.push_back(flux[s] / strobe.power * reflectance);
            }
            if (has_highlight(changed)) frame.sources.push_back(flux[s] / strobe.power);
        }
        frames.push_back(std::move(frame));
    }
    return frames;
}

Rig with_lit_strobes_only(Rig rig) {
    std::erase_if(rig.strobes, [](const Strobe& strobe) { return strobe.power == 0.0; });
    return rig;
}

// Behind a port the range includes the frames' wavelengths, even if another sensor does not cover
// them.
Rig covering_frames(Rig rig, const Manifest& manifest) {
    if (!disperses(rig)) return rig;
    for (const PlannedWavelength& w : manifest.wavelengths) {
        rig.camera.range.first_nm = std::min(rig.camera.range.first_nm, w.index_nm);
        rig.camera.range.last_nm = std::max(rig.camera.range.last_nm, w.index_nm);
    }
    return rig;
}

// The fewest additional wavelengths that would achieve the tolerance, for the message.
std::string lacking(const QuadratureFitter& fitter,
                    const Rig& changed,
                    const std::vector<FrameLight>& frames,
                    double frame_error,
                    double tolerance) {
    constexpr int kMost = 6;
    for (int count = 1; count <= kMost; ++count) {
        const std::vector<double> lambda_nm =
            best_wavelengths(fitter, changed.camera.range, count, frame_error, frames);
        std::vector<FrameLight> all = frames;
        for (const double nm : lambda_nm) all.push_back(fitter.frame_at(nm));
        if (fitter.fit(all, frame_error).promise(frame_error) > tolerance) continue;
        return fmt::format("it lacks {} at {:.2f} nm in the changed rig's water and light",
                           count == 1 ? "a frame" : "frames",
                           fmt::join(lambda_nm, ", "));
    }
    return "render the changed rig instead";
}

}  // namespace

Manifest reintegrate(const Rig& changed, const Manifest& manifest, double tolerance) {
    require_same_signature(changed, manifest);
    LightFamily family =
        light_family_by_strobe(covering_frames(with_lit_strobes_only(changed), manifest));
    if (manifest.scene) {
        family.shortest_path_m = manifest.scene->shortest_path_m;
        family.longest_path_m = manifest.scene->longest_path_m;
    }
    const QuadratureFitter fitter(changed.camera.sensor, family, changed.camera.range);
    const std::vector<FrameLight> frames = light_in(manifest, changed, family);
    FittedRule rule = fitter.fit(frames, manifest.frame_error);
    Manifest now = manifest;
    take_weights(rule, now.wavelengths);
    std::span<const PlannedWavelength> in_view;
    if (!manifest.scene) in_view = now.wavelengths;
    certify(changed, fitter, frames, in_view, rule);
    if (changed.water.scatters()) {
        require_bare_floor_under_veil(changed);
        if (manifest.scene)
            throw InputError(
                "found frames of a scene; allowed with water that scatters: those of "
                "the bare floor");
        rule.quality = with_veil(rule.quality, veil_plane_error(changed));
    }
    const double promise = rule.promise(manifest.frame_error);
    if (promise > tolerance) {
        throw InputError(fmt::format(
            "the frames give this rig's image to {} only; allowed: {}, the tolerance; {}",
            at_least(promise),
            tolerance,
            lacking(fitter, changed, frames, manifest.frame_error, tolerance)));
    }
    now.veil.reset();  // belongs to the frames' own rig
    now.model.reset();
    for (PlannedWavelength& w : now.wavelengths) w.veil.reset();
    now.rig_title = changed.title;
    now.rig_sha256 = changed.digest;
    now.method = "fitted to frames of another rig";
    now.tolerance = tolerance;
    now.quality = rule.quality;
    now.lamp_signal = lamp_signal(changed, family);
    require_light_that_counts(now.wavelengths, now.frame_error);
    return now;
}

}  // namespace aphotic
