// SPDX-License-Identifier: BSD-3-Clause
#include "light/floor_arrival.h"

#include "support/fit_rig.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace aphotic::floor_arrival_test {
namespace {

using Eigen::Vector3d;

constexpr double kRounding = 1e-14;

// Level, over a floor of a known highlight.
Rig rig_at(double altitude_m) {
    Rig rig = fit_rig({}).rig();
    rig.sled = {.altitude_m = altitude_m};
    rig.seafloor.phong = 0.5;
    rig.seafloor.phong_size = 3.0;
    return rig;
}

// An even beam of power pi.
Strobe strobe_at(const Vector3d& position_m) {
    Strobe strobe = fit_rig({}).rig().strobes.front();
    strobe.position_m = position_m;
    strobe.axis = Vector3d::UnitZ();
    strobe.power = std::numbers::pi;
    strobe.beam.weights = ConeWeights::Literal;
    strobe.beam.cones = {
        {.part = "all", .half_angle_rad = 0.5 * std::numbers::pi, .weight = 1.0, .exponent = 0.0}};
    return strobe;
}

TEST(FloorArrival, IsOneRightOverTheFloorAtAMetre) {
    const WaterRay down{.origin_m = Vector3d::Zero(), .direction = Vector3d::UnitZ()};
    const auto light =
        arrival_of(rig_at(1.0), strobe_at(Vector3d::Zero()), down, Vector3d::UnitZ());
    ASSERT_TRUE(light);
    EXPECT_NEAR(light->diffuse, 1.0, kRounding);
    EXPECT_NEAR(light->highlight, 0.5, kRounding);
    EXPECT_NEAR(light->path_m, 2.0, kRounding);
}

// The triangle of 3, 4 and 5: a lamp 3 m high and 4 m beside what the camera sees straight below.
TEST(FloorArrival, FallsWithTheCosineAndTheSquareOfTheDistance) {
    const WaterRay down{.origin_m = Vector3d::Zero(), .direction = Vector3d::UnitZ()};
    const auto light =
        arrival_of(rig_at(3.0), strobe_at({4.0, 0.0, 0.0}), down, Vector3d(0.0, 0.0, 3.0));
    ASSERT_TRUE(light);
    EXPECT_NEAR(light->diffuse, 0.6 / 25.0, kRounding);
    // Mirrored, the ray goes straight up, 0.6 of the way to the lamp.
    EXPECT_NEAR(light->highlight, 0.5 * std::pow(0.6, 3.0) / 25.0, kRounding);
    EXPECT_NEAR(light->path_m, 3.0 + 5.0, kRounding);
}

TEST(FloorArrival, IsNoneAboveTheHorizonAndOfALampInTheFloor) {
    const WaterRay up{.origin_m = Vector3d::Zero(), .direction = -Vector3d::UnitZ()};
    const WaterRay down{.origin_m = Vector3d::Zero(), .direction = Vector3d::UnitZ()};
    EXPECT_FALSE(arrival_of(rig_at(1.0), strobe_at(Vector3d::Zero()), up, Vector3d::UnitZ()));
    const auto below = arrival_of(rig_at(1.0), strobe_at({0.0, 0.0, 1.5}), down, Vector3d::UnitZ());
    ASSERT_TRUE(below);
    EXPECT_EQ(below->diffuse, 0.0);
}

}  // namespace
}  // namespace aphotic::floor_arrival_test
