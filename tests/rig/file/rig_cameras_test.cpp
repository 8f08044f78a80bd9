// SPDX-License-Identifier: BSD-3-Clause
//
// Rigs with two cameras, by what does not depend on who looks: heights over the floor, angles to
// it, distances between lamps, and a beam's light on a place in the world.
#include "rig/file/rig_cameras.h"

#include "base/error.h"
#include "rig/beam/beam.h"
#include "rig/geometry.h"
#include "rig/vehicle_pose.h"
#include "support/dice.h"
#include "support/has.h"
#include "support/refusal.h"
#include "support/scene_text.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace aphotic::rig_cameras_test {
namespace {

using Eigen::Vector3d;

constexpr double kRounding = 1e-12;

// A stereo pair; the second camera has a port of its own, and the place and angles of `second`.
std::string two_cameras(const std::string& second) {
    return replaced(
        read_text_file(APHOTIC_SOURCE_DIR "/tests/rig/file/stereo.toml"), "# SECOND", second);
}

Rig seen_by(const std::string& camera, const std::string& second) {
    return rig_of_camera(two_cameras(second), "stereo.toml", {}, camera).rig();
}

double height_of(const Rig& rig, const Vector3d& point_m) {
    const Plane floor = floor_plane(rig.sled);
    return (point_m - floor.point_m).dot(floor.normal);
}

TEST(RigCameras, TheFirstHasTheRigAsItIs) {
    const Rig rig = seen_by("port", "position_m = [0.1, 0.2, 0.05]");
    EXPECT_EQ(rig.camera.width_px, 40);
    EXPECT_FALSE(rig.camera.port);
    EXPECT_EQ(rig.strobes[0].position_m, Vector3d(0.5, 0.1, 0.02));
    EXPECT_EQ(rig.sled.altitude_m, 2.0);
    EXPECT_TRUE(has(rig.toml, "[camera]  # one of several"));
    EXPECT_FALSE(has(rig.toml, "starboard"));
}

// Beside it, all lamps are as far to the other side.
TEST(RigCameras, OneBesideItSeesTheLampsAsFarToTheOtherSide) {
    const Rig rig =
        seen_by("starboard", "position_m = [0.1, 0.2, 0.05]\norientation_deg = [2, 1, 0]");
    EXPECT_EQ(rig.camera.width_px, 60);
    EXPECT_TRUE(rig.camera.port);
    const Vector3d shift_m =
        turn_by({2.0 * kDegree, kDegree, 0.0}).transpose() * Vector3d(0, -0.4, 0);
    EXPECT_LT((rig.strobes[0].position_m - Vector3d(0.5, 0.1, 0.02) - shift_m).norm(), kRounding);
    EXPECT_LT((rig.strobes[1].axis - Vector3d(0.3, 0.1, 1.0).normalized()).norm(), kRounding);
    EXPECT_NEAR(rig.strobes[0].beam.turn_rad, 20.0 * kDegree, kRounding);
}

TEST(RigCameras, WhoeverLooksTheLampsAreInOnePlaceInTheWorld) {
    Dice dice(7);
    for (int trial = 0; trial < 20; ++trial) {
        const auto angle = [&] { return dice.between(-25.0, 25.0); };
        const Rig one = seen_by("port", "");
        const Rig other =
            seen_by("starboard",
                    fmt::format("position_m = [{}, {}, {}]\norientation_deg = [{}, {}, {}]",
                                dice.between(-0.3, 0.3),
                                dice.between(-0.3, 0.3),
                                dice.between(-0.3, 0.3),
                                angle(),
                                angle(),
                                8.0 * angle()));
        for (std::size_t s = 0; s < 2; ++s) {
            const Strobe& a = one.strobes[s];
            const Strobe& b = other.strobes[s];
            EXPECT_NEAR(height_of(one, a.position_m), height_of(other, b.position_m), kRounding);
            EXPECT_NEAR(a.axis.dot(floor_plane(one.sled).normal),
                        b.axis.dot(floor_plane(other.sled).normal),
                        kRounding);
            // Their light towards each other, which a wrong turn of the oval beam would change.
            EXPECT_NEAR(intensity_towards(a.beam,
                                          frame_about(a.axis),
                                          one.strobes[1 - s].position_m - a.position_m +
                                              Vector3d(floor_plane(one.sled).normal) * -1.5),
                        intensity_towards(b.beam,
                                          frame_about(b.axis),
                                          other.strobes[1 - s].position_m - b.position_m +
                                              Vector3d(floor_plane(other.sled).normal) * -1.5),
                        1e-9);
        }
        EXPECT_NEAR((one.strobes[0].position_m - one.strobes[1].position_m).norm(),
                    (other.strobes[0].position_m - other.strobes[1].position_m).norm(),
                    kRounding);
        EXPECT_NEAR(one.strobes[0].axis.dot(one.strobes[1].axis),
                    other.strobes[0].axis.dot(other.strobes[1].axis),
                    kRounding);
    }
}

// A key is set in the frame of the file, whoever looks: as if the file had said so.
TEST(RigCameras, SettingsAreThoseOfTheFile) {
    const std::string mounted = "position_m = [0.1, 0.2, 0.05]\norientation_deg = [2, 1, 30]";
    std::string edited = two_cameras(mounted);
    const auto replace = [&](const std::string& from, const std::string& to) {
        edited.replace(edited.find(from), from.size(), to);
    };
    replace("position_m = [0.5, 0.1, 0.02]", "position_m = [0.4, 0.3, 0.0]");
    replace("tilt_deg = 20.0", "tilt_deg = 12.0");
    replace("focal_length_mm = 8.0", "focal_length_mm = 9.0");
    const std::vector<RigSetting> settings{{"strobe.fore.position_m", "[0.4, 0.3, 0.0]"},
                                           {"strobe.fore.aim.tilt_deg", "12.0"},
                                           {"camera.focal_length_mm", "9.0"}};
    const Rig set =
        rig_of_camera(two_cameras(mounted), "stereo.toml", {}, "starboard", settings).rig();
    const Rig wanted = rig_of_camera(edited, "stereo.toml", {}, "starboard").rig();
    EXPECT_EQ(set.strobes[0].position_m, wanted.strobes[0].position_m);
    EXPECT_EQ(set.strobes[0].axis, wanted.strobes[0].axis);
    EXPECT_EQ(set.camera.focal_length_m, wanted.camera.focal_length_m);
    EXPECT_EQ(set.toml, wanted.toml);
    // And the result is a rig of the one camera, which keeps its name.
    EXPECT_EQ(rig_of_camera(set.toml, "starboard.toml", {}, "starboard").rig().digest, set.digest);
}

TEST(RigCameras, WhatCannotBeChosenIsRefused) {
    const std::string text = two_cameras("position_m = [0, 0.2, 0]\norientation_deg = [0, 0, 90]");
    const auto fault = [](const std::string& toml, const std::string& camera) {
        return refusal_of([&] { return rig_of_camera(toml, "stereo.toml", {}, camera); });
    };
    EXPECT_EQ(fault(text, "left"), "stereo.toml: found no camera 'left'; allowed: port, starboard");
    EXPECT_EQ(refusal_of([&] { return RigText(text, "stereo.toml", {}); }),
              "stereo.toml:7: camera: found 2 cameras; allowed: one of them, by --camera port or "
              "starboard");
    const std::string lamp = "name = \"aft\"\nemitter_mm = [100, 200]\n";
    std::string with_emitter = text;
    with_emitter.replace(text.find("name = \"aft\"\n"), 13, lamp);
    EXPECT_TRUE(has(fault(with_emitter, "starboard"), "strobe 'aft' has an emitter"));
    std::string alike = text;
    alike.replace(text.find("\"starboard\""), 11, "\"port\"");
    EXPECT_TRUE(has(fault(alike, "port"), "each with a name of its own"));
    // The port of the second camera behind the water: without that camera, no water would be left.
    const std::string port =
        "[camera.port]\nshape = \"flat\"\ndistance_mm = 20.0\nthickness_mm = "
        "10.0\nglass = \"bk7\"\n";
    std::string scattered = text;
    scattered.erase(scattered.find(port), port.size());
    scattered.insert(scattered.find("[seafloor]"), port);
    EXPECT_TRUE(has(fault(scattered, "port"), "found between the tables of a camera"));
}

}  // namespace
}  // namespace aphotic::rig_cameras_test
