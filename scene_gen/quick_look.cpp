// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/quick_look.h"

#include "base/error.h"
#include "scene_gen/exposure.h"
#include "scene_gen/light_paths.h"
#include "scene_gen/rig_sdl.h"
#include "spectral/curve_loader.h"
#include "spectral/refractive_index.h"

#include <fmt/format.h>

#include <algorithm>

namespace aphotic {

namespace {

// The middle of the three, whose index serves all of them.
constexpr double kIndex_nm = kQuickLambda_nm[1];

std::vector<NamedSpectrum> all_of(CurveRole role, std::vector<Spectrum> own) {
    for (const std::string& name : builtin_names(role_name(role))) {
        own.push_back(load_curve(name, role, {}));
    }
    return named(own);
}

std::vector<NamedSpectrum> lamps_for(const Rig& rig) {
    std::vector<Spectrum> own;
    for (const Strobe& strobe : rig.strobes) own.push_back(strobe.spectrum);
    return all_of(CurveRole::LampSpectrum, std::move(own));
}

// The name as used by a scene in the rig's folder.
std::string name_from(const std::filesystem::path& folder, const NamedSpectrum& material) {
    const std::optional<CurveSource>& source = material.spectrum.source();
    if (!source || !source->is_file()) return material.name;
    // Relative to the folder: the path to the folder is irrelevant to the scene.
    const std::string here =
        std::filesystem::path(source->table).lexically_proximate(folder).generic_string();
    // A scene cannot use a name that POV-Ray cannot represent, so any unique one will do.
    return scene_name(here) == here ? here : material.name;
}

std::vector<NamedSpectrum> reflectances_for(const Rig& rig, const std::filesystem::path& folder) {
    std::vector<NamedSpectrum> all = all_of(CurveRole::Reflectance, materials_of(rig));
    for (NamedSpectrum& material : all) material.name = name_from(folder, material);
    return all;
}

std::vector<GlassIndex> glasses() {
    std::vector<GlassIndex> all;
    for (const char* name : {"bk7", "fused-silica", "pmma", "polycarbonate", "sapphire"}) {
        all.push_back({.name = name, .index = builtin_glass(name).index(kIndex_nm)});
    }
    return all;
}

Channels exposure_of(const Rig& rig) {
    const RadianceBound bound(rig);
    Channels exposure{};
    double brightest = 0.0;
    for (std::size_t c = 0; c < exposure.size(); ++c) {
        double flux = 0.0;
        for (const Strobe& strobe : rig.strobes) {
            flux += strobe.power * strobe.spectrum.at(kQuickLambda_nm[c]);
        }
        exposure[c] = flux > 0.0 ? 1.0 / flux : 0.0;
        brightest = std::max(brightest, bound.at(kQuickLambda_nm[c]) * exposure[c]);
    }
    if (brightest > 0.0) {
        for (double& e : exposure) e *= kQuickPeak / brightest;
    }
    return exposure;
}

std::vector<StrobeInScene> strobes_of(const Rig& rig) {
    const double K_per_m = most_attenuation_per_m(rig, kQuickLambda_nm);
    std::vector<StrobeInScene> strobes;
    for (const Strobe& strobe : rig.strobes) {
        strobes.push_back({.beam = strobe.beam, .lamps = lamp_grid(rig, strobe, K_per_m)});
    }
    return strobes;
}

}  // namespace

std::string quick_look_sdl(const Rig& rig, const std::filesystem::path& rig_folder) {
    Band band{.lambda_nm = kQuickLambda_nm,
              .exposure = exposure_of(rig),
              .attenuation_per_m = {},
              .water_index = rig.water.refractive_index(kIndex_nm),
              .glasses = glasses(),
              .lamps = lamps_for(rig),
              .reflectances = reflectances_for(rig, rig_folder)};
    for (std::size_t c = 0; c < kQuickLambda_nm.size(); ++c) {
        band.attenuation_per_m[c] = rig.water.attenuation_per_m(kQuickLambda_nm[c]);
    }
    const std::string rig_text =
        rig_sdl(rig, strobes_of(rig), band.lamps, band.reflectances, SceneAuthor::User);
    return fmt::format(
        "// This work is licensed under the BSD 3-Clause License "
        "(SPDX-License-Identifier: BSD-3-Clause).\n"
        "//\n"
        "//    Persistence of Vision Ray Tracer version 3.7 Include File\n"
        "//    File: aphotic_quick.inc\n"
        "//    Description: What aphotic.inc takes for a quick look: three wavelengths, and the\n"
        "//                 rig '{}'. Written by: aphotic generate RIG --quick-look FILE\n"
        "\n"
        "#ifndef (Aphotic_Quick_Inc_Temp)\n"
        "#declare Aphotic_Quick_Inc_Temp = version;\n"
        "#version 3.7;\n"
        "#ifdef (View_POV_Include_Stack)\n"
        "   #debug \"including aphotic_quick.inc\\n\"\n"
        "#end\n"
        "\n"
        "#declare Aphotic_Quick_Look = true;\n"
        "{}\n"
        "{}"
        "\n"
        "#version Aphotic_Quick_Inc_Temp;\n"
        "#end   // aphotic_quick.inc\n",
        sdl_comment(rig.title),
        band_sdl(band),
        rig_text);
}

}  // namespace aphotic
