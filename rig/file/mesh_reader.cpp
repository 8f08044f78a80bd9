// SPDX-License-Identifier: BSD-3-Clause
#include "rig/file/mesh_reader.h"

#include "base/csv.h"
#include "base/error.h"
#include "base/number.h"
#include "base/printable.h"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <sstream>

namespace aphotic {

using Eigen::Vector3d;

namespace {

using Triangle = std::array<int, 3>;

// The vertex, from 0, of a face's corner such as "3", "3/1" or "-1//2", whose texture and normal
// are ignored. Empty if no vertex above it has that number.
std::optional<int> vertex_of(std::string_view corner, int vertices) {
    const auto index = read_number<int>(corner.substr(0, corner.find('/')));
    if (!index || *index == 0 || *index > vertices || *index < -vertices) return std::nullopt;
    return *index > 0 ? *index - 1 : vertices + *index;
}

// volatile: GCC 12 omits the rounding when it vectorises several of these.
double to_single(double value) {
    const volatile float rounded = static_cast<float>(value);
    return rounded;
}

struct Polygon {
    int line = 0;
    std::vector<int> corners;
};

struct Faces {
    std::vector<Polygon> polygons;  // without excess ones
    std::size_t triangles = 0;      // total after cutting
};

// Reads the relevant lines.
Faces read_lines(const std::string& text,
                 const std::string& file_name,
                 std::size_t most_triangles,
                 std::vector<Vector3d>& vertices_m) {
    std::istringstream lines(text);
    std::string line;
    Faces faces;
    for (int number = 1; std::getline(lines, line); ++number) {
        const std::string_view content = std::string_view(line).substr(0, line.find('#'));
        const std::vector<std::string_view> words = words_in(content);
        if (words.empty()) continue;
        const auto refuse = [&](std::string_view allowed) {
            throw InputError("{}:{}: found {}; allowed: {}",
                             file_name,
                             number,
                             excerpt(trimmed(content)),
                             allowed);
        };
        const std::span values = std::span(words).subspan(1);
        if (words[0] == "v") {
            std::vector<double> xyz;
            for (const std::string_view word : values) {
                if (const auto value = finite_number(word)) xyz.push_back(*value);
            }
            if (xyz.size() != values.size() || xyz.size() < 3) refuse("v and three finite numbers");
            vertices_m.emplace_back(xyz[0], xyz[1], xyz[2]);
        } else if (words[0] == "f") {
            Polygon polygon{.line = number, .corners = {}};
            const auto vertices = static_cast<int>(vertices_m.size());
            for (const std::string_view word : values) {
                if (const auto vertex = vertex_of(word, vertices))
                    polygon.corners.push_back(*vertex);
            }
            const std::size_t corners = polygon.corners.size();
            if (corners != values.size() || corners < 3 || corners > kMostCorners) {
                refuse(fmt::format(
                    "f and 3 to {} of the {} vertices above it", kMostCorners, vertices));
            }
            faces.triangles += corners - 2;
            if (faces.triangles <= most_triangles) faces.polygons.push_back(std::move(polygon));
        }
    }
    return faces;
}

// Called before any polygon is cut, since cutting time grows with their number.
void require_room(std::size_t triangles, const std::string& file_name, std::size_t most) {
    if (triangles > 0 && triangles <= most) return;
    throw InputError("{}: found {}; allowed: 1 to {} triangles",
                     file_name,
                     triangles == 0 ? "no faces" : fmt::format("{} triangles", triangles),
                     most);
}

bool has_area(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    const double longest2 =
        std::max({(b - a).squaredNorm(), (c - a).squaredNorm(), (c - b).squaredNorm()});
    return (b - a).cross(c - a).norm() > kLeastTriangleHeight * longest2;
}

}  // namespace

std::vector<Triangle> cut(const Mesh& mesh, std::vector<int> corners) {
    const auto at = [&](std::size_t i) {
        return mesh.vertices_m[static_cast<std::size_t>(corners[i])];
    };
    const auto span = [&](std::size_t i) -> Vector3d {
        return (at(i) - at(0)).cross(at(i + 1) - at(0));
    };
    Vector3d normal = Vector3d::Zero();
    for (std::size_t i = 1; i + 1 < corners.size(); ++i) normal += span(i);
    std::vector<Triangle> best;
    double shortest = std::numeric_limits<double>::infinity();
    for (std::size_t turn = 0; turn < corners.size(); ++turn) {
        std::vector<Triangle> fan;
        double diagonals = 0.0;
        bool sees_all = true;
        for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
            if (i > 1) diagonals += (at(i) - at(0)).squaredNorm();
            if (!has_area(at(0), at(i), at(i + 1))) continue;
            sees_all = sees_all && normal.dot(span(i)) > 0.0;
            fan.push_back({corners[0], corners[i], corners[i + 1]});
        }
        if (sees_all && diagonals <= shortest) {
            shortest = diagonals;
            best = std::move(fan);
        }
        std::rotate(corners.begin(), corners.begin() + 1, corners.end());
    }
    return best;
}

namespace {

Triangle checked_triangle(const Mesh& mesh,
                          const std::vector<int>& corners,
                          const std::string& file_name) {
    const auto at = [&](std::size_t i) {
        return mesh.vertices_m[static_cast<std::size_t>(corners[i])];
    };
    if (has_area(at(0), at(1), at(2))) return {corners[0], corners[1], corners[2]};
    throw InputError(
        "{}: found a triangle without area, with vertices {}, {} and {} (counted from 1); allowed: "
        "three corners not on one line",
        file_name,
        corners[0] + 1,
        corners[1] + 1,
        corners[2] + 1);
}

void add_triangles(const Faces& faces, const std::string& file_name, bool has_areas, Mesh& mesh) {
    for (const auto& [line, corners] : faces.polygons) {
        if (corners.size() == 3) {
            mesh.triangles.push_back(has_areas ? checked_triangle(mesh, corners, file_name)
                                               : Triangle{corners[0], corners[1], corners[2]});
            continue;
        }
        const std::vector<Triangle> triangles = cut(mesh, corners);
        if (triangles.empty()) {
            throw InputError(
                "{}:{}: found a polygon that cannot be cut into triangles from one of its corners; "
                "allowed: one with a corner that sees all others, or triangles instead",
                file_name,
                line);
        }
        mesh.triangles.insert(mesh.triangles.end(), triangles.begin(), triangles.end());
    }
}

}  // namespace

Mesh parse_mesh(const std::string& file_name, const std::string& obj, const Vector3d& position_m) {
    Mesh mesh;
    const Faces faces = read_lines(obj, file_name, kMostTriangles, mesh.vertices_m);
    require_room(faces.triangles, file_name, kMostTriangles);
    for (Vector3d& vertex_m : mesh.vertices_m) {
        const Vector3d placed_m = position_m + vertex_m;
        vertex_m = placed_m.unaryExpr(&to_single);
    }
    add_triangles(faces, file_name, true, mesh);
    return mesh;
}

Mesh parse_obj(const std::string& file_name, const std::string& obj, std::size_t most_triangles) {
    Mesh mesh;
    const Faces faces = read_lines(obj, file_name, most_triangles, mesh.vertices_m);
    require_room(faces.triangles, file_name, most_triangles);
    add_triangles(faces, file_name, false, mesh);
    return mesh;
}

}  // namespace aphotic
