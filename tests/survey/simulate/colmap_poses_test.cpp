// SPDX-License-Identifier: BSD-3-Clause
//
// Landmarks of the floor, as a scene would place them, seen by images of two poses: COLMAP's
// formulas on the text say at which pixel, and the reference tracer what that pixel shows.
#include "survey/simulate/colmap_poses.h"

#include "support/colmap_text.h"
#include "support/has.h"
#include "support/refusal.h"
#include "support/rendered.h"
#include "validation/tracer.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace aphotic::colmap_poses_test {
namespace {

using Eigen::Vector3d;

// Of metres: numbers are written with all digits, and a lens is inverted to 1e-14.
constexpr double kDigits_m = 1e-12;

const std::vector<Leg> kLegs{
    {.image = 1, .name = "000001", .sled = {.altitude_m = 2.0}},
    {.image = 2,
     .name = "000002",
     .sled = {.altitude_m = 1.5, .pitch_rad = 0.12, .roll_rad = -0.07}},
    {.image = 7, .name = "B", .sled = {.altitude_m = 3.2, .pitch_rad = -0.05, .roll_rad = 0.06}}};

// As scenes/survey/survey.pov puts its floor under the sled, in POV-Ray's left-handed frame, and
// from there into the rig's.
Vector3d in_sled(const Sled& sled, double starboard_m, double forward_m) {
    const double P = sled.pitch_rad;
    const double Q = sled.roll_rad;
    const Vector3d up(-std::cos(P) * std::sin(Q), std::sin(P), -std::cos(P) * std::cos(Q));
    const Vector3d forward = (Vector3d::UnitY() - up.y() * up).normalized();
    const Vector3d starboard = up.cross(forward);
    const Vector3d there_m =
        starboard_m * starboard + forward_m * forward + sled.altitude_m * Vector3d::UnitZ();
    return {there_m.y(), there_m.x(), there_m.z()};
}

void expect_landmarks_where_the_tracer_sees_them(const Rig& rig, const std::string& model) {
    const ColmapText colmap = read_colmap(colmap_cameras(rig.camera), colmap_images(kLegs, ".tif"));
    EXPECT_EQ(colmap.model, model);
    ASSERT_EQ(colmap.images.size(), kLegs.size());
    for (std::size_t i = 0; i < kLegs.size(); ++i) {
        const ColmapText::Image& image = colmap.images[i];
        EXPECT_EQ(image.name, kLegs[i].name + ".tif");
        Rig at_pose = rig;
        at_pose.sled = kLegs[i].sled;
        at_pose.strobes.clear();
        const Tracer tracer(at_pose, {.signals = false, .planes_nm = {}});
        for (const auto& [x_m, y_m] : {std::pair{0.05, 0.02}, {0.3, -0.2}, {-0.25, 0.11}}) {
            const Eigen::Vector2d pixel = colmap.pixel(image.in_camera({x_m, y_m, 0.0}));
            const auto seen = tracer.seen(pixel.x(), pixel.y(), 550.0);
            ASSERT_TRUE(seen);
            const Vector3d placed_m = in_sled(kLegs[i].sled, x_m, y_m);
            EXPECT_LT((seen->point_m - placed_m).norm(), kDigits_m)
                << image.name << ' ' << seen->point_m.transpose() << ", placed at "
                << placed_m.transpose();
        }
    }
}

TEST(ColmapPoses, ProjectTheFloorToItsPixels) {
    Rig rig = small_habcam();
    expect_landmarks_where_the_tracer_sees_them(rig, "PINHOLE");
    LensModel lens{.focal_px = {95.0, 94.0}, .centre_px = {35.0, 24.0}};
    rig.camera.lens = lens;
    expect_landmarks_where_the_tracer_sees_them(rig, "PINHOLE");
    lens.radial = {-0.2, 0.05, 0.0, 0.0};
    lens.tangential = {0.003, -0.002};
    rig.camera.lens = lens;
    expect_landmarks_where_the_tracer_sees_them(rig, "OPENCV");
    lens.radial[2] = -0.01;
    lens.radial_below = {0.1, -0.02, 0.005};
    rig.camera.lens = lens;
    expect_landmarks_where_the_tracer_sees_them(rig, "FULL_OPENCV");
    rig.camera.lens = LensModel{.focal_px = lens.focal_px,
                                .centre_px = lens.centre_px,
                                .is_fisheye = true,
                                .radial = {0.05, -0.01, 0.002, -0.001}};
    expect_landmarks_where_the_tracer_sees_them(rig, "OPENCV_FISHEYE");
}

// The header's limit: level, a half turn about x, the altitude over the world's origin.
TEST(ColmapPoses, OfALevelSledAreAHalfTurn) {
    EXPECT_TRUE(has(colmap_images(kLegs, ".tif"), "\n1 0 1 0 0 0 0 2 1 000001.tif\n\n2 "));
}

TEST(ColmapPoses, RefuseWhatColmapCannotSay) {
    Camera camera = small_habcam().camera;
    camera.lens = LensModel{.focal_px = {95.0, 95.0}, .centre_px = {34.0, 25.0}};
    const auto refused = [&](const LensModel& lens) {
        camera.lens = lens;
        return refusal_of([&] { require_colmap(camera, kLegs); });
    };
    LensModel lens = *camera.lens;
    EXPECT_EQ(refused(lens), kAccepted);
    lens.skew_px = 0.5;
    EXPECT_EQ(refused(lens), "found a skew of 0.5 pixels; allowed for COLMAP: none");
    lens.skew_px = 0.0;
    lens.radial[3] = 0.01;
    EXPECT_EQ(refused(lens), "found a lens with k4 0.01; allowed for COLMAP: none");
    lens.is_fisheye = true;
    EXPECT_EQ(refused(lens), kAccepted);
    lens.tangential[0] = 0.01;
    EXPECT_TRUE(refused(lens).starts_with("found a fisheye with tangential"));
    EXPECT_EQ(refusal_of([] {
                  require_colmap(small_habcam().camera, {{.image = 1, .name = "the only"}});
              }),
              "found an image named 'the only'; allowed for COLMAP: names without blanks");
}

// COLMAP does not know of the glass: the file says so.
TEST(ColmapPoses, SayThatAPortRefracts) {
    Camera camera = small_habcam().camera;
    const std::string open = colmap_cameras(camera);
    camera.port =
        PortWindow{.distance_m = 0.02, .thickness_m = 0.01, .glass = builtin_glass("bk7")};
    EXPECT_FALSE(has(open, "port"));
    EXPECT_TRUE(has(colmap_cameras(camera), "# The lens in air"));
}

}  // namespace
}  // namespace aphotic::colmap_poses_test
