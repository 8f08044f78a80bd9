// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/scene_set.h"

#include "base/error.h"
#include "rig/rig_reader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace aphotic::scene_set_test {
namespace {

Rig habcam_in(double multiple) {
    Rig rig = read_rig(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam.toml");
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
    try {
        static_cast<void>(make_scene_set(habcam_in(multiple), plan));
        return "none";
    } catch (const InputError& error) {
        return error.what();
    }
}

// POV-Ray's colours are floats, so no exposure lifts red out of such water.
TEST(SceneSet, RefusesLightThatFramesDoNotHoldAndThatCounts) {
    RenderPlan plan = plan_in(100.0);
    plan.wavelengths.back().weight = {1e57, 0.0, 0.0};
    const std::string refusal = refusal_of(100.0, plan);
    EXPECT_TRUE(refusal.starts_with("found light of at most ")) << refusal;
    EXPECT_NE(
        refusal.find(" at 650 nm, fainter than frames hold, which counts in R by a weight of "),
        std::string::npos)
        << refusal;
}

// A plan gives it no weight and says what that costs.
TEST(SceneSet, TakesEveryPlan) {
    for (const double multiple : {0.0, 1.0, 50.0, 60.0, 100.0, 230.0, 1e3}) {
        const RenderPlan plan = plan_in(multiple);
        EXPECT_EQ(refusal_of(multiple, plan), "none") << multiple;
        if (multiple < 50.0) continue;
        EXPECT_EQ(plan.wavelengths.back().weight[0], 0.0) << multiple;
        EXPECT_GT(plan.promise(), 1e-3) << multiple;
    }
}

// A black image is an answer.
TEST(SceneSet, TakesWaterThatNoLightComesThrough) {
    for (const double multiple : {1e4, 1e6}) {
        EXPECT_EQ(refusal_of(multiple, plan_in(multiple)), "none");
    }
}

}  // namespace
}  // namespace aphotic::scene_set_test
