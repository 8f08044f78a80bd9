// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/mesh_reader.h"

#include "spectral/error.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <string>

namespace aphotic {
namespace {

using Eigen::Vector3d;

constexpr std::string_view kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

Mesh read(std::string_view obj, const Vector3d& position_m = Vector3d::Zero()) {
    return parse_mesh("rock.obj", std::string(obj), position_m);
}

std::string error_of(std::string_view obj) {
    try {
        static_cast<void>(read(obj));
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
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

// The area of a unit square and of a regular hexagon of side 1, 3 sqrt(3)/2, however they are cut.
TEST(MeshReader, CutsPolygonsIntoTriangles) {
    const auto area = [](const Mesh& mesh) {
        double sum = 0.0;
        for (const auto& [a, b, c] : mesh.triangles) {
            const auto at = [&](int i) { return mesh.vertices_m[static_cast<std::size_t>(i)]; };
            sum += 0.5 * (at(b) - at(a)).cross(at(c) - at(a)).norm();
        }
        return sum;
    };
    const Mesh square = read("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    EXPECT_EQ(square.triangles.size(), 2U);
    EXPECT_EQ(area(square), 1.0);
    const Mesh hexagon = read(
        "v 1 0 0\nv 0.5 0.8660254 0\nv -0.5 0.8660254 0\nv -1 0 0\nv -0.5 -0.8660254 0\n"
        "v 0.5 -0.8660254 0\nf 1 2 3 4 5 6\n");
    EXPECT_EQ(hexagon.triangles.size(), 4U);
    EXPECT_NEAR(area(hexagon), 2.5980762, 1e-6);
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
    const std::string allowed = "; allowed: f and three or more of the 3 vertices above it";
    for (const std::string face : {"f 1 2", "f 1 2 4", "f 0 1 2", "f 1 2 -4", "f 1 2 x", "f"}) {
        EXPECT_EQ(error_of(triangle_and(face + "\n")), "rock.obj:4: found " + face + allowed);
    }
}

TEST(MeshReader, RefusesWhatIsNoMesh) {
    EXPECT_EQ(error_of(""), "rock.obj: found no faces; allowed: 1 to 1000000 triangles");
    EXPECT_EQ(error_of(kTriangle), "rock.obj: found no faces; allowed: 1 to 1000000 triangles");
    const std::string flat =
        "rock.obj: found a triangle of no area, of the vertices 1, 2 and 3, counted from 1; "
        "allowed: three corners that do not lie on one line";
    EXPECT_EQ(error_of("v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n"), flat);
    EXPECT_EQ(error_of("v 0 0 0\nv 1 1 1\nv 1 1 1\nf 1 2 3\n"), flat);
}

TEST(MeshReader, RefusesMoreTrianglesThanItsLimit) {
    std::string obj(kTriangle);
    for (std::size_t i = 0; i <= kMostTriangles; ++i) obj += "f 1 2 3\n";
    EXPECT_EQ(error_of(obj), "rock.obj: found 1000001 triangles; allowed: 1 to 1000000 triangles");
}

}  // namespace
}  // namespace aphotic
