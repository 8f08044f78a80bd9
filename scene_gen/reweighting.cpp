// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/reweighting.h"

#include "base/error.h"
#include "rig/geometry_signature.h"
#include "rig/solid.h"
#include "scene_gen/certificate.h"
#include "scene_gen/half_underflow.h"
#include "scene_gen/scene_set.h"
#include "spectral/wavelength_search.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>

namespace aphotic {

namespace {

// Of geometry_of's text.
LampGrid grid_in(const std::string& key, const std::string& text) {
    constexpr int kMostLamps = 100'000;  // of a scene (scene_gen/pov_scene.cpp)
    LampGrid grid{.across = 0, .along = 0};
    const char* const end = text.data() + text.size();
    const auto [cross, fault] = std::from_chars(text.data(), end, grid.across);
    constexpr std::string_view kBy = " x ";
    const char* rest = cross;
    if (fault == std::errc() && std::string_view(cross, end).starts_with(kBy)) {
        rest = std::from_chars(cross + kBy.size(), end, grid.along).ptr;
    }
    const auto is_few = [](int lamps) { return lamps >= 1 && lamps <= kMostLamps; };
    if (rest != end || !is_few(grid.across) || !is_few(grid.along)) {
        throw InputError(
            fmt::format("{}: found '{}'; allowed: ACROSS x ALONG, from 1 x 1 to {} each",
                        key,
                        text,
                        kMostLamps));
    }
    return grid;
}

void require_same_geometry(const Rig& changed, const Manifest& manifest) {
    // How many lamps stand for an emitter is the frames' affair.
    constexpr std::string_view kLamps = "lamps";
    std::map<std::string, std::string> found = geometry_of(changed, {});
    for (const auto& [key, value] : manifest.geometry) {
        if (key.ends_with(kLamps)) found[key] = value;
    }
    for (const auto& [key, value] : found) {
        const auto frames = manifest.geometry.find(key);
        if (frames != manifest.geometry.end() && frames->second == value) continue;
        throw InputError(fmt::format("{}: found {}; allowed: {}, as the frames were rendered",
                                     key,
                                     value,
                                     frames == manifest.geometry.end() ? "none" : frames->second));
    }
    for (const auto& [key, value] : manifest.geometry) {
        if (!found.contains(key)) {
            throw InputError(fmt::format(
                "{}: found none; allowed: {}, as the frames were rendered", key, value));
        }
    }
}

// The frames' light, in the order of light_family_by_strobe(lit).
std::vector<FrameLight> light_in(const Manifest& manifest,
                                 const Rig& changed,
                                 const LightFamily& family) {
    std::vector<FrameLight> frames;
    const std::size_t materials = materials_of(changed).size();
    for (const ManifestWavelength& w : manifest.wavelengths) {
        if (w.flux.size() != changed.strobes.size() || w.reflectance.size() != materials) {
            throw InputError(
                fmt::format("found {} strobes and {} further materials; allowed: {} and {}, as "
                            "the frames were rendered",
                            changed.strobes.size(),
                            materials - 1,
                            w.flux.size(),
                            static_cast<int>(w.reflectance.size()) - 1));
        }
        FrameLight frame{.lambda_nm = w.lambda_nm,
                         .attenuation_per_m = w.attenuation_per_m,
                         .sources = {},
                         .tilt = family.tilt ? family.tilt->at(w.index_nm) : 0.0};
        for (std::size_t s = 0; s < changed.strobes.size(); ++s) {
            const Strobe& strobe = changed.strobes[s];
            if (strobe.power == 0.0) {
                if (w.flux[s] == 0.0) continue;
                throw InputError(fmt::format(
                    "strobe '{}': found power 0; allowed: more, for the frames hold its light",
                    strobe.name));
            }
            for (const double reflectance : w.reflectance) {
                frame.sources.push_back(w.flux[s] / strobe.power * reflectance);
            }
            if (has_highlight(changed)) frame.sources.push_back(w.flux[s] / strobe.power);
        }
        frames.push_back(std::move(frame));
    }
    return frames;
}

// What they show of the bare floor; of a user's own scene, none.
std::vector<FloorFrame> floor_frames(const Manifest& manifest, const Rig& changed) {
    std::vector<FloorFrame> frames;
    for (const ManifestWavelength& w : manifest.wavelengths) {
        if (manifest.scene) break;
        FloorFrame frame{.index_nm = w.index_nm,
                         .attenuation_per_m = w.attenuation_per_m,
                         .reflectance = w.reflectance.front()};
        for (std::size_t s = 0; s < changed.strobes.size(); ++s) {
            const double power = changed.strobes[s].power;
            frame.spectrum.push_back(power > 0.0 ? w.flux[s] / power : 0.0);
        }
        frames.push_back(std::move(frame));
    }
    return frames;
}

Rig with_lit_strobes_only(Rig rig) {
    std::erase_if(rig.strobes, [](const Strobe& strobe) { return strobe.power == 0.0; });
    return rig;
}

// Behind a port the frames' wavelengths count too, which another sensor need not see.
Rig covering_frames(Rig rig, const Manifest& manifest) {
    if (!rig.camera.port) return rig;
    for (const ManifestWavelength& w : manifest.wavelengths) {
        rig.camera.range.first_nm = std::min(rig.camera.range.first_nm, w.index_nm);
        rig.camera.range.last_nm = std::max(rig.camera.range.last_nm, w.index_nm);
    }
    return rig;
}

// The fewest further wavelengths with which the tolerance would be kept, as the message says it.
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

std::map<std::string, std::string> geometry_of(const Rig& rig, const SceneOptions& options) {
    std::map<std::string, std::string> all = geometry_signature(rig);
    for (const Strobe& strobe : rig.strobes) {
        if (!strobe.emitter) continue;
        const LampGrid grid =
            options.emitter_lamps.value_or(lamp_grid(rig, strobe, options.most_attenuation_per_m));
        all[fmt::format("strobe '{}' lamps", strobe.name)] =
            fmt::format("{} x {}", grid.across, grid.along);
    }
    return all;
}

std::vector<LampGrid> rendered_lamps(const Rig& rig, const Manifest& manifest) {
    std::vector<double> lambda_nm;
    for (const ManifestWavelength& w : manifest.wavelengths) lambda_nm.push_back(w.lambda_nm);
    const double K_per_m = most_attenuation_per_m(rig, lambda_nm);
    std::vector<LampGrid> lamps;
    for (const Strobe& strobe : rig.strobes) {
        const std::string key = fmt::format("strobe '{}' lamps", strobe.name);
        const auto noted = manifest.geometry.find(key);
        lamps.push_back(noted == manifest.geometry.end() ? lamp_grid(rig, strobe, K_per_m)
                                                         : grid_in(key, noted->second));
    }
    return lamps;
}

Manifest reintegrate(const Rig& changed, const Manifest& manifest, double tolerance) {
    require_same_geometry(changed, manifest);
    LightFamily family =
        light_family_by_strobe(covering_frames(with_lit_strobes_only(changed), manifest));
    if (manifest.scene) {
        family.shortest_path_m = manifest.scene->shortest_path_m;
        family.longest_path_m = manifest.scene->longest_path_m;
    }
    const QuadratureFitter fitter(changed.camera.sensor, family, changed.camera.range);
    const std::vector<FrameLight> frames = light_in(manifest, changed, family);
    FittedRule rule = fitter.fit(frames, manifest.frame_error);
    certify(changed, fitter, frames, floor_frames(manifest, changed), rule);
    const double promise = rule.promise(manifest.frame_error);
    if (promise > tolerance) {
        throw InputError(
            fmt::format("the frames can be this rig's image to {:.3g} only; allowed: {}, the "
                        "tolerance; {}",
                        promise,
                        tolerance,
                        lacking(fitter, changed, frames, manifest.frame_error, tolerance)));
    }
    Manifest now = manifest;
    now.rig_title = changed.title;
    now.rig_sha256 = changed.digest;
    now.method = "fitted to frames of another rig";
    now.tolerance = tolerance;
    now.quality = rule.quality;
    now.lamp_signal = lamp_signal(changed, family);
    for (std::size_t j = 0; j < now.wavelengths.size(); ++j) {
        now.wavelengths[j].weight = rule.wavelengths[j].weight;
    }
    require_light_that_counts(now.wavelengths, now.frame_error);
    return now;
}

}  // namespace aphotic
