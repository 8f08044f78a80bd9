// SPDX-License-Identifier: BSD-3-Clause
//
// A rig of millimetres: a wall 2 mm wide and 0.3 mm thick, on a floor 1 cm below the camera, lit
// from the side. POV-Ray passes over blockers within a thousandth of its unit of what they shade,
// so in metres the wall would cast no shadow at its own foot.
#include "scene_gen/pov_scene.h"

#include "support/rendered.h"
#include "validation/tracer.h"

namespace aphotic::scene_unit_test {
namespace {

constexpr double kLambda_nm = 550.0;
// Pixels whose centre is on the edge of the wall or of its shadow, at 0.16 mm a pixel.
constexpr int kOnEdges = 4;
// Lit and in the shadow differ by all of the light, the half floats by less than this.
constexpr double kLitOrNot = 0.01;

Rig millimetres() {
    Rig rig = small_habcam(43, 32);
    rig.sled = {.altitude_m = 0.01, .pitch_rad = 0.0, .roll_rad = 0.0};
    rig.strobes.erase(rig.strobes.begin() + 1, rig.strobes.end());
    rig.strobes[0].position_m = {0.02, 0.001, 0.005};
    rig.strobes[0].axis = Eigen::Vector3d(-1.0, 0.0, 0.2).normalized();
    rig.objects.push_back(
        {.name = "wall",
         .shape = Box{.least_m = {-0.00015, -0.001, 0.0085}, .most_m = {0.00015, 0.001, 0.01}},
         .reflectance = rig.seafloor.reflectance});
    return rig;
}

// Pixels that POV-Ray shows otherwise than the tracer does.
int pixels_off(const Rig& rig, const SceneSet& set) {
    const TempFolder folder;
    const Manifest manifest =
        render(find_povray(""), folder.path(), set, {.jobs = 2, .report = {}}).manifest;
    const PlannedWavelength& w = manifest.wavelengths[0];
    const Tracer tracer(rig, {.signals = false, .planes_nm = {kLambda_nm}});
    const std::vector<double> traced = tracer.rows(0, rig.camera.height_px);
    std::vector<float> samples(traced.size());
    ExrReader frame(image_path(folder.path(), manifest.frames[w.frame]));
    const std::string channel(kChannelNames[w.channel]);
    frame.read_rows(0, rig.camera.height_px, std::span(&channel, 1), samples);
    const double brightest = std::ldexp(std::ranges::max(traced), w.exposure_log2);
    int off = 0;
    for (std::size_t i = 0; i < traced.size(); ++i) {
        const double expected = std::ldexp(traced[i], w.exposure_log2);
        if (std::abs(samples[i] - expected) > kLitOrNot * brightest) ++off;
    }
    return off;
}

TEST(SceneUnit, IsMetresForSledsAndAPowerOfTwoForMillimetres) {
    EXPECT_EQ(scene_unit_m(small_habcam()), 1.0);
    const double unit_m = scene_unit_m(millimetres());
    EXPECT_LE(unit_m, 0.002);  // the least distance: the wall's largest side
    EXPECT_GT(unit_m, 0.001);
    int exponent = 0;
    EXPECT_EQ(std::frexp(unit_m, &exponent), 0.5);
}

TEST(SceneUnit, AWallOfMillimetresCastsItsShadow) {
    const Rig rig = millimetres();
    EXPECT_LE(pixels_off(rig, scenes_of(rig, {kLambda_nm})), kOnEdges);
}

TEST(SceneUnit, InMetresTheShadowIsLost) {
    const Rig rig = millimetres();
    SceneSet set = scenes_of(rig, {kLambda_nm});
    std::string& sdl = set.scenes[0].sdl;
    sdl = replaced(sdl, "#declare Aphotic_Unit = ", "#declare Unused = ");
    EXPECT_GT(pixels_off(rig, set), 5 * kOnEdges);
}

}  // namespace
}  // namespace aphotic::scene_unit_test
