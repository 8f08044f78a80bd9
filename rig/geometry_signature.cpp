// SPDX-License-Identifier: BSD-3-Clause
#include "rig/geometry_signature.h"

#include "base/sha256.h"
#include "rig/camera/lens.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

// Each function names every field of its struct: with a new field it does not compile until someone
// has considered it here.

namespace aphotic {

namespace {

using Signature = std::map<std::string, std::string>;

std::string vector_text(const Eigen::Vector3d& v) {
    return fmt::format("{} {} {}", v.x(), v.y(), v.z());
}

// A mesh may be long, so its contents are given by its digest.
std::string mesh_text(const Mesh& mesh) {
    const auto& [vertices_m, triangles] = mesh;
    std::string text;
    for (const Eigen::Vector3d& vertex_m : vertices_m) text += vector_text(vertex_m) + "\n";
    for (const auto& [a, b, c] : triangles) text += fmt::format("{} {} {}\n", a, b, c);
    return fmt::format("mesh of {} triangles, SHA-256 {}", triangles.size(), sha256_of_text(text));
}

std::string shape_text(const Shape& shape) {
    if (const auto* sphere = std::get_if<Sphere>(&shape)) {
        const auto& [centre_m, radius_m] = *sphere;
        return fmt::format("sphere at {} m of radius {} m", vector_text(centre_m), radius_m);
    }
    if (const auto* box = std::get_if<Box>(&shape)) {
        const auto& [least_m, most_m] = *box;
        return fmt::format("box from {} m to {} m", vector_text(least_m), vector_text(most_m));
    }
    return mesh_text(std::get<Mesh>(shape));
}

void add_sled(const Sled& sled, Signature& all) {
    const auto& [altitude_m, pitch_rad, roll_rad] = sled;
    all["sled.altitude_m"] = fmt::format("{}", altitude_m);
    all["sled.pitch_rad"] = fmt::format("{}", pitch_rad);
    all["sled.roll_rad"] = fmt::format("{}", roll_rad);
}

void add_camera(const Camera& camera, const Water& water, Signature& all) {
    const auto& [width,
                 height,
                 pitch,
                 focal_length,
                 range,
                 sensor,
                 port,
                 lens,
                 vignetting,
                 readout] = camera;
    all.merge(lens_signature(camera));
    if (vignetting) all["camera.vignetting"] = vignetting_signature(*vignetting);
    if (!port) return;
    all["camera.port"] = port_signature(*port);
    all.merge(water.index_signature());
}

void add_seafloor(const Seafloor& seafloor, Signature& all) {
    const auto& [reflectance, phong, phong_size] = seafloor;
    all["seafloor.phong"] = fmt::format("{}", phong);
    if (phong > 0.0) all["seafloor.phong_size"] = fmt::format("{}", phong_size);
}

void add_strobe(const Strobe& strobe, Signature& all) {
    const auto& [name, position_m, axis, beam, spectrum, power, emitter, is_absolute] = strobe;
    const std::string key = fmt::format("strobe '{}'", name);
    all[key] = fmt::format(
        "at {} m, axis {}, {}", vector_text(position_m), vector_text(axis), beam_signature(beam));
    if (!emitter) return;
    const auto& [across_m, along_m] = *emitter;
    all[key + " emitter"] = fmt::format("{} x {} m", across_m, along_m);
}

// For strobes or objects, since frames refer to their sources and materials by order.
template <typename Named>
std::string order_of(const std::vector<Named>& things) {
    std::vector<std::string> names;
    for (const Named& thing : things) names.push_back(thing.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

void add_object(const Object& object, Signature& all) {
    const auto& [name, shape, reflectance, phong, phong_size] = object;
    std::string text = shape_text(shape);
    if (phong > 0.0) text += fmt::format(", phong {}, phong_size {}", phong, phong_size);
    all[fmt::format("object '{}'", name)] = text;
}

}  // namespace

Signature geometry_signature(const Rig& rig) {
    // A user's scene is identified by its files (spectral/manifest.h). The mounting belongs to the
    // navigation: frames show the camera's own pose.
    const auto& [title,
                 sled,
                 mounting,
                 camera,
                 water,
                 floor,
                 strobes,
                 materials,
                 objects,
                 scene,
                 digest,
                 toml,
                 files] = rig;
    Signature all;
    add_sled(sled, all);
    add_camera(camera, water, all);
    add_seafloor(floor, all);
    for (const Strobe& strobe : strobes) add_strobe(strobe, all);
    for (const Object& object : objects) add_object(object, all);
    all["strobes"] = order_of(strobes);
    if (!objects.empty()) all["objects"] = order_of(objects);
    return all;
}

}  // namespace aphotic
