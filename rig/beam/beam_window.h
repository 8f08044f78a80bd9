// SPDX-License-Identifier: BSD-3-Clause
//
// The effect of a flat window on a beam that was measured, or computed, in air:
//
//   I_w(theta_w) = T(theta) n^2 (cos theta_w / cos theta) I(theta),   sin theta = n sin theta_w
//
//   theta    angle off the axis in air, theta_w in water; the azimuth does not change
//   n        index of the water
//   T        the window's transmittance: both faces by Fresnel, separately for each polarisation,
//            with multiple reflections between them, for unpolarised light
//   n^2 ..   the change of solid angle: d(omega) / d(omega_w)
//
// Light 50 degrees off the axis in air is 35 off it in water, and the axis is n^2 = 1.8 times as
// bright apart from T. A cos^n of 100 degrees at half maximum becomes 80 wide, not 70, since the
// factor grows outwards. The flux is conserved, less the faces' reflections. There is no light
// beyond asin(1/n), about 48 degrees.
//
// Limits: the window is perpendicular to the axis, wide, and so close to the lamp that light can be
// taken to start at the lamp. The indices are those at kWindowIndex_nm, so that a beam has one
// shape at all wavelengths: from 400 to 700 nm, n^2 differs from that by 1 % at most.
#pragma once

#include <Eigen/Core>

#include <optional>

namespace aphotic {

inline constexpr double kWindowIndex_nm = 550.0;

struct BeamWindow {
    double glass_index = 1.5;
    double water_index = 1.34;

    [[nodiscard]] bool operator==(const BeamWindow&) const = default;
};

// The direction in air of light that travels in a given direction in water.
struct LightInAir {
    Eigen::Vector3d direction;  // of length 1
    double factor = 0.0;        // I_w / I
};

// For a direction in water, in the lamp's frame (z the axis), of any length. Empty beyond
// asin(1/n).
[[nodiscard]] std::optional<LightInAir> in_air(const BeamWindow& window,
                                               const Eigen::Vector3d& in_water);

// The factor at a cosine in air, 0 to 1; it increases from the axis outwards.
[[nodiscard]] double window_factor(const BeamWindow& window, double cos_in_air);
// T / cos(theta), which stays finite where both go to 0.
[[nodiscard]] double transmittance_by_cosine(const BeamWindow& window, double cos_in_air);

// asin(1/n).
[[nodiscard]] double widest_in_water_rad(const BeamWindow& window);
// theta for a theta_w up to that.
[[nodiscard]] double angle_in_air_rad(const BeamWindow& window, double in_water_rad);
[[nodiscard]] double angle_in_water_rad(const BeamWindow& window, double in_air_rad);

}  // namespace aphotic
