// SPDX-License-Identifier: BSD-3-Clause
//
// The camera of a rig file, in SI, every value checked: plain data. Metres and radians; wavelengths
// stay in nanometres.
#pragma once

#include "rig/camera/lens_model.h"
#include "rig/camera/port.h"
#include "rig/camera/vignetting.h"
#include "spectral/sensor.h"

#include <Eigen/Core>

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace aphotic {

// The camera's settings for the survey's files; empty if unknown.
struct Readout {
    std::string bayer{};  // "RGGB", "BGGR", "GRBG", "GBRG" or "mono"
    std::optional<double> black_level_dn{};
    std::optional<double> white_level_dn{};
    std::optional<double> exposure_ms{};
    std::optional<double> iso{};
    std::optional<double> f_number{};
    // As in EMVA 1288, for simulated surveys and for the noise of real ones.
    std::optional<double> gain_dn_per_e{};
    std::optional<double> read_noise_e{};
    std::optional<double> saturation_e{};
};

// The direction in which navigation measures an altitude: along the axis tilted by pitch and roll,
// vertically, or to the nearest point of the floor.
enum class AltitudeIs { Axis, Plumb, Nearest };
inline constexpr std::array<std::string_view, 3> kAltitudeWords{"axis", "plumb", "nearest"};

// The transformation from the navigation's pose to the camera's (rig/vehicle_pose.h).
// The vehicle's frame: x forward, y starboard, z down. Everything else in a rig is relative to the
// camera.
struct Mounting {
    AltitudeIs altitude_is = AltitudeIs::Axis;
    double altitude_offset_m = 0.0;                                // added to altitudes
    Eigen::Vector3d position_m = Eigen::Vector3d::Zero();          // of the pupil
    Eigen::Vector3d roll_pitch_yaw_rad = Eigen::Vector3d::Zero();  // of the camera
};

struct Camera {
    int width_px = 0;
    int height_px = 0;
    double pixel_pitch_m = 0.0;
    double focal_length_m = 0.0;
    WavelengthRange range;
    Sensor sensor;
    Port port;
    // Empty for a pinhole. Otherwise the pitch is that of the columns, and the focal length its fx.
    std::optional<LensModel> lens{};
    std::optional<Vignetting> vignetting{};
    Readout readout{};
};

}  // namespace aphotic
