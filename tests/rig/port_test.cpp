// SPDX-License-Identifier: BSD-3-Clause
#include "rig/port.h"

#include <gtest/gtest.h>

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

TEST(Port, SignatureIsOfAllThatBendsRays) {
    const PortWindow port{.distance_m = 0.05, .thickness_m = 0.02, .glass = builtin_glass("bk7")};
    const std::string before = port_signature(port);
    for (const auto& change : {+[](PortWindow& p) { p.distance_m += 1e-12; },
                               +[](PortWindow& p) { p.thickness_m += 1e-12; },
                               +[](PortWindow& p) { p.glass = builtin_glass("sapphire"); }}) {
        PortWindow other = port;
        change(other);
        EXPECT_NE(port_signature(other), before);
    }
}

}  // namespace
}  // namespace aphotic::port_test
