// SPDX-License-Identifier: BSD-3-Clause
//
// Rigs in water that scatters.
#pragma once

#include "support/flat.h"
#include "support/scene_rig.h"

#include <Eigen/Geometry>

#include <numbers>
#include <string>
#include <utility>

namespace aphotic {

// Straight from 400 to 700 nm, level on either side.
inline Spectrum line(const std::string& name, double at_400_nm, double at_700_nm) {
    return {name, {300.0, 400.0, 700.0, 900.0}, {at_400_nm, at_400_nm, at_700_nm, at_700_nm}};
}

inline PhaseFunction henyey_greenstein(double g) {
    return {.name = "hg", .kind = HenyeyGreenstein{.g = g}};
}

// Evenly into a cone, by default its half of all directions: I = 1.
inline Beam even_beam(double half_angle_rad = 0.5 * std::numbers::pi) {
    return {
        .name = "even",
        .weights = ConeWeights::Literal,
        .cones = {
            {.part = "even", .half_angle_rad = half_angle_rad, .weight = 1.0, .exponent = 0.0}}};
}

// One lamp beside a camera that looks down.
inline Rig one_lamp(const Eigen::Vector3d& position_m,
                    const Eigen::Vector3d& axis,
                    Beam beam,
                    PhaseFunction phase) {
    Rig rig = habcam();
    rig.strobes.erase(rig.strobes.begin() + 1, rig.strobes.end());
    rig.strobes[0].position_m = position_m;
    rig.strobes[0].axis = axis.normalized();
    rig.strobes[0].beam = std::move(beam);
    rig.strobes[0].spectrum = flat(1.0);
    rig.strobes[0].power = 1.0;
    rig.water.absorption_per_m = flat(0.2);
    rig.water.scatterers = {{flat(0.3), std::move(phase)}};
    return rig;
}

// HabCam in coastal water with its particles.
inline Rig coast(int width_px, int height_px) {
    Rig rig = habcam(width_px, height_px);
    rig.water.absorption_per_m = line("absorption", 0.3, 0.65);
    rig.water.scatterers = {{line("particles", 0.28, 0.18), fournier_forand(0.0183)}};
    return rig;
}

// In clearer water, with such particles.
inline Rig with_particles(Rig rig, const PhaseFunction& phase) {
    rig.water.absorption_per_m = line("absorption", 0.15, 0.5);
    rig.water.scatterers = {{line("particles", 0.3, 0.2), phase}};
    return rig;
}

// The sea's own scattering.
inline Scatterer sea() {
    return {line("sea", 0.006, 0.0006), {.name = "molecular", .kind = MolecularScattering{}}};
}

}  // namespace aphotic
