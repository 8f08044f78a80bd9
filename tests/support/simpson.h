// SPDX-License-Identifier: BSD-3-Clause
//
// Integrals over wavelength of the tests' own: Simpson's rule between all knots of all tables,
// where the product of the tables is smooth. Of t^4 over an interval n panels miss 1 / (120 n^4).
#pragma once

#include "rig/rig.h"

#include <algorithm>
#include <set>
#include <vector>

namespace aphotic {

struct SimpsonNode {
    double nm;
    double weight_nm;
};

inline std::vector<SimpsonNode> simpson_nodes(const std::set<double>& knots_nm, int panels) {
    std::vector<SimpsonNode> nodes;
    for (auto it = knots_nm.begin(); std::next(it) != knots_nm.end(); ++it) {
        const double end_nm = *std::next(it);
        const double width_nm = end_nm - *it;
        for (int i = 0; i <= 2 * panels; ++i) {
            const double times = i == 0 || i == 2 * panels ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
            nodes.push_back({std::min(end_nm, *it + width_nm * i / (2.0 * panels)),
                             times * width_nm / (6.0 * panels)});
        }
    }
    return nodes;
}

inline std::set<double> knots_within(WavelengthRange range,
                                     const std::vector<const Spectrum*>& curves) {
    std::set<double> knots_nm{range.first_nm, range.last_nm};
    for (const Spectrum* curve : curves) {
        for (const double nm : curve->lambda_nm()) {
            if (range.contains(nm)) knots_nm.insert(nm);
        }
    }
    return knots_nm;
}

// For all that a rig's image is made of, lamps over bare materials in water.
inline std::vector<SimpsonNode> simpson_nodes(const Rig& rig, int panels) {
    std::vector<const Spectrum*> curves = rig.camera.sensor.curves();
    curves.push_back(&rig.seafloor.reflectance);
    for (const Spectrum& reflectance : rig.materials) curves.push_back(&reflectance);
    if (rig.water.multiple != 0.0) curves.push_back(&rig.water.absorption_per_m);
    for (const Strobe& strobe : rig.strobes) curves.push_back(&strobe.spectrum);
    return simpson_nodes(knots_within(rig.camera.range, curves), panels);
}

// The rig with its lamps, water and floor at every wavelength as they are at this one: its radiance
// at another is what a frame holds whose rays are those of the other.
inline Rig frozen_at(const Rig& rig, double lambda_nm) {
    const auto flat = [](double value) {
        return Spectrum("flat", {100.0, 2000.0}, {value, value});
    };
    Rig frozen = rig;
    if (rig.water.multiple != 0.0) {
        frozen.water.absorption_per_m = flat(rig.water.absorption_per_m.at(lambda_nm));
    }
    frozen.seafloor.reflectance = flat(rig.seafloor.reflectance.at(lambda_nm));
    for (Strobe& strobe : frozen.strobes) strobe.spectrum = flat(strobe.spectrum.at(lambda_nm));
    return frozen;
}

}  // namespace aphotic
