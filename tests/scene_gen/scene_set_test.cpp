// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/scene_set.h"

#include "scene_gen/rig_reader.h"
#include "spectral/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace aphotic::scene_set_test {
namespace {

// HabCam over so many times the absorption, in frames of red, green and blue light.
SceneSet scenes_in(double multiple) {
    Rig rig = read_rig(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam.toml");
    rig.water.multiple = multiple;
    PlanRequest request;
    request.wavelengths_nm = {450.0, 550.0, 650.0};
    return make_scene_set(rig, plan_render(rig, request));
}

std::string refusal_in(double multiple) {
    try {
        static_cast<void>(scenes_in(multiple));
        return "none";
    } catch (const InputError& error) {
        return error.what();
    }
}

// POV-Ray's colours are floats, so no exposure lifts red out of such water, and the fit would weigh
// it by 1e56.
TEST(SceneSet, RefusesLightThatFramesDoNotHoldAndThatCounts) {
    const std::string refusal = refusal_in(100.0);
    EXPECT_TRUE(refusal.starts_with("found light of at most ")) << refusal;
    EXPECT_NE(
        refusal.find(" at 650 nm, fainter than frames hold, which counts in R by a weight of "),
        std::string::npos)
        << refusal;
}

TEST(SceneSet, TakesWhatFramesHold) {
    for (const double multiple : {0.0, 1.0, 50.0}) EXPECT_EQ(refusal_in(multiple), "none");
}

// A black image is an answer.
TEST(SceneSet, TakesWaterThatNoLightComesThrough) {
    for (const double multiple : {1e4, 1e6}) EXPECT_EQ(refusal_in(multiple), "none");
}

}  // namespace
}  // namespace aphotic::scene_set_test
