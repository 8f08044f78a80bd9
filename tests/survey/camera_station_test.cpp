// SPDX-License-Identifier: BSD-3-Clause
//
// Cameras over a slope, where they stand in closed form.
#include "survey/camera_station.h"

#include "rig/file/rig_reader.h"
#include "support/has.h"
#include "support/refusal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace aphotic::camera_station_test {
namespace {

using Eigen::Vector3d;

constexpr double kNorthSlope = 0.1;
constexpr double kEastSlope = -0.2;
constexpr double kMiddle_m = 103.0;  // the floor's depth in the middle
constexpr double kOfFloats_m = 2e-6;
const Place kPlace{.east_m = 500000.5, .north_m = 5000000.25, .heading_rad = 0.5, .depth_m = 100.5};
const ImageFile kImage{.source = "a.tif", .name = "a"};

double floor_m(const Vector3d& at_m) {
    return kMiddle_m + kNorthSlope * (at_m.x() - 5000000.0) + kEastSlope * (at_m.y() - 500000.0);
}

// Of 16 m each way, heights up.
Mesh slope() {
    Mesh mesh{.vertices_m = {}, .triangles = {{0, 1, 2}, {2, 1, 3}}};
    for (const double north_m : {4999992.0, 5000008.0})
        for (const double east_m : {499992.0, 500008.0})
            mesh.vertices_m.emplace_back(east_m, north_m, -floor_m({north_m, east_m, 0.0}));
    return mesh;
}

Survey survey_of(const Place& place, bool is_by_depth, AltitudeIs altitude_is = AltitudeIs::Axis) {
    Survey survey{.files = {kImage}, .camera = {}};
    survey.navigation.emplace(
        "nav.csv",
        std::vector<ImagePose>{{.image = "a.tif", .sled = {2.0, 0.1, -0.2}, .place = place}});
    survey.navigation->note({.mounting = {.altitude_is = altitude_is}});
    survey.depth = DepthMaps{.place = "reef.ply",
                             .mesh = FloorMesh{.scene = std::make_shared<const ReliefScene>(
                                                   slope(), ReliefAxes::EastNorthUp),
                                               .is_by_depth = is_by_depth}};
    return survey;
}

TEST(CameraStation, ByDepthIsWhereTheNavigationHasIt) {
    const CameraStation camera = station_of(survey_of(kPlace, true), kImage);
    EXPECT_EQ(camera.pupil_m, Vector3d(5000000.25, 500000.5, 100.5));
    EXPECT_EQ(camera.turn, turn_by({-0.2, 0.1, 0.5}));
}

// So far along its axis is the floor; or so high straight down as a level floor would be.
TEST(CameraStation, ByAltitudeIsAsHighOverTheMesh) {
    const CameraStation axis = station_of(survey_of(kPlace, false), kImage);
    const Vector3d met_m = axis.pupil_m + 2.0 * axis.turn.col(2);
    EXPECT_NEAR(met_m.z(), floor_m(met_m), kOfFloats_m);
    const CameraStation plumb = station_of(survey_of(kPlace, false, AltitudeIs::Plumb), kImage);
    EXPECT_NEAR(floor_m(plumb.pupil_m) - plumb.pupil_m.z(),
                2.0 * std::cos(0.1) * std::cos(0.2),
                kOfFloats_m);
}

std::string refusal(const Place& place, bool is_by_depth) {
    return refusal_of([&] { (void)station_of(survey_of(place, is_by_depth), kImage); });
}

TEST(CameraStation, WithoutAPlaceIsToldWhatIsNeeded) {
    EXPECT_TRUE(
        has(refusal({}, true),
            "nav.csv: found no east_m, north_m, heading_deg, depth_m for it; needed by --relief"));
    Place place = kPlace;
    place.depth_m = Place{}.depth_m;
    EXPECT_TRUE(has(refusal(place, true), "found no depth_m for it; needed by --relief"));
    EXPECT_EQ(refusal(place, false), kAccepted);
    place.east_m += 100.0;
    EXPECT_TRUE(has(refusal(place, false),
                    "it is at east 500100.5 m, north 5000000.2 m, where reef.ply has no floor; "
                    "allowed: east 499992.0 to 500008.0 m, north 4999992.0 to 5000008.0 m"));
}

std::string unseen(const Place& place, bool is_by_depth) {
    Survey survey = survey_of(place, is_by_depth);
    const Rig rig = read_rig(std::string(APHOTIC_SOURCE_DIR) + "/scenes/one-lamp.toml");
    survey.light.size = {rig.camera.width_px, rig.camera.height_px};
    survey.light.relief = std::make_shared<const ReliefMapMaker>(rig, LightmapOptions{});
    return refusal_of([&] { require_in_view(survey); });
}

TEST(CameraStation, AFlightThatSeesNothingIsToldBothBoxes) {
    EXPECT_EQ(unseen(kPlace, true), kAccepted);
    EXPECT_EQ(unseen(kPlace, false), kAccepted);
    EXPECT_TRUE(has(unseen({}, false), "--relief: no image is over it: nav.csv: found no east_m"));
    Place local = kPlace;
    local.east_m = 12.0;
    local.north_m = -3.0;
    EXPECT_TRUE(
        has(unseen(local, true),
            "reef.ply: no image sees it: found cameras at east 12.0 to 12.0 m, north -3.0 to "
            "-3.0 m, depth 100.5 to 100.5 m, and the mesh at east 499992.0 to 500008.0 m, north "
            "4999992.0 to 5000008.0 m, depth 100.6 to 105.4 m"));
    EXPECT_TRUE(has(unseen(local, false), "north -3.0 to -3.0 m, and the mesh"));
    Place under = kPlace;
    under.depth_m = -100.5;
    EXPECT_EQ(unseen(under, true), kAccepted);  // 200 m over it: another check tells
    under.depth_m = 110.0;
    EXPECT_TRUE(has(unseen(under, true), "no image sees it"));
}

}  // namespace
}  // namespace aphotic::camera_station_test
