// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/pov_objects.h"

#include "scene_gen/geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace aphotic {

using Eigen::Vector3d;

namespace {

// Seventeen significant digits carry a double through text unchanged.
std::string point(const Vector3d& sled) {
    const Vector3d pov = to_povray(sled);
    return fmt::format("<{:.17g}, {:.17g}, {:.17g}>", pov.x(), pov.y(), pov.z());
}

// What a rig says in words may hold anything; in a comment it must stay on its line.
std::string comment_text(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return std::iscntrl(c) != 0; }, ' ');
    return text;
}

// What goes between an object's braces, before its texture.
struct ShapeText {
    std::string operator()(const Sphere& sphere) const {
        return fmt::format("sphere {{ {}, {:.17g}\n", point(sphere.centre_m), sphere.radius_m);
    }
    std::string operator()(const Box& box) const {
        return fmt::format("box {{ {}, {}\n", point(box.least_m), point(box.most_m));
    }
    std::string operator()(const Mesh& mesh) const {
        std::string text = fmt::format("mesh2 {{\n   vertex_vectors {{ {}", mesh.vertices_m.size());
        for (const Vector3d& vertex_m : mesh.vertices_m) text += ",\n      " + point(vertex_m);
        text += fmt::format(" }}\n   face_indices {{ {}", mesh.triangles.size());
        for (const auto& [a, b, c] : mesh.triangles) {
            text += fmt::format(",\n      <{}, {}, {}>", a, b, c);
        }
        return text + " }\n";
    }
};

}  // namespace

std::string pov_objects(const Rig& rig, const std::function<std::string(const Spectrum&)>& rgb) {
    std::string text;
    for (const Object& object : rig.objects) {
        text += fmt::format("// Object: {}\n", comment_text(object.name));
        text += std::visit(ShapeText{}, object.shape);
        text += fmt::format("   pigment {{ rgb {} }}\n", rgb(object.reflectance));
        if (object.phong > 0.0) {
            text += fmt::format("   finish {{ phong {:.17g}  phong_size {:.17g} }}\n",
                                object.phong,
                                object.phong_size);
        }
        text += "}\n\n";
    }
    return text;
}

}  // namespace aphotic
