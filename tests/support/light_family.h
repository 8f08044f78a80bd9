// SPDX-License-Identifier: BSD-3-Clause
//
// Light for the fitters of wavelengths: sources, water and a sensor of a few numbers.
#pragma once

#include "spectral/curve_loader.h"
#include "spectral/quadrature_fit.h"
#include "support/flat.h"

#include <string>
#include <utility>
#include <vector>

namespace aphotic {

// first at 400 nm, last at 700 nm.
inline Spectrum line(double first, double last) {
    return {"line", {400.0, 700.0}, {first, last}};
}

inline Spectrum times(const Spectrum& curve, double factor) {
    std::vector<double> values(curve.values().begin(), curve.values().end());
    for (double& value : values) value *= factor;
    return {curve.name(), {curve.lambda_nm().begin(), curve.lambda_nm().end()}, values};
}

inline Sensor flat_sensor(ResponseKind kind = ResponseKind::Energy) {
    return {{flat(1.0), flat(2.0), flat(3.0)}, kind};
}

inline Water clear_water() {
    return {.absorption_per_m = flat(1.0), .multiple = 0.0};
}

inline Water pure_water() {
    return {.absorption_per_m = load_curve("pope-fry-1997", CurveRole::WaterAbsorption, {})};
}

inline std::vector<Spectrum> lit_by_the_flash(const std::string& material) {
    return {load_curve("xenon-flash", CurveRole::LampSpectrum, {}),
            load_curve(material, CurveRole::Reflectance, {})};
}

inline LightFamily family_of(std::vector<std::vector<Spectrum>> sources,
                             Water water,
                             double shortest_path_m,
                             double longest_path_m) {
    return {.sources = std::move(sources),
            .water = std::move(water),
            .shortest_path_m = shortest_path_m,
            .longest_path_m = longest_path_m,
            .tilt = {}};
}

inline LightFamily sea_floor(const std::vector<std::string>& materials,
                             double shortest_path_m,
                             double longest_path_m) {
    LightFamily family = family_of({}, pure_water(), shortest_path_m, longest_path_m);
    for (const std::string& material : materials)
        family.sources.push_back(lit_by_the_flash(material));
    return family;
}

inline std::vector<FrameLight> frames_at(const QuadratureFitter& fitter,
                                         const std::vector<double>& lambda_nm) {
    std::vector<FrameLight> frames;
    for (const double nm : lambda_nm) frames.push_back(fitter.frame_at(nm));
    return frames;
}

inline std::vector<FrameLight> frames_of(const QuadratureFitter& fitter,
                                         const std::vector<WeightedWavelength>& rule) {
    std::vector<FrameLight> frames;
    for (const WeightedWavelength& w : rule) frames.push_back(fitter.frame_at(w.lambda_nm));
    return frames;
}

}  // namespace aphotic
