// SPDX-License-Identifier: BSD-3-Clause
#include "rig/solid.h"

#include "support/scene_rig.h"
#include "tests/support/box_mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace aphotic::solid_test {
namespace {

using Eigen::Vector3d;

constexpr double kRounding = 1e-14;  // some operations on doubles near 1
const Box kBox{.least_m = {-0.3, 0.1, 1.0}, .most_m = {0.2, 0.6, 1.5}};

Object object_of(const Shape& shape) {
    return {.name = "thing", .shape = shape, .reflectance = habcam().seafloor.reflectance};
}

TEST(Solid, OfASphereIsItsRadiusNearerThanItsCentre) {
    const Sphere ball{.centre_m = {1.0, 2.0, 2.0}, .radius_m = 0.5};
    EXPECT_NEAR(distance_m(ball, Vector3d::Zero()), 2.5, kRounding);
    EXPECT_EQ(distance_m(ball, {1.0, 2.0, 2.2}), 0.0);
    EXPECT_TRUE(holds(ball, {1.0, 2.0, 2.2}));
    EXPECT_FALSE(holds(ball, {1.0, 2.0, 2.6}));
}

// The twelve triangles against the box: outside they are as far, inside the mesh is as far as its
// nearest side.
TEST(Solid, OfAMeshIsAsFarAsTheBoxThatItCovers) {
    const Mesh mesh = mesh_of(kBox);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(-1.0, 2.0);
    int inside = 0;
    for (int i = 0; i < 5000; ++i) {
        const Vector3d point_m(any(random), any(random), any(random));
        const bool is_inside = holds(kBox, point_m);
        ASSERT_EQ(holds(mesh, point_m), is_inside) << point_m.transpose();
        inside += is_inside ? 1 : 0;
        const double wanted = is_inside ? std::min((point_m - kBox.least_m).minCoeff(),
                                                   (kBox.most_m - point_m).minCoeff())
                                        : distance_m(kBox, point_m);
        EXPECT_NEAR(distance_m(mesh, point_m), wanted, kRounding);
    }
    EXPECT_GT(inside, 5);
}

TEST(Solid, IsInViewWithinTheAngleOfTheImagesCorner) {
    const Rig rig = habcam();
    const double corner_rad = std::atan(std::hypot(680.0, 512.0) * 6.45e-6 / 12e-3);
    const auto ball_at = [](double angle_rad) {
        return object_of(
            Sphere{.centre_m = {0.0, 2.0 * std::sin(angle_rad), 2.0 * std::cos(angle_rad)},
                   .radius_m = 0.1});
    };
    EXPECT_TRUE(may_be_in_view(rig, ball_at(0.0)));
    EXPECT_TRUE(may_be_in_view(rig, ball_at(corner_rad + 0.05)));
    EXPECT_FALSE(may_be_in_view(rig, ball_at(corner_rad + 0.1)));
    EXPECT_FALSE(may_be_in_view(rig, ball_at(3.0)));
}

TEST(Solid, IsLitByConesThatReachIt) {
    Strobe strobe = habcam().strobes.front();
    strobe.position_m = Vector3d::Zero();
    strobe.axis = Vector3d::UnitZ();
    const auto cone_of = [](double weight) {
        return Beam{.name = "",
                    .weights = ConeWeights::Flux,
                    .cones = {{.part = "cone", .half_angle_rad = 0.3, .weight = weight}}};
    };
    const auto ball_at = [](double angle_rad) {
        return object_of(
            Sphere{.centre_m = {2.0 * std::sin(angle_rad), 0.0, 2.0 * std::cos(angle_rad)},
                   .radius_m = 0.1});
    };
    EXPECT_TRUE(may_light(strobe, cone_of(1.0), ball_at(0.34)));
    EXPECT_FALSE(may_light(strobe, cone_of(1.0), ball_at(0.4)));
    EXPECT_FALSE(may_light(strobe, cone_of(0.0), ball_at(0.0)));
}

TEST(Solid, LeastThrowIsToTheFloorOrToANearerObjectInTheLight) {
    Rig rig = habcam();
    const Strobe& strobe = rig.strobes.front();
    const double floor_m = height_above(floor_plane(rig.sled), strobe.position_m);
    EXPECT_EQ(least_throw_m(rig, strobe, strobe.position_m), floor_m);
    const Sphere ball{.centre_m = {0.3, 0.0, 1.0}, .radius_m = 0.2};
    rig.objects = {object_of(ball)};
    EXPECT_EQ(least_throw_m(rig, rig.strobes.front(), strobe.position_m),
              (ball.centre_m - strobe.position_m).norm() - 0.2);
    rig.objects = {object_of(Sphere{.centre_m = {0.5, 0.0, -0.5}, .radius_m = 0.2})};
    EXPECT_EQ(least_throw_m(rig, rig.strobes.front(), strobe.position_m), floor_m) << "behind it";
}

}  // namespace
}  // namespace aphotic::solid_test
