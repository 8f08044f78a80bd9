// SPDX-License-Identifier: BSD-3-Clause
#include "rig/file/mesh_reader.h"

#include "base/error.h"
#include "support/refusal.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace aphotic::mesh_reader_test {
namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;

constexpr std::string_view kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

Mesh read(std::string_view obj, const Vector3d& position_m = Vector3d::Zero()) {
    return parse_mesh("rock.obj", std::string(obj), position_m);
}

std::string error_of(std::string_view obj) {
    return refusal_of([&] { static_cast<void>(read(obj)); });
}

std::string triangle_and(std::string_view text) {
    return std::string(kTriangle) + std::string(text);
}

TEST(MeshReader, ReadsVerticesAndFaces) {
    const Mesh mesh = read(
        "# a comment\r\n  v  0.5 -1.25 2e0 # here\r\nv 1 0 0\nv 0 1 0\n\nvn 0 0 1\nvt 0 0\n"
        "o rock\ng front\nusemtl stone\nf 1/1/1 2//1 3\nf -3 -1 -2\n");
    ASSERT_EQ(mesh.vertices_m.size(), 3U);
    EXPECT_EQ(mesh.vertices_m[0], Vector3d(0.5, -1.25, 2.0));
    ASSERT_EQ(mesh.triangles.size(), 2U);
    EXPECT_EQ(mesh.triangles[0], (std::array{0, 1, 2}));
    EXPECT_EQ(mesh.triangles[1], (std::array{0, 2, 1}));
}

double area_of(const Mesh& mesh) {
    double sum = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const auto at = [&](int i) { return mesh.vertices_m[static_cast<std::size_t>(i)]; };
        sum += 0.5 * (at(b) - at(a)).cross(at(c) - at(a)).norm();
    }
    return sum;
}

// The area of a unit square and of a regular hexagon of side 1, 3 sqrt(3)/2, however they are cut.
TEST(MeshReader, CutsPolygonsIntoTriangles) {
    const Mesh square = read("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    EXPECT_EQ(square.triangles.size(), 2U);
    EXPECT_EQ(area_of(square), 1.0);
    const Mesh hexagon = read(
        "v 1 0 0\nv 0.5 0.8660254 0\nv -0.5 0.8660254 0\nv -1 0 0\nv -0.5 -0.8660254 0\n"
        "v 0.5 -0.8660254 0\nf 1 2 3 4 5 6\n");
    EXPECT_EQ(hexagon.triangles.size(), 4U);
    EXPECT_NEAR(area_of(hexagon), 2.5980762, 1e-6);
}

TEST(MeshReader, AddsThePositionAndRoundsToSinglePrecision) {
    const Mesh mesh = read(triangle_and("f 1 2 3\n"), {0.1, -2.0, 1.9});
    EXPECT_EQ(mesh.vertices_m[1],
              Vector3d(static_cast<double>(1.1F), -2.0, static_cast<double>(1.9F)));
}

TEST(MeshReader, NamesTheLineOfWhatItCannotRead) {
    EXPECT_EQ(error_of("v 0 0 0\nv 1 nan 0\n"),
              "rock.obj:2: found v 1 nan 0; allowed: v and three finite numbers");
    EXPECT_EQ(error_of("v 0 0 1e999\n"),
              "rock.obj:1: found v 0 0 1e999; allowed: v and three finite numbers");
    EXPECT_EQ(error_of("v 0 0\n"), "rock.obj:1: found v 0 0; allowed: v and three finite numbers");
    EXPECT_EQ(error_of("v 0 0 1,5\n"),
              "rock.obj:1: found v 0 0 1,5; allowed: v and three finite numbers");
    const std::string allowed = "; allowed: f and 3 to 256 of the 3 vertices above it";
    for (const std::string face : {"f 1 2", "f 1 2 4", "f 0 1 2", "f 1 2 -4", "f 1 2 x", "f"}) {
        EXPECT_EQ(error_of(triangle_and(face + "\n")), "rock.obj:4: found " + face + allowed);
    }
}

TEST(MeshReader, RefusesWhatIsNoMesh) {
    EXPECT_EQ(error_of(""), "rock.obj: found no faces; allowed: 1 to 1000000 triangles");
    EXPECT_EQ(error_of(kTriangle), "rock.obj: found no faces; allowed: 1 to 1000000 triangles");
    const std::string flat =
        "rock.obj: found a triangle without area, with vertices 1, 2 and 3 (counted from 1); "
        "allowed: three corners not on one line";
    EXPECT_EQ(error_of("v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n"), flat);
    EXPECT_EQ(error_of("v 0 0 0\nv 1 1 1\nv 1 1 1\nf 1 2 3\n"), flat);
}

TEST(MeshReader, RefusesMoreTrianglesThanItsLimit) {
    std::string obj(kTriangle);
    for (std::size_t i = 0; i <= kMostTriangles; ++i) obj += "f 1 2 3\n";
    EXPECT_EQ(error_of(obj), "rock.obj: found 1000001 triangles; allowed: 1 to 1000000 triangles");
}

// Corners on a circle.
std::string polygon(std::size_t corners) {
    std::string vertices;
    std::string face = "f";
    for (std::size_t i = 0; i < corners; ++i) {
        const double angle = 2.0 * kPi * static_cast<double>(i) / static_cast<double>(corners);
        vertices += fmt::format("v {:.6f} {:.6f} 1\n", std::cos(angle), std::sin(angle));
        face += fmt::format(" {}", i + 1);
    }
    return vertices + face + "\n";
}

TEST(MeshReader, RefusesPolygonsOfMoreCornersThanItsLimit) {
    EXPECT_EQ(parse_mesh("rock.obj", polygon(kMostCorners), {0.0, 0.0, 0.0}).triangles.size(),
              kMostCorners - 2);
    EXPECT_TRUE(error_of(polygon(kMostCorners + 1)).starts_with("rock.obj:258: found f 1 2 3 4 "));
    EXPECT_TRUE(error_of(polygon(kMostCorners + 1))
                    .ends_with("...; allowed: f and 3 to 256 of the 257 vertices above it"));
}

// By the shoelace formula; corners on one line, a corner twice.
TEST(MeshReader, CutsPolygonsThatAreNotConvex) {
    struct Case {
        std::vector<std::pair<double, double>> corners;
    };
    for (const auto& [corners] :
         {Case{{{0.926498, 0.144645},
                {0.698354, 0.237795},
                {0.024322, 0.038550},
                {0.324720, 0.330341},
                {0.057062, 0.690567}}},
          Case{{{0, 0}, {4, 1}, {0, 2}, {1, 1}}},
          Case{{{3, 3}, {7, 4}, {3, 5}, {4, 4}}},
          Case{{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}},
          Case{{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 3}, {2, 3}, {1, 3}, {0, 3}}},
          Case{{{0, 0}, {1, 0}, {1, 1}, {1, 1}}}}) {
        std::string obj;
        std::string face = "f";
        double twice = 0.0;
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const auto& [x, y] = corners[i];
            const auto& [next_x, next_y] = corners[(i + 1) % corners.size()];
            twice += x * next_y - next_x * y;
            obj += fmt::format("v {} {} 1\n", x, y);
            face += fmt::format(" {}", i + 1);
        }
        EXPECT_NEAR(area_of(read(obj + face)), 0.5 * std::abs(twice), 1e-6) << obj << face;
    }
}

