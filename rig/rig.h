// SPDX-License-Identifier: BSD-3-Clause
//
// The rig: the contents of a rig file, in SI, every value checked. Plain data, no behaviour.
//
// Sled frame, the marine one: x forward, y starboard, z down; the origin is the camera's
// entrance pupil, and the camera looks along +z with its top row forward and its right column
// starboard. Metres and radians; wavelengths stay in nanometres.
//
// Both renderers start from this struct and share no other geometry or light.
#pragma once

#include "rig/beam/beam.h"
#include "rig/camera/camera.h"
#include "spectral/spectrum.h"
#include "spectral/water.h"

#include <Eigen/Core>

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace aphotic {

// Attitude and height. The floor is the plane through (0, 0, altitude_m), level in the world,
// so in the sled frame it is tilted by pitch (positive bow up) and roll (positive starboard
// down).
// Wherever a pose comes from. Wide enough for any sled, narrow enough to catch a wrong unit.
inline constexpr double kLeastAltitude_m = 0.001;
inline constexpr double kMostAltitude_m = 10000.0;
inline constexpr double kMostTilt_deg = 89.9;

struct Sled {
    double altitude_m = 0.0;
    double pitch_rad = 0.0;
    double roll_rad = 0.0;
};

struct Seafloor {
    Spectrum reflectance;
    double phong = 0.0;  // POV-Ray's own Phong highlight; see docs/background/physics.md
    double phong_size = 40.0;
};

// A lit rectangle centred on the strobe's position, perpendicular to its axis.
struct Emitter {
    double across_m = 0.0;
    double along_m = 0.0;
};

struct Strobe {
    std::string name;
    Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  // unit vector along which it shines
    Beam beam;
    Spectrum spectrum;  // Phi(lambda) at power 1
    double power = 1.0;
    std::optional<Emitter> emitter;  // empty: a point
    bool is_absolute = false;        // known flux: power times spectrum is W/nm, or J/nm
};

struct Sphere {
    Eigen::Vector3d centre_m = Eigen::Vector3d::Zero();
    double radius_m = 0.0;
};

// Its faces are perpendicular to the sled's axes.
struct Box {
    Eigen::Vector3d least_m = Eigen::Vector3d::Zero();
    Eigen::Vector3d most_m = Eigen::Vector3d::Zero();
};

// Flat triangles, each lit on the side that faces the camera, whatever the order of its corners.
struct Mesh {
    std::vector<Eigen::Vector3d> vertices_m;
    std::vector<std::array<int, 3>> triangles;  // of vertices
};

using Shape = std::variant<Sphere, Box, Mesh>;

// A solid object: opaque, it reflects like the floor and casts shadows.
struct Object {
    std::string name;
    Shape shape;
    Spectrum reflectance;
    double phong = 0.0;
    double phong_size = 40.0;
};

// A user's table or mesh that the rig file names.
struct RigFile {
    std::string name;  // as in the rig file
    std::string sha256;
};

struct Rig {
    std::string title;
    Sled sled;
    Mounting mounting{};
    Camera camera;
    Water water;
    Seafloor seafloor;
    std::vector<Strobe> strobes;
    std::vector<Spectrum> materials{};  // further reflectances in the plan
    std::vector<Object> objects{};
    std::filesystem::path scene{};  // a user's POV-Ray scene; empty: floor and objects
    std::string digest;  // SHA-256 of the rig file and of the user's tables that it names
    std::string toml{};  // the rig file's text
    std::vector<RigFile> files{};
};

}  // namespace aphotic
