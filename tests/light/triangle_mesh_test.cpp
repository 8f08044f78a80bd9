// SPDX-License-Identifier: BSD-3-Clause
#include "light/triangle_mesh.h"

#include "support/dice.h"

#include <gtest/gtest.h>
#include <Eigen/Core>

#include <vector>

namespace aphotic::triangle_mesh_test {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr double kRounding = 1e-13;  // of some tens of operations on doubles, seen aslant

// The plane z = 2 + x / 4 over [-8, 8] each way, in squares of 1 cut in two: all are exact in
// floats.
TriangleMesh slope() {
    std::vector<Vector3f> vertices_m;
    std::vector<std::array<int, 3>> triangles;
    for (int j = -8; j <= 8; ++j)
        for (int i = -8; i <= 8; ++i)
            vertices_m.emplace_back(
                static_cast<float>(i), static_cast<float>(j), 2.0F + 0.25F * static_cast<float>(i));
    for (int j = 0; j < 16; ++j) {
        for (int i = 0; i < 16; ++i) {
            const int a = 17 * j + i;
            triangles.push_back({a, a + 1, a + 17});
            triangles.push_back({a + 1, a + 17, a + 18});
        }
    }
    return {vertices_m, triangles};
}

// In closed form, also along edges and through corners, where no ray slips through.
TEST(TriangleMesh, IsMetWhereItsPlaneIs) {
    const TriangleMesh mesh = slope();
    Dice dice(3);
    for (int k = 0; k < 2000; ++k) {
        const bool is_at_corner = k % 2 == 0;
        const double x = is_at_corner ? k % 13 - 6.0 : dice.between(-7.0, 7.0);
        const double y = is_at_corner ? k % 11 - 5.0 : dice.between(-7.0, 7.0);
        const double times = dice.between(0.5, 3.0);
        const auto hit = mesh.first_hit(Vector3d::Zero(), Vector3d(x, y, 2.0 + 0.25 * x) / times);
        ASSERT_TRUE(hit) << x << ", " << y;
        EXPECT_NEAR(*hit, times, kRounding * times) << x << ", " << y;
    }
    EXPECT_FALSE(mesh.first_hit(Vector3d::Zero(), -Vector3d::UnitZ()));
    EXPECT_FALSE(mesh.first_hit({20.0, 0.0, 0.0}, Vector3d::UnitZ()));
}

TEST(TriangleMesh, BlocksWhatCrossesIt) {
    const TriangleMesh mesh = slope();
    const Vector3f down(0.0F, 0.0F, 3.0F);
    EXPECT_TRUE(mesh.blocks(Vector3f::Zero(), down, 0.0F));
    EXPECT_FALSE(mesh.blocks(Vector3f::Zero(), 0.5F * down, 0.0F));
    EXPECT_FALSE(mesh.blocks(Vector3f::Zero(), down, 0.7F));
}

TEST(TriangleMesh, WithoutTrianglesIsMetByNothing) {
    const TriangleMesh mesh(std::vector<Vector3f>(3, Vector3f::Zero()), {});
    EXPECT_FALSE(mesh.first_hit({0.0, 0.0, -1.0}, Vector3d::UnitZ()));
}

}  // namespace
}  // namespace aphotic::triangle_mesh_test