// A quadrilateral that is not flat has two shapes.
TEST(MeshReader, CutsQuadrilateralsAlongTheShorterDiagonal) {
    const std::string shorter = "v 0 0 0\nv 1 0 0.5\nv 1 1 0\nv 0 1 0\n";
    for (const auto& triangle : read(shorter + "f 1 2 3 4\n").triangles) {
        EXPECT_EQ(std::ranges::count(triangle, 0) + std::ranges::count(triangle, 2), 2);
    }
    for (const auto& triangle : read(shorter + "f 2 3 4 1\n").triangles) {
        EXPECT_EQ(std::ranges::count(triangle, 0) + std::ranges::count(triangle, 2), 2);
    }
}

// Sides that cross, no area at all, and a comb, of which no corner sees all teeth.
TEST(MeshReader, LeavesNoHoleWhereAPolygonCannotBeCut) {
    const std::string error =
        ": found a polygon that cannot be cut into triangles from one of its corners; allowed: one "
        "with a corner that sees all others, or triangles instead";
    EXPECT_EQ(error_of("v 0 0 0\nv 2 2 0\nv 2 0 0\nv 0 1 0\nf 1 2 3 4\n"), "rock.obj:5" + error);
    EXPECT_EQ(error_of("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nf 1 2 3 4\n"), "rock.obj:5" + error);
    EXPECT_EQ(error_of("v 0 0 0\nv 9 0 0\nv 8 4 0\nv 7 1 0\nv 5 1 0\nv 4 4 0\nv 3 1 0\n"
                       "v 1 1 0\nv 0.5 4 0\nf 1 2 3 4 5 6 7 8 9\n"),
              "rock.obj:10" + error);
}

// Cut before they are counted, these would take minutes.
TEST(MeshReader, CountsTheTrianglesOfPolygonsBeforeItCutsThem) {
    std::string obj = polygon(kMostCorners);
    const std::string face = obj.substr(obj.find('f'));
    constexpr std::size_t kFaces = 20'000;
    for (std::size_t i = 1; i < kFaces; ++i) obj += face;
    EXPECT_EQ(error_of(obj),
              fmt::format("rock.obj: found {} triangles; allowed: 1 to 1000000 triangles",
                          kFaces * (kMostCorners - 2)));
}

}  // namespace
}  // namespace aphotic::mesh_reader_test
