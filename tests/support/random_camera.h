// SPDX-License-Identifier: BSD-3-Clause
//
// Lenses and ports that nobody chose, within what rigs allow: calibrations whose formula holds all
// over the image, ports of any kind around the pupil.
#pragma once

#include "base/error.h"
#include "rig/rig.h"
#include "support/dice.h"

#include <Eigen/Core>

#include <array>
#include <numbers>
#include <string_view>

namespace aphotic {

enum class LensKind { RadialTangential, Rational, Fisheye };
inline constexpr std::array kLensKinds{
    LensKind::RadialTangential, LensKind::Rational, LensKind::Fisheye};

inline LensModel random_lens_of(LensKind kind, Dice& dice, const Camera& camera) {
    const double focal_px = camera.focal_length_m / camera.pixel_pitch_m;
    while (true) {
        LensModel lens{
            .focal_px = {focal_px * dice.between(0.9, 1.1), focal_px * dice.between(0.9, 1.1)},
            .centre_px = {camera.width_px * dice.between(0.45, 0.55),
                          camera.height_px * dice.between(0.45, 0.55)}};
        lens.skew_px = dice.chance(0.3) ? focal_px * dice.between(-0.01, 0.01) : 0.0;
        lens.is_fisheye = kind == LensKind::Fisheye;
        lens.radial = {dice.between(-0.3, 0.3),
                       dice.between(-0.1, 0.1),
                       dice.between(-0.05, 0.05),
                       dice.chance(0.5) ? dice.between(-0.01, 0.01) : 0.0};
        if (kind == LensKind::Rational) {
            lens.radial_below = {
                dice.between(-0.2, 0.4), dice.between(-0.05, 0.1), dice.between(-0.01, 0.01)};
        }
        if (kind != LensKind::Fisheye)
            lens.tangential = {dice.between(-0.01, 0.01), dice.between(-0.01, 0.01)};
        try {
            require_to_hold(lens, camera.width_px, camera.height_px);
            return lens;
        } catch (const InputError&) {
        }
    }
}

// The pitch and focal length stand for the columns', as the reader of rigs leaves them.
inline void give_lens(LensKind kind, Dice& dice, Camera& camera) {
    camera.lens = random_lens_of(kind, dice, camera);
    camera.focal_length_m = camera.lens->focal_px.x() * camera.pixel_pitch_m;
}

// One that leaves light all over any image within 80 degrees of the axis.
inline void give_vignetting(std::size_t kind, Dice& dice, Camera& camera) {
    if (kind % 3 == 0) {
        camera.vignetting = NaturalVignetting{};
    } else if (kind % 3 == 1) {
        camera.vignetting = RadialVignetting{
            {dice.between(-0.5, 0.0), dice.between(-0.2, 0.2), dice.between(-0.1, 0.1)}};
    } else {
        TabulatedVignetting table;
        for (double angle_deg = 0.0; angle_deg <= 80.0; angle_deg += 5.0) {
            table.angles_rad.push_back(angle_deg * std::numbers::pi / 180.0);
            table.factors.push_back(dice.between(0.2, 1.0));
        }
        camera.vignetting = table;
    }
}

enum class PortKind { Flat, Tilted, Dome };
inline constexpr std::array kPortKinds{PortKind::Flat, PortKind::Tilted, PortKind::Dome};

inline void give_port(PortKind kind, Dice& dice, Camera& camera) {
    constexpr std::array<std::string_view, 3> kGlasses{"bk7", "sapphire", "pmma"};
    PortWindow port{.distance_m = dice.between(0.01, 0.05),
                    .thickness_m = dice.between(0.003, 0.02),
                    .glass = builtin_glass(dice.one_of(kGlasses))};
    if (kind == PortKind::Tilted) {
        const double tilt_rad = dice.between(1.0, 15.0) * std::numbers::pi / 180.0;
        const double round_rad = dice.between(0.0, 2.0 * std::numbers::pi);
        port.normal = {std::sin(tilt_rad) * std::cos(round_rad),
                       std::sin(tilt_rad) * std::sin(round_rad),
                       std::cos(tilt_rad)};
    }
    if (kind == PortKind::Dome) {
        port.distance_m = 0.0;
        port.dome = Dome{.radius_m = dice.between(0.03, 0.1)};
        port.dome->centre_m =
            0.3 * port.dome->radius_m *
            Eigen::Vector3d(
                dice.between(-0.5, 0.5), dice.between(-0.5, 0.5), dice.between(-0.5, 0.5));
    }
    camera.port = port;
    camera.range.first_nm = std::max(camera.range.first_nm, port.glass.range().first_nm);
}

}  // namespace aphotic
