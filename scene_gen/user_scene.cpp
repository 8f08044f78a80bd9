// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/user_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aphotic {

double UserScene::brightest_radiance(const Rig& rig, double lambda_nm) const {
    double flux = 0.0;
    for (const Strobe& strobe : rig.strobes) flux = std::max(flux, strobe.spectrum.at(lambda_nm));
    const double attenuation_per_m = rig.water.attenuation_per_m(lambda_nm);
    double brightest = 0.0;
    for (const std::vector<Lit>& pixel : pixels) {
        double radiance = 0.0;
        for (const Lit& lit : pixel) {
            radiance += lit.radiance_per_flux * std::exp(-attenuation_per_m * lit.path_m);
        }
        brightest = std::max(brightest, radiance);
    }
    return flux * brightest;
}

PathRange paths_of(const std::vector<std::vector<UserScene::Lit>>& pixels) {
    PathRange range{.shortest_m = std::numeric_limits<double>::infinity(), .longest_m = 0.0};
    for (const auto& pixel : pixels) {
        for (const UserScene::Lit& lit : pixel) {
            range.shortest_m = std::min(range.shortest_m, lit.path_m / kSurveyRoom);
            range.longest_m = std::max(range.longest_m, lit.path_m * kSurveyRoom);
        }
    }
    return range.longest_m > 0.0 ? range : PathRange{};
}

Rig rig_of_scene(Rig rig, const UserScene& scene) {
    const WavelengthRange range = rig.camera.range;
    rig.seafloor = {
        .reflectance = {"reflectance 'white'", {range.first_nm, range.last_nm}, {1.0, 1.0}}};
    rig.materials.clear();
    for (const NamedSpectrum& material : scene.materials) {
        rig.materials.push_back(material.spectrum);
    }
    return rig;
}

}  // namespace aphotic
