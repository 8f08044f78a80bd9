// SPDX-License-Identifier: BSD-3-Clause
//
// The camera's pose on the vehicle, against rotation matrices written out by hand, rays traced to
// the floor, and closed forms.
#include "rig/vehicle_pose.h"

#include "base/error.h"
#include "support/dice.h"
#include "support/refusal.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <cmath>
#include <string>

namespace aphotic::vehicle_pose_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kRounding = 1e-12;  // of some tens of operations on numbers around 1

std::string fault_of(const Sled& vehicle, const Mounting& mounting) {
    return refusal_of([&] { return camera_pose(vehicle, mounting); });
}

TEST(VehiclePose, WithoutAMountingItIsTheCamerasToTheBit) {
    const Sled sled{2.0500001, 0.0837758, -0.00523599};
    const Sled same = camera_pose(sled, {});
    EXPECT_EQ(same.altitude_m, sled.altitude_m);
    EXPECT_EQ(same.pitch_rad, sled.pitch_rad);
    EXPECT_EQ(same.roll_rad, sled.roll_rad);
}

// HabCam at 2 m and 5 degrees is 1.992 m above its floor (docs/background/physics.md).
TEST(VehiclePose, AHeightIsCarriedToTheAxisByBothTilts) {
    const Sled sled{1.99239, 5.0 * kDegree, 0.0};
    constexpr double kDigits = 1e-5;  // as many as the height has
    for (const AltitudeIs is : {AltitudeIs::Plumb, AltitudeIs::Nearest}) {
        EXPECT_NEAR(camera_pose(sled, {.altitude_is = is}).altitude_m, 2.0, kDigits);
        const Sled tilted{3.0, 20.0 * kDegree, -30.0 * kDegree};
        EXPECT_NEAR(camera_pose(tilted, {.altitude_is = is}).altitude_m,
                    3.0 / (std::cos(20.0 * kDegree) * std::cos(30.0 * kDegree)),
                    kRounding);
    }
}

TEST(VehiclePose, TheOffsetIsAddedBefore) {
    const Sled sled{2.0, 60.0 * kDegree, 0.0};
    EXPECT_EQ(camera_pose(sled, {.altitude_offset_m = -0.25}).altitude_m, 1.75);
    const Mounting plumb{.altitude_is = AltitudeIs::Plumb, .altitude_offset_m = -0.25};
    EXPECT_NEAR(camera_pose(sled, plumb).altitude_m, 3.5, kRounding);
}

TEST(VehiclePose, ALeverAndATurnByHand) {
    const Sled level{2.0, 0.0, 0.0};
    const Mounting oblique{.position_m = {0.0, 0.0, 0.5},
                           .roll_pitch_yaw_rad = {0.0, 60.0 * kDegree, 0.0}};
    const Sled camera = camera_pose(level, oblique);
    EXPECT_NEAR(camera.altitude_m, 3.0, kRounding);
    EXPECT_NEAR(camera.pitch_rad, 60.0 * kDegree, kRounding);
    EXPECT_NEAR(camera.roll_rad, 0.0, kRounding);
    // Turned about the plumb line, what was the bow's tilt is the camera's roll: its right column
    // is aft, so the side that rises sinks.
    const Mounting turned{.roll_pitch_yaw_rad = {0.0, 0.0, 90.0 * kDegree}};
    const Sled sideways = camera_pose({2.0, 10.0 * kDegree, 0.0}, turned);
    EXPECT_NEAR(sideways.pitch_rad, 0.0, kRounding);
    EXPECT_NEAR(sideways.roll_rad, 10.0 * kDegree, kRounding);
    EXPECT_NEAR(sideways.altitude_m, 2.0, kRounding);
    // A metre ahead of the origin, bow up by 30 degrees: half a metre higher.
    const Mounting ahead{.altitude_is = AltitudeIs::Plumb, .position_m = {1.0, 0.0, 0.0}};
    EXPECT_NEAR(camera_pose({2.0, 30.0 * kDegree, 0.0}, ahead).altitude_m,
                2.5 / std::cos(30.0 * kDegree),
                kRounding);
}

// Bound east, its camera a metre ahead, half a metre to starboard, 0.2 m lower, and turned by a
// quarter: that is a metre east, half a metre south, and looks south. Unturned, nothing changes.
TEST(VehiclePose, APlaceIsTheCamerasByLeverAndHeading) {
    const Place vehicle{
        .east_m = 500000.0, .north_m = 100.0, .heading_rad = 90.0 * kDegree, .depth_m = 60.0};
    const Mounting mounting{.position_m = {1.0, 0.5, 0.2},
                            .roll_pitch_yaw_rad = {0.0, 0.0, 90.0 * kDegree}};
    const Place camera = camera_place(vehicle, {2.0, 0.0, 0.0}, mounting);
    constexpr double kOfUtm_m = 1e-9;
    EXPECT_NEAR(camera.east_m, 500001.0, kOfUtm_m);
    EXPECT_NEAR(camera.north_m, 99.5, kOfUtm_m);
    EXPECT_NEAR(camera.depth_m, 60.2, kOfUtm_m);
    EXPECT_NEAR(std::abs(camera.heading_rad), 180.0 * kDegree, kRounding);
    // Bow up by 30 degrees, what is ahead is half of it higher.
    const Place up =
        camera_place(vehicle, {2.0, 30.0 * kDegree, 0.0}, {.position_m = {1.0, 0.0, 0.0}});
    EXPECT_NEAR(up.east_m, 500000.0 + std::cos(30.0 * kDegree), kOfUtm_m);
    EXPECT_NEAR(up.depth_m, 59.5, kOfUtm_m);
    EXPECT_EQ(camera_place(vehicle, {2.0, 0.1, 0.2}, {}).heading_rad, vehicle.heading_rad);
    EXPECT_TRUE(std::isnan(camera_place({}, {2.0, 0.0, 0.0}, mounting).east_m));
}

