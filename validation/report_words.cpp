// SPDX-License-Identifier: BSD-3-Clause
#include "validation/report_words.h"

#include "report/html.h"
#include "spectral/refractive_index.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>
#include <vector>

namespace aphotic {
namespace {

constexpr double kMetresPerMillimetre = 1e-3;
constexpr double kMetresPerMicrometre = 1e-6;
// Angles and lengths below this are what is left of rounding.
constexpr double kNothing = 1e-9;

double degrees(double rad) {
    return rad * 180.0 / std::numbers::pi;
}

std::string deg(double rad) {
    return plain(degrees(rad)) + "°";
}

std::string item(std::string_view term, std::string_view sentences) {
    return fmt::format("<dt>{}</dt><dd>{}</dd>\n", term, sentences);
}

// "a", "a and b", "a, b and c"
std::string listed(const std::vector<std::string>& words) {
    if (words.size() < 2) return words.empty() ? "" : words.front();
    return fmt::format("{} and {}", fmt::join(words.begin(), words.end() - 1, ", "), words.back());
}

std::string turned(double angle_rad, std::string_view positive, std::string_view negative) {
    return fmt::format("{} by {}", angle_rad > 0.0 ? positive : negative, deg(std::abs(angle_rad)));
}

std::string sled_in_words(const Sled& sled) {
    const std::string pitch = std::abs(sled.pitch_rad) < kNothing
                                  ? "level fore and aft"
                                  : turned(sled.pitch_rad, "bow up", "bow down");
    const std::string roll = std::abs(sled.roll_rad) < kNothing
                                 ? "level athwartships"
                                 : turned(sled.roll_rad, "starboard down", "starboard up");
    return fmt::format(
        "The camera is {} m above the floor; {}, {}.", plain(sled.altitude_m), pitch, roll);
}

// Half the field of view of so many pixels, before any port.
double half_field_rad(const Camera& camera, int pixels) {
    return std::atan(pixels * camera.pixel_pitch_m / (2.0 * camera.focal_length_m));
}

double middle_nm(const Camera& camera) {
    return (camera.range.first_nm + camera.range.last_nm) / 2.0;
}

double half_field_in_water_rad(const Rig& rig, int pixels) {
    const double air = half_field_rad(rig.camera, pixels);
    if (!rig.camera.port) return air;
    const double index =
        seawater_index(middle_nm(rig.camera), rig.water.salinity_psu, rig.water.temperature_c);
    return std::asin(std::sin(air) / index);
}

// Without what a table says of its columns, such as "(red)"; each name once.
std::string names_of(const std::vector<const Spectrum*>& curves) {
    std::vector<std::string> names;
    for (const Spectrum* curve : curves) {
        const bool names_a_column = curve->name().ends_with(')');
        const std::string name = user_text(curve->name().substr(
            0, names_a_column ? curve->name().rfind(" (") : std::string::npos));
        if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    }
    return listed(names);
}

std::string camera_in_words(const Rig& rig) {
    const Camera& camera = rig.camera;
    std::string words =
        fmt::format("{} × {} pixels of {} µm behind a lens of {} mm: a field of {:.1f}° × {:.1f}°",
                    camera.width_px,
                    camera.height_px,
                    plain(camera.pixel_pitch_m / kMetresPerMicrometre),
                    plain(camera.focal_length_m / kMetresPerMillimetre),
                    2.0 * degrees(half_field_rad(camera, camera.width_px)),
                    2.0 * degrees(half_field_rad(camera, camera.height_px)));
    const double across = half_field_in_water_rad(rig, camera.width_px);
    const double along = half_field_in_water_rad(rig, camera.height_px);
    if (camera.port) {
        words += fmt::format(" in air, {:.1f}° × {:.1f}° in the water (at {} nm)",
                             2.0 * degrees(across),
                             2.0 * degrees(along),
                             plain(middle_nm(camera)));
    }
    words += fmt::format(", or some {:.2g} m × {:.2g} m of a level floor. ",
                         2.0 * rig.sled.altitude_m * std::tan(across),
                         2.0 * rig.sled.altitude_m * std::tan(along));
    return words + fmt::format("It sees from {} to {} nm with the {}.",
                               plain(camera.range.first_nm),
                               plain(camera.range.last_nm),
                               names_of(camera.sensor.curves()));
}

std::string port_in_words(const std::optional<FlatPort>& port) {
    if (!port) return "None: the entrance pupil is in the water.";
    return fmt::format("Flat, {} mm of {}, its inner face {} mm before the entrance pupil.",
                       plain(port->thickness_m / kMetresPerMillimetre),
                       user_text(port->glass.name()),
                       plain(port->distance_m / kMetresPerMillimetre));
}

std::string water_in_words(const Rig& rig) {
    const Water& water = rig.water;
    if (water.is_clear()) return "Takes no light away: the scene is as clear as air.";
    std::vector<std::string> losses;
    if (water.multiple != 0.0) {
        losses.push_back((water.multiple == 1.0 ? "the " : plain(water.multiple) + " times the ") +
                         user_text(water.absorption_per_m.name()));
    }
    if (water.uniform_loss_per_m != 0.0)
        losses.push_back(plain(water.uniform_loss_per_m) + " per metre at every wavelength");
    std::string words = fmt::format("Takes light away by {}.", listed(losses));
    if (rig.camera.port) {
        words += fmt::format(" It refracts as seawater of {} psu at {} °C.",
                             plain(water.salinity_psu),
                             plain(water.temperature_c));
    }
    return words;
}

// Of a floor or an object.
template <typename Surface>
std::string material_in_words(const Surface& surface) {
    const std::string highlight = surface.phong == 0.0
                                      ? "no highlight"
                                      : fmt::format("a Phong highlight of {} and size {}",
                                                    plain(surface.phong),
                                                    plain(surface.phong_size));
    return fmt::format("the {} and {}", user_text(surface.reflectance.name()), highlight);
}

std::string floor_in_words(const Seafloor& floor) {
    return fmt::format("A diffuse plane with {}.", material_in_words(floor));
}

// "1 m × 2 m × 0.5 m, its middle 2 m down from the entrance pupil"
std::string extent_in_words(const Box& box) {
    const Eigen::Vector3d size_m = box.most_m - box.least_m;
    return fmt::format("{} m fore and aft, {} m athwartships and {} m high, its middle {}",
                       plain(size_m.x()),
                       plain(size_m.y()),
                       plain(size_m.z()),
                       place_in_words(0.5 * (box.least_m + box.most_m)));
}

std::string shape_in_words(const Sphere& sphere) {
    return fmt::format("A sphere of {} m radius, its middle {}",
                       plain(sphere.radius_m),
                       place_in_words(sphere.centre_m));
}

std::string shape_in_words(const Box& box) {
    return "A box " + extent_in_words(box);
}

std::string shape_in_words(const Mesh& mesh) {
    Box bounds{.least_m = mesh.vertices_m.front(), .most_m = mesh.vertices_m.front()};
    for (const Eigen::Vector3d& vertex_m : mesh.vertices_m) {
        bounds.least_m = bounds.least_m.cwiseMin(vertex_m);
        bounds.most_m = bounds.most_m.cwiseMax(vertex_m);
    }
    return fmt::format(
        "A mesh of {}, {}", counted(mesh.triangles.size(), "triangle"), extent_in_words(bounds));
}

std::string object_in_words(const Object& object) {
    const std::string shape =
        std::visit([](const auto& form) { return shape_in_words(form); }, object.shape);
    return fmt::format("{}, with {}.", shape, material_in_words(object));
}

std::string scene_in_words(const std::string& scene_file) {
    return fmt::format(
        "POV-Ray rendered <code>{}</code>, a scene of the user’s own, in place of the floor and "
        "the "
        "objects. The reference does not read it: it traced the floor and the objects told here.",
        escaped(scene_file));
}

std::string strobe_in_words(const Strobe& strobe) {
    const std::string source =
        strobe.emitter ? fmt::format("A lit rectangle of {} mm across and {} mm along",
                                     plain(strobe.emitter->across_m / kMetresPerMillimetre),
                                     plain(strobe.emitter->along_m / kMetresPerMillimetre))
                       : "A point";
    return fmt::format("{}, {}, aimed {}. It has the {} at power {} and the beam {}.",
                       source,
                       place_in_words(strobe.position_m),
                       aim_in_words(strobe.axis),
                       user_text(strobe.spectrum.name()),
                       plain(strobe.power),
                       user_text(strobe.beam.name));
}

std::string beam_in_words(const Beam& beam) {
    std::vector<std::string> cones;
    for (const Cone& cone : beam.cones) {
        cones.push_back(fmt::format(
            "{} within {} (weight {}{})",
            user_text(cone.part),
            deg(cone.half_angle_rad),
            plain(cone.weight),
            cone.exponent == 1.0 ? "" : fmt::format(", exponent {}", plain(cone.exponent))));
    }
    return fmt::format("{}: {}; {} is {}.",
                       cones.size() == 1 ? "Cone" : "Cones",
                       listed(cones),
                       cones.size() == 1 ? "the weight" : "each weight",
                       beam.weights == ConeWeights::Flux
                           ? "a share of the lamp’s flux"
                           : "an intensity on the axis, as the source paper prints it");
}

std::vector<Beam> beams_of(const Rig& rig) {
    std::vector<Beam> beams;
    for (const Strobe& strobe : rig.strobes) {
        if (std::ranges::find(beams, strobe.beam) == beams.end()) beams.push_back(strobe.beam);
    }
    return beams;
}

}  // namespace

std::string place_in_words(const Eigen::Vector3d& position_m) {
    struct Direction {
        double length_m;
        const char* positive;
        const char* negative;
    };
    std::vector<std::string> words;
    for (const auto& [length_m, positive, negative] :
         {Direction{position_m.x(), "forward", "aft"},
          Direction{position_m.y(), "to starboard", "to port"},
          Direction{position_m.z(), "down", "up"}}) {
        if (std::abs(length_m) < kNothing) continue;
        words.push_back(fmt::format(
            "{} m {}", plain(std::abs(length_m)), length_m > 0.0 ? positive : negative));
    }
    return words.empty() ? "at the entrance pupil" : listed(words) + " from the entrance pupil";
}

std::string aim_in_words(const Eigen::Vector3d& axis) {
    const double across = std::hypot(axis.x(), axis.y());
    if (across < kNothing) return axis.z() > 0.0 ? "along the camera’s axis" : "straight up";
    // Off the bow or the stern, whichever is nearer, to one side.
    const double to_side = std::atan2(std::abs(axis.y()), std::abs(axis.x()));
    const char* end = axis.x() > 0.0 ? "forward" : "aft";
    const char* side = axis.y() > 0.0 ? "starboard" : "port";
    std::string towards = fmt::format("{} to {} of {}", deg(to_side), side, end);
    if (to_side < kNothing) towards = end;
    if (to_side > std::numbers::pi / 2.0 - kNothing) towards = side;
    return fmt::format(
        "{} off the camera’s axis, towards {}", deg(std::atan2(across, axis.z())), towards);
}

std::string rig_in_words(const Rig& rig, const std::string& scene_file) {
    std::string list = "<dl class=\"rig\">\n";
    list += item("Sled", sled_in_words(rig.sled));
    list += item("Camera", camera_in_words(rig));
    list += item("Port", port_in_words(rig.camera.port));
    list += item("Water", water_in_words(rig));
    list += item("Floor", floor_in_words(rig.seafloor));
    for (const Object& object : rig.objects)
        list += item("Object " + user_text(object.name), object_in_words(object));
    if (!scene_file.empty()) list += item("Scene", scene_in_words(scene_file));
    for (const Strobe& strobe : rig.strobes)
        list += item("Strobe " + user_text(strobe.name), strobe_in_words(strobe));
    for (const Beam& beam : beams_of(rig))
        list += item("Beam " + user_text(beam.name), beam_in_words(beam));
    return list + "</dl>\n";
}

}  // namespace aphotic
