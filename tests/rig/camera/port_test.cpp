// SPDX-License-Identifier: BSD-3-Clause
#include "rig/camera/port.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>

namespace aphotic::port_test {
namespace {

using Eigen::Vector3d;

constexpr double kRounding = 1e-15;

TEST(Port, NoneLeavesTheRayAsItIs) {
    const Vector3d in_air = Vector3d(0.3, 0.2, 1.0).normalized();
    const WaterRay ray = ray_into_water(std::nullopt, in_air, 550.0, 1.34);
    EXPECT_EQ(ray.origin_m, Vector3d::Zero());
    EXPECT_EQ(ray.direction, in_air);
    EXPECT_EQ(front_m(std::nullopt), 0.0);
}

// Snell, face by face: sin(air) = n_g sin(glass) = n_w sin(water).
TEST(Port, BendsAtBothFaces) {
    const Port port =
        PortWindow{.distance_m = 0.05, .thickness_m = 0.02, .glass = builtin_glass("bk7")};
    constexpr double kWaterIndex = 1.34;
    const double air_rad = 0.6;
    const double glass_rad = std::asin(std::sin(air_rad) / port->glass.index(500.0));
    const double water_rad = std::asin(std::sin(air_rad) / kWaterIndex);
    const WaterRay ray =
        ray_into_water(port, {0.0, std::sin(air_rad), std::cos(air_rad)}, 500.0, kWaterIndex);
    EXPECT_NEAR(ray.direction.y(), std::sin(water_rad), kRounding);
    EXPECT_NEAR(ray.direction.z(), std::cos(water_rad), kRounding);
    EXPECT_NEAR(ray.origin_m.y(), 0.05 * std::tan(air_rad) + 0.02 * std::tan(glass_rad), kRounding);
    EXPECT_NEAR(ray.origin_m.z(), 0.07, kRounding);
    EXPECT_NEAR(front_m(port), 0.07, kRounding);
}

// To the ray that a camera turned as far would send through the same port across its axis.
TEST(Port, ATiltedOneIsATurnedCamera) {
    PortWindow port{.distance_m = 0.05, .thickness_m = 0.02, .glass = builtin_glass("bk7")};
    const Vector3d in_air = Vector3d(0.31, -0.24, 1.0).normalized();
    const Eigen::AngleAxisd turn(0.2, Vector3d(0.6, 0.8, 0.0));
    const WaterRay across = ray_into_water(port, turn.inverse() * in_air, 550.0, 1.34);
    port.normal = turn * Vector3d::UnitZ();
    const WaterRay tilted = ray_into_water(port, in_air, 550.0, 1.34);
    EXPECT_LT((tilted.origin_m - turn * across.origin_m).norm(), kRounding);
    EXPECT_LT((tilted.direction - turn * across.direction).norm(), kRounding);
}

PortWindow dome(double radius_m, const Vector3d& centre_m) {
    PortWindow port{.thickness_m = 0.005, .glass = builtin_glass("bk7")};
    port.dome = Dome{.centre_m = centre_m, .radius_m = radius_m};
    return port;
}

TEST(Port, ACentredDomeBendsNothing) {
    const Vector3d in_air = Vector3d(0.5, -0.4, 1.0).normalized();
    const WaterRay ray = ray_into_water(dome(0.06, Vector3d::Zero()), in_air, 550.0, 1.34);
    EXPECT_LT((ray.direction - in_air).norm(), kRounding);
    EXPECT_LT((ray.origin_m - 0.065 * in_air).norm(), kRounding);
    EXPECT_NEAR(front_m(dome(0.06, Vector3d::Zero())), 0.065, kRounding);
}

// Of radius R a dome departs from a flat port by terms in 1/R.
TEST(Port, ALargeDomeIsAFlatPort) {
    constexpr double kDistance_m = 0.04;
    const Vector3d in_air = Vector3d(0.3, -0.2, 1.0).normalized();
    const PortWindow flat{
        .distance_m = kDistance_m, .thickness_m = 0.005, .glass = builtin_glass("bk7")};
    const WaterRay limit = ray_into_water(flat, in_air, 550.0, 1.34);
    for (const double radius_m : {1e2, 1e3, 1e4}) {
        const PortWindow large = dome(radius_m, {0.0, 0.0, kDistance_m - radius_m});
        const WaterRay ray = ray_into_water(large, in_air, 550.0, 1.34);
        EXPECT_LT((ray.direction - limit.direction).norm(), 0.1 / radius_m);
        EXPECT_LT((ray.origin_m - limit.origin_m).norm(), 0.01 / radius_m);
    }
}

// The invariant of spheres: n times the ray's distance from the centre.
TEST(Port, ADecentredDomeKeepsBouguersInvariant) {
    const Vector3d centre_m(0.004, -0.007, 0.011);
    const Vector3d in_air = Vector3d(0.3, -0.2, 1.0).normalized();
    const WaterRay ray = ray_into_water(dome(0.06, centre_m), in_air, 550.0, 1.34);
    EXPECT_NEAR((ray.origin_m - centre_m).norm(), 0.065, kRounding);
    EXPECT_NEAR(1.34 * (ray.origin_m - centre_m).cross(ray.direction).norm(),
                centre_m.cross(in_air).norm(),
                kRounding);
    EXPECT_NEAR(ray.direction.norm(), 1.0, kRounding);
    // All in one plane with the centre.
    EXPECT_NEAR(ray.direction.dot(centre_m.cross(in_air)), 0.0, kRounding);
}

TEST(Port, SignatureIsOfAllThatBendsRays) {
    const PortWindow port{.distance_m = 0.05, .thickness_m = 0.02, .glass = builtin_glass("bk7")};
    const std::string before = port_signature(port);
    for (const auto& change : {+[](PortWindow& p) { p.distance_m += 1e-12; },
                               +[](PortWindow& p) { p.thickness_m += 1e-12; },
                               +[](PortWindow& p) { p.glass = builtin_glass("sapphire"); },
                               +[](PortWindow& p) { p.normal = Vector3d(0.1, 0, 1).normalized(); },
                               +[](PortWindow& p) { p.dome = Dome{}; },
                               +[](PortWindow& p) { p.dome = Dome{.radius_m = 0.1}; },
                               +[](PortWindow& p) {
                                   p.dome = Dome{.centre_m = {0, 0, 1}};
                               }}) {
        PortWindow other = port;
        change(other);
        EXPECT_NE(port_signature(other), before);
    }
}

}  // namespace
}  // namespace aphotic::port_test
