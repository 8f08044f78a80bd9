// SPDX-License-Identifier: BSD-3-Clause
#include "validation/shapes.h"

#include "support/box_mesh.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace aphotic::shapes_test {
namespace {

using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Stretch kAhead{0.0, kInfinity};
constexpr double kRounding = 1e-14;  // some operations on doubles near 1

SightLine towards(const Vector3d& from_m, const Vector3d& to_m) {
    return {from_m, (to_m - from_m).normalized()};
}

TEST(TracedSphere, IsMetAtItsDistanceLessItsRadiusAndLeftAtMore) {
    const TracedShape ball(Sphere{.centre_m = {0.0, 0.0, 3.0}, .radius_m = 0.5});
    const SightLine line{Vector3d::Zero(), Vector3d::UnitZ()};
    const auto front = ball.first_hit(line, kAhead);
    ASSERT_TRUE(front);
    EXPECT_NEAR(front->distance_m, 2.5, kRounding);
    EXPECT_NEAR(std::abs(front->normal.z()), 1.0, kRounding);
    const auto back = ball.first_hit(line, {2.6, kInfinity});
    ASSERT_TRUE(back);
    EXPECT_NEAR(back->distance_m, 3.5, kRounding);
    EXPECT_FALSE(ball.first_hit(line, {0.0, 2.4}));
    EXPECT_FALSE(ball.first_hit(line, {3.6, kInfinity}));
    EXPECT_FALSE(ball.first_hit(line, kAhead, 0)) << "a line that starts on it";
    EXPECT_FALSE(ball.first_hit({Vector3d::Zero(), -Vector3d::UnitZ()}, kAhead));
}

// Seen from d away, a sphere of radius R ends at asin(R/d) off its middle, where the tangent is
// sqrt(d^2 - R^2) long.
TEST(TracedSphere, EndsAtItsTangent) {
    const double d = 2.0;
    const double R = 0.3;
    const TracedShape ball(Sphere{.centre_m = {0.0, 0.0, d}, .radius_m = R});
    for (const double side : {-1.0, 1.0}) {
        const double angle = std::asin(R / d) + side * 1e-12;
        const auto hit =
            ball.first_hit({Vector3d::Zero(), {std::sin(angle), 0.0, std::cos(angle)}}, kAhead);
        EXPECT_EQ(hit.has_value(), side < 0.0);
        // Near the tangent the distance goes with the root of the angle.
        EXPECT_NEAR(
            hit ? hit->distance_m : std::sqrt(d * d - R * R), std::sqrt(d * d - R * R), 1e-5);
    }
}

// From 1000 km the squares of the distances hold no more than 0.1 mm.
TEST(TracedSphere, IsExactFromFarAway) {
    const double far_m = 1e6;
    const TracedShape ball(Sphere{.centre_m = {0.0, 0.0, far_m}, .radius_m = 0.001});
    const auto hit = ball.first_hit({Vector3d::Zero(), Vector3d::UnitZ()}, kAhead);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->distance_m, far_m - 0.001, 1e-9);
}

TEST(TracedBox, IsMetAtItsFaces) {
    const TracedShape box(Box{.least_m = {-1.0, -2.0, -3.0}, .most_m = {1.0, 2.0, 3.0}});
    const std::array<double, 3> half{1.0, 2.0, 3.0};
    for (int face = 0; face < 6; ++face) {
        const Vector3d outward = (face % 2 == 0 ? -1.0 : 1.0) * Vector3d::Unit(face / 2);
        const Vector3d aside(0.1, 0.2, 0.3);
        const Vector3d start = 10.0 * outward + aside - aside.dot(outward) * outward;
        const auto hit = box.first_hit({start, -outward}, kAhead);
        ASSERT_TRUE(hit) << face;
        EXPECT_EQ(hit->face, face);
        EXPECT_NEAR(hit->distance_m, 10.0 - half[static_cast<std::size_t>(face / 2)], kRounding);
        EXPECT_NEAR(std::abs(hit->normal.dot(outward)), 1.0, kRounding);
    }
    EXPECT_FALSE(box.first_hit({{0.0, 0.0, 10.0}, Vector3d::UnitX()}, kAhead));
}

// A single triangle is a tree without inner nodes.
TEST(TracedMesh, OfOneTriangleEndsAtItsThreeSides) {
    const TracedShape triangle(
        Mesh{.vertices_m = {{0.0, 0.0, 1.0}, {1.0, 0.0, 1.0}, {0.0, 1.0, 1.0}},
             .triangles = {{0, 1, 2}}});
    const auto is_met = [&](double x, double y) {
        return triangle.first_hit({{x, y, 0.0}, Vector3d::UnitZ()}, kAhead).has_value();
    };
    EXPECT_TRUE(is_met(0.25, 0.25));
    EXPECT_TRUE(is_met(0.499, 0.499));
    EXPECT_FALSE(is_met(0.501, 0.501));
    EXPECT_FALSE(is_met(-0.001, 0.5));
    EXPECT_FALSE(is_met(0.5, -0.001));
    EXPECT_TRUE(triangle.first_hit({{0.25, 0.25, 2.0}, -Vector3d::UnitZ()}, kAhead))
        << "from behind";
}

TEST(TracedMesh, OfTwelveTrianglesIsTheBox) {
    const Box box{.least_m = {-0.5, 0.2, 1.0}, .most_m = {0.25, 0.9, 1.75}};
    const TracedShape solid(box);
    const TracedShape mesh(mesh_of(box));
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(-1.5, 2.5);
    int met = 0;
    for (int i = 0; i < 20000; ++i) {
        const SightLine line = towards({any(random), any(random), any(random)},
                                       {any(random), any(random), any(random)});
        const auto a = solid.first_hit(line, kAhead);
        const auto b = mesh.first_hit(line, kAhead);
        ASSERT_EQ(a.has_value(), b.has_value()) << i;
        if (!a) continue;
        ++met;
        EXPECT_NEAR(a->distance_m, b->distance_m, 1e-12);
        EXPECT_NEAR(std::abs(a->normal.dot(b->normal)), 1.0, 1e-12);
    }
    EXPECT_GT(met, 1000);
}

TEST(TracedMesh, PassesOverTheFaceThatALineStartsOn) {
    const Box box{.least_m = {-1.0, -1.0, -1.0}, .most_m = {1.0, 1.0, 1.0}};
    const TracedShape mesh(mesh_of(box));
    const SightLine line{{0.1, 0.2, -5.0}, Vector3d::UnitZ()};
    const auto front = mesh.first_hit(line, kAhead);
    ASSERT_TRUE(front);
    const auto next = mesh.first_hit(line, kAhead, front->face);
    ASSERT_TRUE(next);
    EXPECT_NEAR(next->distance_m, 6.0, kRounding);
}

}  // namespace
}  // namespace aphotic::shapes_test
