// SPDX-License-Identifier: BSD-3-Clause
//
// Ranges by POV-Ray's fog, in closed form and against the reference tracer.
#include "plugin/range_render.h"

#include "base/error.h"
#include "support/cast_ray.h"
#include "support/colmap_text.h"
#include "support/exr_file.h"
#include "support/random_camera.h"
#include "support/refusal.h"
#include "support/rendered.h"
#include "survey/simulate/colmap_poses.h"
#include "validation/tracer.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace aphotic::range_render_test {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

// What the header says of a 16-bit PNG, and as much again as a hundredth for floats' rounding.
double png_error_m(double way_m, double fog_m) {
    return 1.01 * 0x1p-17 * fog_m * std::exp(way_m / fog_m);
}

// A world of a plane, a ball and a block, which survey.pov's own transform puts under the sled. Its
// textures are of all kinds, and it calls no Aphotic_Water.
constexpr const char* kWorld = R"(#version 3.7;
#include "aphotic.inc"
Aphotic_Rig_Camera ()
Aphotic_Rig_Strobes ()
#declare P = radians(Survey_Pitch);
#declare Q = radians(Survey_Roll);
#declare Up = <-cos(P) * sin(Q), sin(P), -cos(P) * cos(Q)>;
#declare Forward = vnormalize(y - vdot(y, Up) * Up);
#declare Starboard = vcross(Up, Forward);
union {
   plane { y, 0 pigment { checker Aphotic_Pigment ("sand") rgb 0 scale 0.1 } }
   sphere { <0.3, 0.1, 0.2>, Radius pigment { rgb <1, 0, 0.2> } finish { Aphotic_Finish (0.5, 20) } }
   box { <-0.4, -0.1, -0.3>, <-0.1, 0.25, 0.1> pigment { Aphotic_Pigment ("any") } finish { Glow } }
   transform {
      matrix <Starboard.x, Starboard.y, Starboard.z, Up.x, Up.y, Up.z,
              Forward.x, Forward.y, Forward.z, 0, 0, Survey_Altitude>
   }
}
)";
// The same; x to starboard, y forward, z up.
const CastScene kCastWorld{.ball = {.centre_m = {0.3, 0.2, 0.1}, .radius_m = 0.15},
                           .block = {.least_m = {-0.4, -0.3, -0.1}, .most_m = {-0.1, 0.1, 0.25}}};

class SceneRanges : public testing::Test {
  protected:
    void write_scene(std::string scene, const std::string& glow = "emission 0") {
        write_file(folder_.path() / "reef.pov", replaced(std::move(scene), "Glow", glow));
    }
    std::vector<float> ranges(const Rig& rig, const Leg& leg) {
        const fs::path image = folder_.path() / (leg.name + ".exr");
        render_ranges(
            find_povray(""),
            folder_.path() / "ranges",
            {.rig = rig, .scene = folder_.path() / "reef.pov", .declared = {"Radius=0.15"}},
            {{.number = leg.image, .sled = leg.sled, .image = image}},
            {.jobs = 2, .report = {}});
        return read_exr(image, {"Z"});
    }

    TempFolder folder_;
};

// Two images of one world: every pixel's depth is that of the world's plane, ball and block in
// closed form, seen along COLMAP's ray from COLMAP's place.
TEST_F(SceneRanges, AreThoseOfOneWorldByColmapsPoses) {
    write_scene(kWorld);
    const Rig rig = small_habcam();
    const std::vector<Leg> legs{{.image = 1,
                                 .name = "000001",
                                 .sled = {.altitude_m = 2.0, .pitch_rad = 0.07, .roll_rad = -0.05}},
                                {.image = 2,
                                 .name = "000002",
                                 .sled = {.altitude_m = 1.3, .pitch_rad = -0.1, .roll_rad = 0.09}}};
    const ColmapText colmap = read_colmap(colmap_cameras(rig.camera), colmap_images(legs, ".tif"));
    for (std::size_t n = 0; n < legs.size(); ++n) {
        const std::vector<float> z = ranges(rig, legs[n]);
        const ColmapText::Image& image = colmap.images.at(n);
        std::array<int, 3> of{};  // pixels by the height of what they show
        for (std::size_t i = 0; i < z.size(); ++i) {
            const auto& p = colmap.parameters;
            const Vector3d along((static_cast<double>(i % 68) + 0.5 - p[2]) / p[0],
                                 (static_cast<double>(i / 68) + 0.5 - p[3]) / p[1],
                                 1.0);
            const Vector3d from_m = image.centre_m();
            const Vector3d turned = image.turn.transpose() * along;
            const CastHit hit = cast_ray(kCastWorld, from_m, turned);
            const double way_m = hit.way * along.norm();
            ASSERT_NEAR(z[i], hit.way, png_error_m(way_m, legs[n].sled.altitude_m))
                << legs[n].name << ' ' << i;
            ++of.at(hit.normal == Vector3d::UnitZ() && (from_m + hit.way * turned).z() < 1e-9 ? 0
                    : std::abs(hit.normal.cwiseAbs().maxCoeff() - 1.0) < 1e-12                ? 1
                                                                                              : 2);
        }
        for (const int pixels : of) EXPECT_GT(pixels, 20) << "the world is in view";
    }
}

