// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/scene_set.h"

#include "scene_gen/reintegration.h"
#include "spectral/atomic_file.h"
#include "spectral/digest.h"

namespace aphotic {

std::array<double, kChannels> lamp_signal(const Rig& rig, const LightFamily& family) {
    constexpr double kError = 1e-6;
    const std::vector<WeightedWavelength> wavelengths =
        reference_grid(rig.camera.sensor, family, rig.camera.range, kError);
    std::array<double, kChannels> signal{};
    for (const WeightedWavelength& w : wavelengths) {
        for (const Strobe& strobe : rig.strobes) {
            const double flux = strobe.power * strobe.spectrum.at(w.lambda_nm);
            for (std::size_t c = 0; c < kChannels; ++c) signal[c] += flux * w.weight[c];
        }
    }
    return signal;
}

namespace {

std::string method_name(PlanMethod method) {
    switch (method) {
        case PlanMethod::Fitted:
            return "fitted";
        case PlanMethod::EqualBands:
            return "equal bands";
        case PlanMethod::Listed:
            return "listed";
    }
    return "";
}

// What a frame knows of light at a wavelength, for later weights (reintegration.h).
void note_light(const Rig& rig, ManifestWavelength& w) {
    w.attenuation_per_m = rig.water.attenuation_per_m(w.lambda_nm);
    for (const Strobe& strobe : rig.strobes) {
        w.flux.push_back(strobe.power * strobe.spectrum.at(w.lambda_nm));
    }
    for (const Spectrum& material : materials_of(rig)) {
        w.reflectance.push_back(material.at(w.lambda_nm));
    }
}

}  // namespace

SceneSet make_scene_set(const Rig& rig, const RenderPlan& plan) {
    const std::vector<WeightedWavelength>& rule = plan.rule.wavelengths;
    std::vector<double> lambda_nm;
    for (const WeightedWavelength& w : rule) lambda_nm.push_back(w.lambda_nm);

    SceneSet set;
    set.scenes = make_scenes(rig, lambda_nm, plan.scene);
    set.ini = render_ini(rig);
    Manifest& manifest = set.manifest;
    manifest.aphotic_version = APHOTIC_VERSION;
    manifest.rig_title = rig.title;
    manifest.rig_sha256 = rig.digest;
    manifest.width_px = rig.camera.width_px;
    manifest.height_px = rig.camera.height_px;
    manifest.geometry = geometry_of(rig, plan.scene);
    manifest.method = method_name(plan.method);
    manifest.tolerance = plan.tolerance;
    manifest.frame_error = plan.frame_error;
    manifest.quality = plan.rule.quality;
    manifest.lamp_signal = lamp_signal(rig, plan.family);
    for (std::size_t f = 0; f < set.scenes.size(); ++f) {
        const FrameScene& scene = set.scenes[f];
        // The settings change pixels as much as the scene does: both make the checksum.
        manifest.frames.push_back({.name = scene.name,
                                   .scene_sha256 = sha256_of_text(scene.sdl + set.ini),
                                   .image_sha256 = ""});
        for (std::size_t c = 0; c < scene.wavelengths.size(); ++c) {
            const WeightedWavelength& weighted = rule[manifest.wavelengths.size()];
            ManifestWavelength w{.lambda_nm = weighted.lambda_nm,
                                 .weight = weighted.weight,
                                 .frame = f,
                                 .channel = std::string(kChannelNames[c]),
                                 .exposure_log2 = scene.wavelengths[c].exposure_log2,
                                 .index_nm = scene.index_nm};
            note_light(rig, w);
            manifest.wavelengths.push_back(std::move(w));
        }
    }
    return set;
}

void write_scenes(const std::filesystem::path& folder, const SceneSet& set) {
    make_folder(folder / "povray" / "frames");
    write_text_file(folder / "povray" / "render.ini", set.ini);
    for (std::size_t f = 0; f < set.scenes.size(); ++f) {
        write_text_file(scene_path(folder, set.manifest.frames[f]), set.scenes[f].sdl);
    }
}

}  // namespace aphotic