// In the world: x north, y east, z down; the floor is z = 0, and the vehicle is turned by matrices
// that share nothing with the code but the sense of the angles.
TEST(VehiclePose, TheAxisMeetsTheFloorWhereMatricesSay) {
    const auto matrix = [](double roll, double pitch, double yaw) {
        Matrix3d x, y, z;
        x << 1, 0, 0, 0, std::cos(roll), -std::sin(roll), 0, std::sin(roll), std::cos(roll);
        y << std::cos(pitch), 0, std::sin(pitch), 0, 1, 0, -std::sin(pitch), 0, std::cos(pitch);
        z << std::cos(yaw), -std::sin(yaw), 0, std::sin(yaw), std::cos(yaw), 0, 0, 0, 1;
        return Matrix3d(z * y * x);
    };
    Dice dice(11);
    const auto angle = [&](double most_deg) { return dice.between(-most_deg, most_deg) * kDegree; };
    int seen = 0;
    for (int i = 0; i < 2000; ++i) {
        const Sled vehicle{dice.between(1.0, 5.0), angle(40.0), angle(40.0)};
        const Mounting mounting{.altitude_is = i % 2 == 0 ? AltitudeIs::Axis : AltitudeIs::Plumb,
                                .position_m = {dice.between(-0.5, 0.5),
                                               dice.between(-0.5, 0.5),
                                               dice.between(-0.5, 0.5)},
                                .roll_pitch_yaw_rad = {angle(60.0), angle(60.0), angle(180.0)}};
        const Matrix3d to_world = matrix(vehicle.roll_rad, vehicle.pitch_rad, angle(180.0));
        const Vector3d turn = mounting.roll_pitch_yaw_rad;
        const Matrix3d camera_to_world = to_world * matrix(turn.x(), turn.y(), turn.z());
        const double over_floor_m = i % 2 == 0
                                        ? vehicle.altitude_m * (to_world * Vector3d::UnitZ()).z()
                                        : vehicle.altitude_m;
        const Vector3d pupil = Vector3d(0, 0, -over_floor_m) + to_world * mounting.position_m;
        const Vector3d axis = camera_to_world * Vector3d::UnitZ();
        if (axis.z() <= 0.0 || pupil.z() >= 0.0) {
            EXPECT_NE(fault_of(vehicle, mounting), "nothing was said");
            continue;
        }
        ++seen;
        const Sled camera = camera_pose(vehicle, mounting);
        EXPECT_NEAR(camera.altitude_m / (-pupil.z() / axis.z()), 1.0, kRounding / axis.z());
        // Whatever the heading: the world's down, seen from the camera.
        const Vector3d down = camera_to_world.transpose() * Vector3d::UnitZ();
        const Vector3d told =
            matrix(camera.roll_rad, camera.pitch_rad, 0.3).transpose() * Vector3d::UnitZ();
        EXPECT_LT((down - told).norm(), kRounding / axis.z());
    }
    EXPECT_GT(seen, 1000);
}

TEST(VehiclePose, ACameraThatCannotSeeTheFloorIsRefusedWithItsNumbers) {
    EXPECT_EQ(
        fault_of({2.0, 15.0 * kDegree, 0.0}, {.roll_pitch_yaw_rad = {0.0, 80.0 * kDegree, 0.0}}),
        "the camera looks 5 degrees above the horizon; allowed: below it, to see the floor");
    EXPECT_EQ(fault_of({1.0, 0.0, 0.0}, {.position_m = {0.0, 0.0, 1.25}}),
              "the camera is 0.25 m below the floor: the vehicle's origin is 1 m above it, and the "
              "camera 1.25 m lower");
}

TEST(VehiclePose, ComesBackFromTheCamerasOwn) {
    Dice dice(9);
    for (int i = 0; i < 200; ++i) {
        const Mounting mounting{
            .altitude_is = static_cast<AltitudeIs>(dice.whole(0, 2)),
            .altitude_offset_m = dice.between(-0.5, 0.5),
            .position_m = {dice.between(-1.0, 1.0),
                           dice.between(-1.0, 1.0),
                           dice.between(-1.0, 1.0)},
            .roll_pitch_yaw_rad = {
                dice.between(-0.3, 0.3), dice.between(-0.3, 0.3), dice.between(-3.0, 3.0)}};
        const Sled vehicle{
            dice.between(3.0, 6.0), dice.between(-0.3, 0.3), dice.between(-0.3, 0.3)};
        for (const Mounting& one :
             {mounting, Mounting{.altitude_is = mounting.altitude_is, .altitude_offset_m = 0.1}}) {
            const Sled back = vehicle_pose(camera_pose(vehicle, one), one);
            EXPECT_NEAR(back.altitude_m, vehicle.altitude_m, 10.0 * kRounding);
            EXPECT_NEAR(back.pitch_rad, vehicle.pitch_rad, 10.0 * kRounding);
            EXPECT_NEAR(back.roll_rad, vehicle.roll_rad, 10.0 * kRounding);
        }
    }
}

}  // namespace
}  // namespace aphotic::vehicle_pose_test
