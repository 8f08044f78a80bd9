// SPDX-License-Identifier: BSD-3-Clause
#include "rig/geometry_signature.h"

#include "base/sha256.h"
#include "rig/geometry.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <vector>

namespace aphotic {

namespace {

using Signature = std::map<std::string, std::string>;

// Fields that frames do not depend on are named in the bindings too, and not used.

std::string signature_of(const Eigen::Vector3d& v) {
    return fmt::format("{} {} {}", v.x(), v.y(), v.z());
}

std::string signature_of(const Beam& beam) {
    const auto& [name, weights, cones] = beam;
    std::vector<std::string> lobes;
    for (const Cone& cone : cones) {
        const auto& [part, half_angle_rad, weight] = cone;  // the weight: in the axial intensity
        lobes.push_back(
            fmt::format("{} rad {} 1/sr", half_angle_rad, axial_intensity(cone, weights)));
    }
    return fmt::format("cones {}", fmt::join(lobes, ", "));
}

std::string signature_of(const Emitter& emitter) {
    const auto& [across_m, along_m] = emitter;
    return fmt::format("{} x {} m", across_m, along_m);
}

std::string signature_of(const Sphere& sphere) {
    const auto& [centre_m, radius_m] = sphere;
    return fmt::format("sphere at {} m of radius {} m", signature_of(centre_m), radius_m);
}

std::string signature_of(const Box& box) {
    const auto& [least_m, most_m] = box;
    return fmt::format("box from {} m to {} m", signature_of(least_m), signature_of(most_m));
}

// A mesh may be long: what it holds is told by its digest.
std::string signature_of(const Mesh& mesh) {
    const auto& [vertices_m, triangles] = mesh;
    std::string text;
    for (const Eigen::Vector3d& vertex_m : vertices_m) text += signature_of(vertex_m) + "\n";
    for (const auto& [a, b, c] : triangles) text += fmt::format("{} {} {}\n", a, b, c);
    return fmt::format("mesh of {} triangles, SHA-256 {}", triangles.size(), sha256_of_text(text));
}

std::string signature_of(const FlatPort& port) {
    const auto& [distance_m, thickness_m, glass] = port;
    return fmt::format("{} m off, {} m of {}", distance_m, thickness_m, glass.name());
}

void sign(const Sled& sled, Signature& all) {
    const auto& [altitude_m, pitch_rad, roll_rad] = sled;
    all["sled.altitude_m"] = fmt::format("{}", altitude_m);
    all["sled.pitch_rad"] = fmt::format("{}", pitch_rad);
    all["sled.roll_rad"] = fmt::format("{}", roll_rad);
}

void sign(const Camera& camera, Signature& all) {
    const auto& [width_px, height_px, pixel_pitch_m, focal_length_m, range, sensor, port] = camera;
    all["camera.resolution"] = fmt::format("{} {}", width_px, height_px);
    all["camera.pixel_pitch_m"] = fmt::format("{}", pixel_pitch_m);
    all["camera.focal_length_m"] = fmt::format("{}", focal_length_m);
    if (port) all["camera.port"] = signature_of(*port);
}

void sign_indices(const Water& water, Signature& all) {
    const auto& [absorption, multiple, uniform_loss, salinity_psu, temperature_c] = water;
    all["water.salinity_psu"] = fmt::format("{}", salinity_psu);
    all["water.temperature_c"] = fmt::format("{}", temperature_c);
}

void sign(const Seafloor& floor, Signature& all) {
    const auto& [reflectance, phong, phong_size] = floor;
    all["seafloor.phong"] = fmt::format("{}", phong);
    if (phong > 0.0) all["seafloor.phong_size"] = fmt::format("{}", phong_size);
}

void sign(const Strobe& strobe, Signature& all) {
    const auto& [name, position_m, axis, beam, spectrum, power, emitter] = strobe;
    const std::string key = fmt::format("strobe '{}'", name);
    all[key] = fmt::format(
        "at {} m, axis {}, {}", signature_of(position_m), signature_of(axis), signature_of(beam));
    if (emitter) all[key + " emitter"] = signature_of(*emitter);
}

// Of the strobes or objects, whose sources and materials frames know by their order.
template <typename Named>
std::string order_of(const std::vector<Named>& things) {
    std::vector<std::string> names;
    for (const Named& thing : things) names.push_back(thing.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

void sign(const Object& object, Signature& all) {
    const auto& [name, shape, reflectance, phong, phong_size] = object;
    std::string& text = all[fmt::format("object '{}'", name)];
    text = std::visit([](const auto& solid) { return signature_of(solid); }, shape);
    if (phong > 0.0) text += fmt::format(", phong {}, phong_size {}", phong, phong_size);
}

}  // namespace

std::map<std::string, std::string> geometry_signature(const Rig& rig) {
    // The scene: a manifest notes it by itself.
    const auto& [title, sled, camera, water, seafloor, strobes, materials, objects, scene, digest] =
        rig;
    Signature all;
    sign(sled, all);
    sign(camera, all);
    if (camera.port) sign_indices(water, all);
    sign(seafloor, all);
    for (const Strobe& strobe : strobes) sign(strobe, all);
    for (const Object& object : objects) sign(object, all);
    all["strobes"] = order_of(strobes);
    if (!objects.empty()) all["objects"] = order_of(objects);
    return all;
}

}  // namespace aphotic
