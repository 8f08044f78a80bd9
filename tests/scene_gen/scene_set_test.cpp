// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/scene_set.h"

#include "base/error.h"
#include "support/has.h"
#include "support/refusal.h"
#include "support/scene_rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace aphotic::scene_set_test {
namespace {

Rig habcam_in(double multiple) {
    Rig rig = habcam();
    rig.water.multiple = multiple;
    return rig;
}

// HabCam over so many times the absorption, in frames of red, green and blue light.
RenderPlan plan_in(double multiple) {
    PlanRequest request;
    request.wavelengths_nm = {450.0, 550.0, 650.0};
    return plan_render(habcam_in(multiple), request);
}

std::string refusal_of(double multiple, const RenderPlan& plan) {
    return aphotic::refusal_of(
        [&] { static_cast<void>(make_scene_set(habcam_in(multiple), plan)); });
}

// POV-Ray's colours are floats, so no exposure lifts red out of such water.
TEST(SceneSet, RefusesLightThatFramesDoNotHoldAndThatCounts) {
    RenderPlan plan = plan_in(100.0);
    plan.wavelengths.back().weight = {1e57, 0.0, 0.0};
    const std::string refusal = refusal_of(100.0, plan);
    EXPECT_TRUE(refusal.starts_with("found light of at most ")) << refusal;
    EXPECT_TRUE(has(
        refusal, " at 650 nm, fainter than frames can hold, which counts in R with a weight of "));
}

// A plan gives it no weight and says what that costs.
TEST(SceneSet, TakesEveryPlan) {
    for (const double multiple : {0.0, 1.0, 50.0, 60.0, 100.0, 230.0, 1e3}) {
        const RenderPlan plan = plan_in(multiple);
        EXPECT_EQ(refusal_of(multiple, plan), kAccepted) << multiple;
        if (multiple < 50.0) continue;
        EXPECT_EQ(plan.wavelengths.back().weight[0], 0.0) << multiple;
        EXPECT_GT(plan.promise(), 1e-3) << multiple;
    }
}

// A black image is an answer.
TEST(SceneSet, TakesWaterThatNoLightComesThrough) {
    for (const double multiple : {1e4, 1e6}) {
        EXPECT_EQ(refusal_of(multiple, plan_in(multiple)), kAccepted);
    }
}

// Light that is fainter than frames hold.

constexpr double kFrameError = 5e-4;
constexpr int kMostExposureOfColours_log2 = 100;  // about what POV-Ray's floats leave

// Green in view, and red that is 2^red_log2 as bright and makes as much signal as green, or a share
// of it.
std::vector<PlannedWavelength> green_and_red(int red_log2, double share = 1.0) {
    const PlannedWavelength green{
        .lambda_nm = 550.0, .weight = {1.0, 1.0, 0.0}, .exposure_log2 = 13, .radiance_bound = 1.0};
    const PlannedWavelength red{
        .lambda_nm = 650.0,
        .weight = {std::ldexp(share, -red_log2), 0.0, 0.0},
        .exposure_log2 = std::min(13 - red_log2, kMostExposureOfColours_log2),
        .radiance_bound = std::ldexp(1.0, red_log2)};
    return {green, red};
}

std::string refusal_of(const std::vector<PlannedWavelength>& wavelengths) {
    return aphotic::refusal_of([&] { require_light_that_counts(wavelengths, kFrameError); });
}

// 2^-114 is held as 2^-14, the last with all digits.
TEST(LostLight, IsBelowTheLeastNormalHalfFloat) {
    EXPECT_EQ(refusal_of(green_and_red(-114)), kAccepted);
    EXPECT_EQ(
        refusal_of(green_and_red(-115)),
        "found light of at most 2.4e-35 at 650 nm, fainter than frames can hold, which counts in R "
        "with a weight of 4.2e+34; allowed: wavelengths that frames can hold, or of no weight");
}

TEST(LostLight, IsNoMatterWhereItCountsForNothing) {
    EXPECT_EQ(refusal_of(green_and_red(-200, 0.9 * kFrameError)), kAccepted);
    EXPECT_NE(refusal_of(green_and_red(-200, 1.1 * kFrameError)), kAccepted);
    EXPECT_EQ(refusal_of(green_and_red(-200, 0.0)), kAccepted);
}

// A sign makes no difference: what is subtracted and lost is lost as well.
TEST(LostLight, CountsByTheSizeOfItsWeight) {
    std::vector<PlannedWavelength> wavelengths = green_and_red(-200);
    wavelengths[1].weight[0] *= -1.0;
    EXPECT_NE(refusal_of(wavelengths), kAccepted);
}

TEST(LostLight, IsABlackImageWhereNothingIsHeld) {
    std::vector<PlannedWavelength> wavelengths = green_and_red(-200);
    wavelengths[0].weight = {};
    EXPECT_EQ(refusal_of(wavelengths), kAccepted);
    for (PlannedWavelength& w : wavelengths) w.radiance_bound = 0.0;
    EXPECT_EQ(refusal_of(wavelengths), kAccepted);
}

// POV-Ray looks a ray up by its place in the image, and not left of a tenth before it.
TEST(SceneSet, OfALensHasTwoColumnsAndMore) {
    for (const auto& [antialias, least_px] : {std::pair{0, 2}, {3, 5}}) {
        for (const int width_px : {least_px - 1, least_px}) {
            Rig rig = habcam_in(1.0);
            rig.camera.width_px = width_px;
            rig.camera.height_px = 3;
            rig.camera.lens = LensModel{.focal_px = {9.0, 9.0}, .centre_px = {1.0, 1.5}};
            PlanRequest request;
            request.wavelengths_nm = {550.0};
            request.scene.antialias = antialias;
            if (width_px == least_px) {
                EXPECT_NO_THROW(static_cast<void>(plan_render(rig, request)));
            } else {
                EXPECT_THROW(static_cast<void>(plan_render(rig, request)), InputError) << width_px;
            }
        }
    }
}

// Frames are kept while their scene is the same, and a lens's rays are in a file of their own.
TEST(SceneSet, OfAnotherLensHasOtherScenes) {
    PlanRequest request;
    request.wavelengths_nm = {550.0};
    Rig rig = habcam_in(1.0);
    const double focal_px = rig.camera.focal_length_m / rig.camera.pixel_pitch_m;
    rig.camera.lens =
        LensModel{.focal_px = {focal_px, focal_px},
                  .centre_px = {0.5 * rig.camera.width_px, 0.5 * rig.camera.height_px}};
    const auto digest = [&] {
        return make_scene_set(rig, plan_render(rig, request)).manifest.frames[0].scene_sha256;
    };
    const std::string first = digest();
    EXPECT_EQ(digest(), first);
    rig.camera.lens->tangential[1] = 1e-6;
    EXPECT_NE(digest(), first);
}

}  // namespace
}  // namespace aphotic::scene_set_test
