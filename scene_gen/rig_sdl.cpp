// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/rig_sdl.h"

#include "base/degrees.h"
#include "rig/camera/lens.h"
#include "scene_gen/beam_sdl.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <variant>

namespace aphotic {

using Eigen::Vector3d;

namespace {

std::string port_sdl(const PortWindow& port) {
    const std::string thickness = sdl_number(port.thickness_m);
    const std::string glass = sdl_text(port.glass.name());
    if (port.dome) {
        return fmt::format(
            "Aphotic_Dome_Port ({} / Aphotic_Unit, {} / Aphotic_Unit, {} / Aphotic_Unit, {})",
            sdl_point(port.dome->centre_m),
            sdl_number(port.dome->radius_m),
            thickness,
            glass);
    }
    const std::string flat = fmt::format(
        "({} / Aphotic_Unit, {} / Aphotic_Unit, {}", sdl_number(port.distance_m), thickness, glass);
    return is_across_axis(port)
               ? fmt::format("Aphotic_Port {})", flat)
               : fmt::format("Aphotic_Tilted_Port {}, {})", flat, sdl_point(port.normal));
}

std::string camera_sdl(const Camera& camera) {
    std::string sdl;
    Pinhole pinhole{.focal_length_m = camera.focal_length_m,
                    .sensor_width_m = camera.pixel_pitch_m * camera.width_px};
    if (camera.lens) {
        pinhole = pinhole_about(camera);
        sdl += fmt::format("// Lens: {}\n", lens_model_signature(*camera.lens));
    }
    sdl += fmt::format("#macro Aphotic_Rig_Camera ()\n   Aphotic_Camera ({}, {})\n",
                       sdl_number(pinhole.focal_length_m),
                       sdl_number(pinhole.sensor_width_m));
    if (camera.port) sdl += "   " + port_sdl(*camera.port) + "\n";
    return sdl + "#end\n";
}

std::string emitter_sdl(const Strobe& strobe, LampGrid lamps) {
    if (!strobe.emitter) return "0";
    return fmt::format("<{} / Aphotic_Unit, {} / Aphotic_Unit, {}, {}>",
                       sdl_number(strobe.emitter->across_m),
                       sdl_number(strobe.emitter->along_m),
                       lamps.across,
                       lamps.along);
}

// The beams that the scene calls: those with a shell, one for all their strobes, and all of them in
// a user's scene.
std::vector<Beam> called_beams(const std::vector<StrobeInScene>& strobes, SceneAuthor author) {
    std::vector<Beam> beams;
    for (const StrobeInScene& strobe : strobes) {
        if (light_count(strobe.beam) == 0) continue;
        if (author == SceneAuthor::Ours && !needs_shell(strobe.beam)) continue;
        if (std::ranges::find(beams, strobe.beam) == beams.end()) beams.push_back(strobe.beam);
    }
    return beams;
}

// The name by the place in that order.
std::string pattern_name(std::size_t index) {
    return fmt::format("Aphotic_Rig_Pattern_{}", index + 1);
}

std::string beams_sdl(const std::vector<Beam>& beams) {
    if (beams.empty()) return "";
    std::string functions;
    std::vector<std::string> names;
    std::string cases;
    for (std::size_t i = 0; i < beams.size(); ++i) {
        const std::string name = pattern_name(i);
        names.push_back(sdl_text(scene_name(beams[i].name)));
        const bool has_shell = needs_shell(beams[i]);
        if (has_shell) functions += pattern_functions_sdl(beams[i], name);
        cases += fmt::format("      #case ({}) {} #break\n",
                             i,
                             has_shell ? pattern_sdl(beams[i], name) : beam_sdl(beams[i]));
    }
    return fmt::format(
        "{}#declare Aphotic_Beam_Names = array[{}] {{{}}}\n"
        "#macro Aphotic_Rig_Beam (Index)\n"
        "   #switch (Index)\n{}   #end\n"
        "#end\n",
        functions,
        names.size(),
        fmt::join(names, ", "),
        cases);
}

std::string strobe_sdl(const Strobe& strobe,
                       const StrobeInScene& in_scene,
                       const std::vector<Beam>& beams,
                       std::span<const NamedSpectrum> lamps) {
    std::string sdl = fmt::format("   // Strobe: {}\n", sdl_comment(strobe.name));
    if (light_count(in_scene.beam) == 0) return sdl + "   // lights nothing in view\n";
    sdl += "   #local Beam = ";
    if (needs_shell(in_scene.beam)) {
        const auto at = std::ranges::find(beams, in_scene.beam) - beams.begin();
        sdl += fmt::format("Aphotic_Rig_Beam ({})\n", at);
    } else {
        sdl += beam_sdl(in_scene.beam) + "\n";
    }
    return sdl + fmt::format("   Aphotic_Strobe ({} / Aphotic_Unit, {}, Beam, {}, {}, {})\n",
                             sdl_point(strobe.position_m),
                             sdl_point(strobe.axis),
                             sdl_text(name_of(strobe.spectrum, lamps)),
                             sdl_number(strobe.power),
                             emitter_sdl(strobe, in_scene.lamps));
}

std::string seafloor_sdl(const Rig& rig, std::span<const NamedSpectrum> reflectances) {
    const Seafloor& floor = rig.seafloor;
    return fmt::format(
        "#macro Aphotic_Rig_Seafloor ()\n"
        "   #declare Aphotic_Seafloor_Finish = finish {{ Aphotic_Finish ({}, {}) }}\n"
        "   Aphotic_Seafloor ({} / Aphotic_Unit, {}, {}, {})\n"
        "#end\n",
        sdl_number(floor.phong),
        sdl_number(floor.phong_size),
        sdl_number(rig.sled.altitude_m),
        sdl_number(rig.sled.pitch_rad * kDegreesPerRadian),
        sdl_number(rig.sled.roll_rad * kDegreesPerRadian),
        sdl_text(name_of(floor.reflectance, reflectances)));
}

// The text between an object's braces, before its texture.
struct ShapeText {
    std::string operator()(const Sphere& sphere) const {
        return fmt::format(
            "sphere {{ {}, {}\n", sdl_point(sphere.centre_m), sdl_number(sphere.radius_m));
    }
    std::string operator()(const Box& box) const {
        return fmt::format("box {{ {}, {}\n", sdl_point(box.least_m), sdl_point(box.most_m));
    }
    std::string operator()(const Mesh& mesh) const {
        std::string text = fmt::format("mesh2 {{\n   vertex_vectors {{ {}", mesh.vertices_m.size());
        for (const Vector3d& vertex_m : mesh.vertices_m) text += ",\n      " + sdl_point(vertex_m);
        text += fmt::format(" }}\n   face_indices {{ {}", mesh.triangles.size());
        for (const auto& [a, b, c] : mesh.triangles) {
            text += fmt::format(",\n      <{}, {}, {}>", a, b, c);
        }
        return text + " }\n";
    }
};

// The objects of a rig as a macro for POV-Ray, Aphotic_Rig_Objects (): sphere, box, and mesh2 of
// flat triangles, in POV-Ray's frame (rig/geometry.h), with pigment and finish like the floor's.
// POV-Ray turns a normal towards the camera's ray, so a triangle is lit on the visible side. Every
// object casts shadows, POV-Ray's default, except from within a millimetre of the lit point or of
// the lamp.
std::string pov_objects(const Rig& rig, std::span<const NamedSpectrum> reflectances) {
    std::string text = "#macro Aphotic_Rig_Objects ()\n";
    if (!rig.objects.empty()) {
        text +=
            "   Aphotic_Require_Unit (\"Aphotic_Rig_Objects\")\n"
            "   Aphotic_Require_Sled (\"Aphotic_Rig_Objects\")\n";
    }
    for (const Object& object : rig.objects) {
        text += fmt::format("// Object: {}\n", sdl_comment(object.name));
        text += std::visit(ShapeText{}, object.shape);
        text += fmt::format(
            "   pigment {{ Aphotic_Pigment ({}) }}\n"
            "   finish {{ Aphotic_Finish ({}, {}) }}\n"
            "   #if (Aphotic_Unit != 1) scale 1 / Aphotic_Unit #end\n"
            "   #ifdef (Aphotic_Sled) transform {{ Aphotic_Sled }} #end\n"
            "}}\n",
            sdl_text(name_of(object.reflectance, reflectances)),
            sdl_number(object.phong),
            sdl_number(object.phong_size));
    }
    return text + "#end\n";
}

}  // namespace

std::string rig_sdl(const Rig& rig,
                    const std::vector<StrobeInScene>& strobes,
                    std::span<const NamedSpectrum> lamps,
                    std::span<const NamedSpectrum> reflectances,
                    SceneAuthor author) {
    const std::vector<Beam> beams = called_beams(strobes, author);
    std::string sdl = fmt::format("// The rig: {}\n", sdl_comment(rig.title));
    sdl += beams_sdl(beams);
    sdl += camera_sdl(rig.camera);
    sdl += "#macro Aphotic_Rig_Strobes ()\n";
    for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
        sdl += strobe_sdl(rig.strobes[s], strobes[s], beams, lamps);
    }
    sdl += "#end\n" + seafloor_sdl(rig, reflectances) + pov_objects(rig, reflectances);
    return sdl +
           "#macro Aphotic_Rig ()\n"
           "   Aphotic_Rig_Camera ()\n"
           "   Aphotic_Water ()\n"
           "   Aphotic_Rig_Strobes ()\n"
           "#end\n";
}

}  // namespace aphotic
