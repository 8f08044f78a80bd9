// SPDX-License-Identifier: BSD-3-Clause
//
// What is planned of a veil by POV-Ray, against the quadrature of light/veil.h and closed forms;
// tests/plugin/povray_veil_test.cpp renders it.
#include "scene_gen/povray_veil.h"

#include "base/atomic_file.h"
#include "rig/file/rig_reader.h"
#include "scene_gen/pov_scene.h"
#include "scene_gen/render_plan.h"
#include "scene_gen/scene_set.h"
#include "support/temp_folder.h"
#include "support/veil_rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <regex>

namespace aphotic::povray_veil_test {
namespace {

const PhaseFunction kForward{.name = "forward", .kind = HenyeyGreenstein{.g = 0.924}};

Rig with_smooth_beams(Rig rig) {
    for (Strobe& strobe : rig.strobes) {
        strobe.beam.cones = {{.part = "all",
                              .half_angle_rad = 0.5 * std::numbers::pi,
                              .weight = 1.0,
                              .exponent = 4.0}};
    }
    return rig;
}

RenderPlan planned(const Rig& rig, std::optional<int> samples) {
    PlanRequest request;
    request.scene.veil_samples = samples;
    return plan_render(rig, request);
}

double error_of(const Rig& rig, int samples) {
    return planned(rig, samples).scene.povray_veil->error;
}

// The midpoint rule's.
TEST(PovrayVeil, IsOffByTheSecondOrderOfItsSamples) {
    constexpr double kOrder = 4.0;
    constexpr double kNearly = 0.2;
    for (const Rig& rig : {with_particles(habcam(), kForward),
                           with_smooth_beams(with_particles(habcam(), kForward))}) {
        const double coarse = error_of(rig, 40);
        const double fine = error_of(rig, 80);
        EXPECT_NEAR(coarse / fine, kOrder, kNearly * kOrder) << coarse << " " << fine;
        EXPECT_LE(error_of(rig, 100), 1e-3);
    }
}

// Light that goes d from the lamp to a point of the ray, t on to the camera, is turned by psi.
TEST(PovrayVeil, TakesItsSamplesWhereTheyLie) {
    Rig rig = with_smooth_beams(with_particles(habcam(), kForward));
    rig.strobes.erase(rig.strobes.begin() + 1, rig.strobes.end());
    const std::vector<LampGrid> lamps(1);
    const WaterRay ray{.origin_m = {0.0, 0.0, 0.0}, .direction = {0.0, 0.0, 1.0}};
    constexpr double kLength_m = 2.0;
    const MediaSampling one{.lobes = {kForward}, .samples = 1, .sight_m = 10.0, .most_m = 100.0};
    const VeilNodes middle = media_samples(rig, lamps, one, ray, kLength_m).front();
    ASSERT_EQ(middle.path_m.size(), 1U);
    const Eigen::Vector3d towards = Eigen::Vector3d(0.0, 0.0, 1.0) - rig.strobes[0].position_m;
    const double d_m = towards.norm();
    EXPECT_DOUBLE_EQ(middle.path_m.front(), 1.0 + d_m);
    const double psi_rad = std::acos(-towards.z() / d_m);
    const double cosine = rig.strobes[0].axis.dot(towards) / d_m;
    const double on_axis = 5.0 / (2.0 * std::numbers::pi);  // of cos^4 over the half space
    EXPECT_NEAR(middle.weight.front().front(),
                kLength_m * on_axis * std::pow(cosine, 4) * kForward.at(psi_rad) / (d_m * d_m),
                1e-12);
}

// Nothing of it is in water that does not scatter.
TEST(PovrayVeil, ChangesNothingInWaterThatDoesNotScatter) {
    const Rig rig = habcam();
    const SceneSet with = make_scene_set(rig, planned(rig, kVeilSamples));
    const SceneSet without = make_scene_set(rig, planned(rig, std::nullopt));
    ASSERT_EQ(with.scenes.size(), without.scenes.size());
    for (std::size_t f = 0; f < with.scenes.size(); ++f) {
        EXPECT_EQ(with.scenes[f].sdl, without.scenes[f].sdl);
        EXPECT_EQ(with.manifest.frames[f].scene_sha256, without.manifest.frames[f].scene_sha256);
    }
    EXPECT_FALSE(with.manifest.veil);
}

// Whose frames the same folder keeps, whatever makes the veil.
TEST(PovrayVeil, LeavesTheFramesOfTheDirectLightAsTheyAre) {
    const Rig rig = with_particles(habcam(), kForward);
    PlanRequest request;
    request.wavelengths_nm = {450.0, 520.0, 600.0, 680.0};
    const SceneSet without = make_scene_set(rig, plan_render(rig, request));
    request.scene.veil_samples = kVeilSamples;
    const SceneSet with = make_scene_set(rig, plan_render(rig, request));
    ASSERT_EQ(without.scenes.size(), 2U);
    ASSERT_EQ(with.scenes.size(), 4U);
    for (std::size_t f = 0; f < 2; ++f) EXPECT_EQ(with.scenes[f].sdl, without.scenes[f].sdl);
    EXPECT_EQ(with.manifest.direct_frames(), 2U);
}

// Which differ more than the direct light's.
TEST(PovrayVeil, HasWavelengthsEnoughForItsPaths) {
    const TempFolder folder;
    std::string text = read_text_file(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam.toml");
    text = std::regex_replace(text, std::regex("absorption = .*"), "type = \"jerlov-1C\"");
    text = std::regex_replace(text, std::regex(R"(\[400, 720\])"), "[400, 700]");
    write_text_file(folder.path() / "rig.toml", text);
    const Rig rig = read_rig(folder.path() / "rig.toml");
    const RenderPlan plan = planned(rig, kVeilSamples);
    EXPECT_GE(plan.wavelengths.size(), planned(rig, std::nullopt).wavelengths.size());
    EXPECT_LE(worst_error(plan.scene.povray_veil->quality), 1e-3);
    EXPECT_TRUE(plan.no_promise.empty());
    for (std::size_t c = 0; c < kChannels; ++c)
        EXPECT_GE(plan.quality[c].error, plan.scene.povray_veil->error);
}

// POV-Ray's samples of their shadows have no bound.
TEST(PovrayVeil, HasNoPromiseWithObjects) {
    Rig rig = with_particles(habcam(), kForward);
    rig.objects.push_back({.name = "ball",
                           .shape = Sphere{.centre_m = {0.3, 0.2, 1.2}, .radius_m = 0.25},
                           .reflectance = Spectrum("grey", {300.0, 900.0}, {0.4, 0.4})});
    EXPECT_EQ(planned(rig, kVeilSamples).no_promise.size(), 1U);
    EXPECT_TRUE(planned(rig, std::nullopt).no_promise.empty());
}

}  // namespace
}  // namespace aphotic::povray_veil_test