// Through lenses, whose rays POV-Ray interpolates, and ports, which are glass to it. The rig's own
// floor and objects stand in for a user's.
TEST_F(SceneRanges, AreTheReferencesThroughLensesAndPorts) {
    write_scene(
        "#include \"aphotic.inc\"\nAphotic_Rig ()\nAphotic_Rig_Seafloor ()\n"
        "Aphotic_Rig_Objects ()\n#declare F = finish { Glow }\n");
    // A ray that is off by kEdgeThroughLensRad meets a floor 35 degrees aslant, or a ball up to 80,
    // so much nearer or farther.
    constexpr double kAslant = 6.0;
    constexpr int kOutlinePixels = 3;  // of 3468
    for (std::size_t k = 0; k < kPortKinds.size(); ++k) {
        Dice dice(k);
        Rig rig = small_habcam();
        rig.sled.pitch_rad = 0.1;
        give_lens(kLensKinds.at(k), dice, rig.camera);
        give_port(kPortKinds.at(k), dice, rig.camera);
        rig.objects = {{.name = "ball",
                        .shape = Sphere{.centre_m = {0.1, 0.2, 1.7}, .radius_m = 0.15},
                        .reflectance = rig.seafloor.reflectance}};
        const std::vector<float> z = ranges(
            rig,
            {.image = static_cast<int>(k) + 1, .name = fmt::format("{}", k), .sled = rig.sled});
        rig.strobes.clear();
        const Tracer tracer(rig, {.signals = false, .planes_nm = {}});
        const double middle_nm = 0.5 * (rig.camera.range.first_nm + rig.camera.range.last_nm);
        int off = 0;
        std::size_t balls = 0;
        for (std::size_t i = 0; i < z.size(); ++i) {
            const auto seen = tracer.seen(
                static_cast<double>(i % 68) + 0.5, static_cast<double>(i / 68) + 0.5, middle_nm);
            ASSERT_TRUE(seen);
            const double way_m = seen->point_m.norm();
            const double error_m =
                png_error_m(way_m, rig.sled.altitude_m) + kAslant * kEdgeThroughLensRad * way_m;
            if (!(std::abs(z[i] - seen->point_m.z()) <= error_m)) ++off;
            balls += seen->surface;
        }
        EXPECT_GT(balls, 50U);
        EXPECT_LE(off, kOutlinePixels) << "lens and port " << k;
    }
}

// Beyond eight altitudes a range would be known to 0.3 % and less: it is not told, nor is the
// sky's.
TEST_F(SceneRanges, AreUnknownFarAway) {
    const Rig rig = small_habcam();
    write_scene(replaced(kWorld, "Survey_Altitude>", "2>"));
    const std::vector<float> z =
        ranges(rig, {.image = 1, .name = "far", .sled = {.altitude_m = 0.24}});
    std::array<int, 2> pixels{};
    for (const float sample : z) {
        ++pixels.at(std::isnan(sample) ? 1 : 0);
        EXPECT_FALSE(sample > 8.0 * 0.24) << "the plane is at 2 m, the block's top at 1.75";
    }
    EXPECT_GT(pixels[0], 100);
    EXPECT_GT(pixels[1], 2000);
}

// A mirror 1 m below the camera shows a ceiling 0.5 m above it: Z = 1 m + 1.5 m. One that gives
// back half, or a pane, is no range that a ray goes.
TEST_F(SceneRanges, OfAMirrorAreThoseOfWhatItShows) {
    write_scene(
        "#include \"aphotic.inc\"\nAphotic_Rig ()\nplane { z, -0.5 pigment { rgb 1 } }\n"
        "box { <-9, -9, 1>, <0, 9, 2> pigment { rgb 0 } finish { reflection 1 } }\n"
        "box { <0, -9, 1>, <9, 9, 2> pigment { rgb 0 } finish { reflection 0.5 Glow } }\n");
    const std::vector<float> z =
        ranges(small_habcam(), {.image = 1, .name = "mirror", .sled = {.altitude_m = 2.0}});
    for (std::size_t i = 0; i < z.size(); ++i) {
        if (i % 68 < 34) {
            ASSERT_NEAR(z[i], 2.5, png_error_m(3.2, 2.0)) << i;
        } else {
            ASSERT_GT(z[i], 1.1) << i;
            ASSERT_LT(z[i], 2.4) << i;
        }
    }
}

// It would add to ours; what it has in green and blue gives it away.
TEST_F(SceneRanges, RefuseAFogOfTheScenesOwn) {
    write_scene(
        "#include \"aphotic.inc\"\nAphotic_Rig ()\nAphotic_Rig_Seafloor ()\n"
        "fog { distance 10 rgb 0.3 }\n#declare F = finish { Glow }\n");
    EXPECT_TRUE(has(refusal_of([&] {
                        static_cast<void>(
                            ranges(small_habcam(),
                                   {.image = 1, .name = "fog", .sled = {.altitude_m = 2.0}}));
                    }),
                    "found light with all strobes off"));
}

TEST_F(SceneRanges, RefuseWhatShines) {
    write_scene(kWorld, "emission 0.001");
    EXPECT_TRUE(has(refusal_of([&] {
                        static_cast<void>(
                            ranges(small_habcam(),
                                   {.image = 3, .name = "lit", .sled = {.altitude_m = 2.0}}));
                    }),
                    "reef.pov: found light with all strobes off, at column "));
    EXPECT_FALSE(fs::exists(folder_.path() / "lit.exr"));
}

}  // namespace
}  // namespace aphotic::range_render_test
