// SPDX-License-Identifier: BSD-3-Clause
#include "survey/relief/relief_mesh.h"

#include "support/geotiff.h"
#include "support/has.h"
#include "support/refusal.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <limits>

namespace aphotic::relief_mesh_test {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

// Seen from above; a grid of n x m samples is (n - 1)(m - 1) cells.
double area_of(const Mesh& mesh) {
    double area = 0.0;
    for (const auto& [a, b, c] : mesh.triangles) {
        const auto at = [&](int i) { return mesh.vertices_m[static_cast<std::size_t>(i)]; };
        area += 0.5 * std::abs((at(b) - at(a)).cross(at(c) - at(a)).z());
    }
    return area;
}

TEST(ReliefMesh, OfAGridCoversWhatIsKnown) {
    HeightGrid grid{.width = 4,
                    .height = 3,
                    .east_m = 500000.0,
                    .north_m = 5000000.0,
                    .step_east_m = 0.5,
                    .step_south_m = 2.0,
                    .height_m = std::vector<float>(12, -3.0F)};
    const Mesh whole = mesh_of(grid);
    EXPECT_EQ(area_of(whole), 6.0);
    EXPECT_EQ(whole.vertices_m.back(), Eigen::Vector3d(500001.5, 4999996.0, -3.0));
    grid.height_m[0] = kNone;  // half a cell; and of the last row's middle, three halves
    EXPECT_EQ(area_of(mesh_of(grid)), 5.5);
    grid.height_m[9] = kNone;
    EXPECT_EQ(area_of(mesh_of(grid)), 4.0);
    grid.height_m.assign(12, kNone);
    EXPECT_TRUE(
        has(refusal_of([&] { (void)mesh_of(grid); }), "found no three adjacent known heights"));
    grid.width = 20000;
    grid.height = 20000;
    EXPECT_TRUE(has(refusal_of([&] { (void)mesh_of(grid); }), "found 20000 x 20000 heights"));
}

TEST(ReliefMesh, IsReadByItsExtension) {
    const TempFolder folder;
    const auto path = [&](const std::string& name) { return folder.path() / name; };
    write_file(path("a.OBJ"),
               "# far off\nv 500000.25 5000000 -1 0.5 0.5 0.5\nv 500001 5000000 -1\n"
               "v 500001 5000001 -1\nv 500001 5000001 -1\nvn 0 0 1\nf 1//1 2//1 3//1\nf 2 3 4\n");
    const Mesh obj = read_relief_mesh(path("a.OBJ"));
    EXPECT_EQ(obj.vertices_m[0], Eigen::Vector3d(500000.25, 5000000.0, -1.0));
    EXPECT_EQ(obj.triangles.size(), 2U);  // one of them without area
    write_file(path("a.ply"),
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
               "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
               "end_header\n0 0 0 1 0 0 0 1 0\n3 0 1 2\n");
    EXPECT_EQ(area_of(read_relief_mesh(path("a.ply"))), 0.5);
    write_file(path("a.tif"), geotiff_of(std::vector<float>(6, 1.0F), {.width = 3, .height = 2}));
    EXPECT_EQ(area_of(read_relief_mesh(path("a.tif"))), 2.0);
    write_file(path("a.xyz"), "");
    EXPECT_TRUE(has(refusal_of([&] { (void)read_relief_mesh(path("a.xyz")); }),
                    "found the extension '.xyz'; allowed: .ply, .obj, .tif"));
    write_file(path("bad.obj"), "v 0 0 0\nf 1 2 3\n");
    EXPECT_TRUE(has(refusal_of([&] { (void)read_relief_mesh(path("bad.obj")); }),
                    "bad.obj:2: found f 1 2 3"));
    write_file(path("points.obj"), "v 0 0 0\n");
    EXPECT_TRUE(
        has(refusal_of([&] { (void)read_relief_mesh(path("points.obj")); }), "found no faces"));
}

}  // namespace
}  // namespace aphotic::relief_mesh_test
