// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/pov_objects.h"

#include <fmt/format.h>

#include <variant>

namespace aphotic {

using Eigen::Vector3d;

namespace {

// What goes between an object's braces, before its texture.
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

}  // namespace

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

}  // namespace aphotic
