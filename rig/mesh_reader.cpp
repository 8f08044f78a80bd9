// SPDX-License-Identifier: BSD-3-Clause
#include "rig/mesh_reader.h"

#include "base/error.h"
#include "base/printable.h"

#include <fmt/format.h>
#include <tiny_obj_loader.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <sstream>

namespace aphotic {

using Eigen::Vector3d;

namespace {

// The words of a line, comments and line ends aside.
std::vector<std::string_view> words_of(std::string_view line) {
    constexpr std::string_view kBlank = " \t\r";
    line = line.substr(0, line.find('#'));
    std::vector<std::string_view> words;
    while (true) {
        const std::size_t first = line.find_first_not_of(kBlank);
        if (first == std::string_view::npos) return words;
        line.remove_prefix(first);
        const std::size_t length = std::min(line.size(), line.find_first_of(kBlank));
        words.push_back(line.substr(0, length));
        line.remove_prefix(length);
    }
}

// As much of a line as one reads.
std::string shown(const std::vector<std::string_view>& words) {
    constexpr std::size_t kMostLetters = 200;
    const std::string line = fmt::format("{}", fmt::join(words, " "));
    return line.size() <= kMostLetters ? printable(line)
                                       : printable(line.substr(0, kMostLetters)) + " ...";
}

bool is_finite_number(std::string_view word) {
    double value = 0.0;
    if (word.starts_with('+')) word.remove_prefix(1);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    return error == std::errc() && end == word.data() + word.size() && std::isfinite(value);
}

// Of a face's corner such as "3", "3/1" or "-1//2": texture and normal do not count.
std::string_view vertex_of(std::string_view corner) {
    return corner.substr(0, corner.find('/'));
}

// The vertex of a face's corner such as "3", "3/1" or "-1//2" is there.
bool is_vertex_before(std::string_view corner, long vertices) {
    long index = 0;
    const std::string_view word = vertex_of(corner);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), index);
    return error == std::errc() && end == word.data() + word.size() && index != 0 &&
           std::abs(index) <= vertices;
}

struct SoundLines {
    std::string text;
    std::size_t triangles = 0;  // into which their polygons are to be cut
};

// The lines that count, and of their words those that do. The library takes what it cannot read for
// 0, and leaves out what does not fit, without a word: so it gets these alone, each looked at
// first.
SoundLines sound_lines(const std::string& text, const std::string& file_name) {
    std::istringstream lines(text);
    std::string line;
    SoundLines sound;
    long vertices = 0;
    for (int number = 1; std::getline(lines, line); ++number) {
        const std::vector<std::string_view> words = words_of(line);
        if (words.empty()) continue;
        const auto require = [&](bool is_sound, std::string_view allowed) {
            if (is_sound) return;
            throw InputError(fmt::format(
                "{}:{}: found {}; allowed: {}", file_name, number, shown(words), allowed));
        };
        const std::span values = std::span(words).subspan(1);
        if (words[0] == "v") {
            require(values.size() >= 3 && std::ranges::all_of(values, is_finite_number),
                    "v and three finite numbers");
            sound.text += fmt::format("v {} {} {}\n", values[0], values[1], values[2]);
            ++vertices;
        } else if (words[0] == "f") {
            const auto is_there = [&](std::string_view corner) {
                return is_vertex_before(corner, vertices);
            };
            require(values.size() >= 3 && values.size() <= kMostCorners &&
                        std::ranges::all_of(values, is_there),
                    fmt::format(
                        "f and from 3 to {} of the {} vertices above it", kMostCorners, vertices));
            sound.text += 'f';
            for (const std::string_view corner : values)
                sound.text += fmt::format(" {}", vertex_of(corner));
            sound.text += '\n';
            sound.triangles += values.size() - 2;
        }
    }
    return sound;
}

// volatile: where GCC 12 turns several of these into vector instructions, it leaves out the
// rounding.
double to_single(double value) {
    const volatile float rounded = static_cast<float>(value);
    return rounded;
}

// Before any polygon is cut: that takes the longer the more there are.
void require_room(std::size_t triangles, const std::string& file_name) {
    if (triangles > 0 && triangles <= kMostTriangles) return;
    throw InputError(
        fmt::format("{}: found {}; allowed: 1 to {} triangles",
                    file_name,
                    triangles == 0 ? "no faces" : fmt::format("{} triangles", triangles),
                    kMostTriangles));
}

// Of a polygon that it cannot cut, the library leaves out the rest without a word.
void require_whole(const std::vector<tinyobj::shape_t>& shapes,
                   std::size_t triangles,
                   const std::string& file_name) {
    std::size_t made = 0;
    for (const tinyobj::shape_t& shape : shapes) made += shape.mesh.indices.size() / 3;
    if (made == triangles) return;
    throw InputError(
        fmt::format("{}: found polygons of which {} of {} triangles could be made; allowed: "
                    "triangles in place of those that are not convex",
                    file_name,
                    made,
                    triangles));
}

void require_area(const Mesh& mesh,
                  const std::array<int, 3>& corners,
                  const std::string& file_name) {
    const auto vertex = [&](int i) -> const Vector3d& {
        return mesh.vertices_m[static_cast<std::size_t>(corners[static_cast<std::size_t>(i)])];
    };
    const Vector3d ab = vertex(1) - vertex(0);
    const Vector3d ac = vertex(2) - vertex(0);
    const double longest2 = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
    if (ab.cross(ac).norm() > kLeastTriangleHeight * longest2) return;
    throw InputError(fmt::format(
        "{}: found a triangle without area, of the vertices {}, {} and {}, counted from "
        "1; allowed: three corners that do not lie on one line",
        file_name,
        corners[0] + 1,
        corners[1] + 1,
        corners[2] + 1));
}

}  // namespace

Mesh parse_mesh(const std::string& file_name, const std::string& obj, const Vector3d& position_m) {
    const SoundLines lines = sound_lines(obj, file_name);
    require_room(lines.triangles, file_name);
    std::istringstream in(lines.text);
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    std::vector<tinyobj::material_t> materials;
    std::string warnings;
    std::string errors;
    if (!tinyobj::LoadObj(&attributes, &shapes, &materials, &warnings, &errors, &in)) {
        throw InputError(fmt::format("{}: cannot be read: {}", file_name, errors));
    }
    require_whole(shapes, lines.triangles, file_name);

    Mesh mesh;
    const std::vector<double>& xyz = attributes.vertices;
    for (std::size_t i = 0; i + 2 < xyz.size(); i += 3) {
        const Vector3d vertex_m = position_m + Vector3d(xyz[i], xyz[i + 1], xyz[i + 2]);
        mesh.vertices_m.emplace_back(vertex_m.unaryExpr(&to_single));
    }
    for (const tinyobj::shape_t& shape : shapes) {
        const std::vector<tinyobj::index_t>& corners = shape.mesh.indices;
        for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
            mesh.triangles.push_back({corners[i].vertex_index,
                                      corners[i + 1].vertex_index,
                                      corners[i + 2].vertex_index});
            require_area(mesh, mesh.triangles.back(), file_name);
        }
    }
    return mesh;
}

}  // namespace aphotic
