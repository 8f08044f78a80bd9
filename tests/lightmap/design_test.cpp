// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/design.h"

#include "base/error.h"
#include "support/design_rig.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace aphotic::design_test {
namespace {

DesignRequest request_for(const Rig& rig, std::vector<std::string> keys, int evaluations) {
    DesignRequest request{.freedom = {.keys = std::move(keys)},
                          .envelope = envelope_of(rig.sled),
                          .evaluations = evaluations};
    return request;
}

// A strobe that looks down, right of the axis, over a floor that the camera sees alike to all
// sides: the image is most even where the lamp is over its middle.
TEST(Design, FindsTheMiddle) {
    const Rig rig =
        design_rig(design_strobe("lamp", "[0.2, -0.1, -0.2]", "direction = [0, 0, 1]"), 4.0);
    DesignRequest request = request_for(rig, {"strobe.lamp.position_m"}, 600);
    request.freedom.boxes = {"lamp=-0.4:0.4,-0.4:0.4,-0.2"};
    const DesignResult result = design(text_of(rig), request);
    constexpr double kNear_m = 0.01;  // the top is a crease; the box is 0.8 m wide
    ASSERT_TRUE(result.is_better);
    EXPECT_NEAR(result.best.places[0].position_m.x(), 0.0, kNear_m);
    EXPECT_NEAR(result.best.places[0].position_m.y(), 0.0, kNear_m);
    EXPECT_EQ(result.best.places[0].position_m.z(), -0.2);
}

// Of two alike fore and aft, one of which is to find its place: where it mirrors the other, if the
// other is where two that mirror each other are best.
TEST(Design, TwoAlikeEndAsMirrors) {
    const Rig rig = design_rig(two_strobes(), 6.0);
    DesignRequest request = request_for(rig, {"strobe.*.position_m"}, 1500);
    request.freedom.boxes = {"fore=0.1:1,0,0", "aft=-1:-0.1,0,0"};
    request.keep = 0.0;
    const DesignResult result = design(text_of(rig), request);
    constexpr double kNear_m = 0.01;
    ASSERT_TRUE(result.is_better);
    EXPECT_NEAR(
        result.best.places[0].position_m.x(), -result.best.places[1].position_m.x(), kNear_m);
}

TEST(Design, TheSameSeedGivesTheSameBytesWhateverTheThreads) {
    const Rig rig = design_rig(two_strobes());
    DesignRequest request = request_for(rig, {"strobe.*.position_m", "strobe.*.aim"}, 200);
    request.envelope.altitude_m = {1.8, 2.2};
    const DesignResult one = design(text_of(rig), request);
    request.threads = 3;
    const DesignResult other = design(text_of(rig), request);
    EXPECT_EQ(one.best.toml, other.best.toml);
    EXPECT_EQ(one.best.figures.evenness, other.best.figures.evenness);
    ASSERT_EQ(one.front.size(), other.front.size());
    for (std::size_t i = 0; i < one.front.size(); ++i)
        EXPECT_EQ(one.front[i].toml, other.front[i].toml);
}

// Of every goal, in whatever is kept, as judged; and with so little search that it finds nothing.
TEST(Design, IsNeverWorseThanTheStart) {
    const Rig rig = design_rig(two_strobes(), 3.0);
    for (const DesignGoal goal : {DesignGoal::Evenness, DesignGoal::Signal, DesignGoal::Coverage}) {
        for (const int evaluations : {10, 200}) {
            for (const std::uint64_t seed : {1U, 2U}) {
                DesignRequest request =
                    request_for(rig, {"strobe.*.position_m", "strobe.*.aim"}, evaluations);
                request.goal = goal;
                request.seed = seed;
                request.level = 0.8;
                request.envelope.pitch_rad = {0.0, 0.1};
                const DesignResult result = design(text_of(rig), request);
                EXPECT_GE(result.best.figures.evenness, result.start.figures.evenness);
                EXPECT_GE(result.best.figures.coverage, result.start.figures.coverage);
                EXPECT_GE(result.best.figures.signal_to_noise,
                          result.start.figures.signal_to_noise);
                EXPECT_EQ(result.start.toml, rig.toml);
                EXPECT_EQ(result.is_better, result.best.toml != rig.toml);
            }
        }
    }
}

TEST(Design, LooksAtNoMoreThanItIsAskedTo) {
    const Rig rig = design_rig(two_strobes(), 3.0);
    for (const int evaluations : {10, 37, 200}) {
        const DesignResult result = design(
            text_of(rig), request_for(rig, {"strobe.*.position_m", "strobe.*.aim"}, evaluations));
        EXPECT_LE(result.evaluations, evaluations);
        EXPECT_GE(result.evaluations, evaluations / 2);
    }
}

TEST(Design, NoneOfTheFrontIsBetterInBoth) {
    const Rig rig = design_rig(two_strobes(), 3.0);
    const DesignResult result =
        design(text_of(rig), request_for(rig, {"strobe.*.position_m", "strobe.*.aim"}, 600));
    ASSERT_GE(result.front.size(), 2U);
    for (std::size_t i = 1; i < result.front.size(); ++i) {
        EXPECT_GT(result.front[i].figures.signal_to_noise,
                  result.front[i - 1].figures.signal_to_noise);
        EXPECT_LT(result.front[i].figures.evenness, result.front[i - 1].figures.evenness);
    }
}

// The figures are those that anyone finds of the rig it leaves.
TEST(Design, JudgesWhatItLeaves) {
    const Rig rig = design_rig(two_strobes());
    DesignRequest request = request_for(rig, {"strobe.*.aim"}, 100);
    request.envelope.roll_rad = {-0.1, 0.1};
    const DesignResult result = design(text_of(rig), request);
    const Rig left = RigText(result.best.toml, "designed.toml", {}).rig();
    double least = 1.0;
    for (const double roll_rad : {-0.1, 0.0, 0.1}) {
        Sled sled = left.sled;
        sled.roll_rad = roll_rad;
        const LightmapMaker maker(left, paths_of(left, {sled}), {});
        least = std::min(least, figures_of(maker.map(sled), request.level).evenness);
    }
    constexpr double kTables = 2e-4;  // the judge asks for errors of 1e-4
    EXPECT_NEAR(result.best.figures.evenness, least, kTables);
}

TEST(Design, PosesAreEndsAndMiddles) {
    Envelope envelope = envelope_of({.altitude_m = 2.0});
    EXPECT_EQ(corner_poses(envelope).size(), 1U);
    EXPECT_EQ(grid_poses(envelope).size(), 1U);
    envelope.altitude_m = {1.0, 3.0};
    envelope.roll_rad = {-0.1, 0.3};
    EXPECT_EQ(corner_poses(envelope).size(), 5U);
    EXPECT_EQ(corner_poses(envelope).back().altitude_m, 2.0);
    EXPECT_EQ(grid_poses(envelope).size(), 9U);
}

TEST(Design, ASmallImageHasTheSameView) {
    Rig rig = design_rig(two_strobes());
    rig.camera.width_px = 1936;
    rig.camera.height_px = 1216;
    const Rig small = with_longer_side(rig, kSearched_px);
    EXPECT_LE(small.camera.width_px, kSearched_px);
    // 164 x 103: off by a hundredth of a pixel.
    EXPECT_NEAR(small.camera.height_px, small.camera.width_px * 1216.0 / 1936.0, 0.02);
    EXPECT_NEAR(small.camera.width_px * small.camera.pixel_pitch_m,
                rig.camera.width_px * rig.camera.pixel_pitch_m,
                1e-12);
    EXPECT_EQ(with_longer_side(small, kSearched_px).camera.width_px, small.camera.width_px);
}

TEST(Design, RefusesAStartThatLeavesPixelsDark) {
    const std::string cone =
        "[beam.narrow]\ncones = [{ part = \"all\", half_angle_deg = 5.0, weight = 1.0 }]\n"
        "[[strobe]]\nname = \"lamp\"\nposition_m = [0.2, 0, 0]\ndirection = [0, 0, 1]\n"
        "beam = \"narrow\"\n";
    const Rig rig = design_rig(cone);
    EXPECT_THROW((void)design(text_of(rig), request_for(rig, {"strobe.lamp.aim"}, 20)), InputError);
}

// A search in water that scatters counts the veil's noise.
TEST(Design, CountsTheVeil) {
    std::string text = design_rig_text(two_strobes());
    text.replace(text.find("multiple = 0.0"), 14, "scattering = \"sea-water\"");
    const Rig rig = RigText(text, "rig.toml", {}).rig();
    DesignRequest request = request_for(rig, {"strobe.fore.aim"}, 10);
    request.goal = DesignGoal::Signal;
    const DesignResult result = design(text_of(rig), request);
    const LightmapMaker maker(rig, std::nullopt, {});
    constexpr double kTables = 2e-4;
    EXPECT_NEAR(
        result.start.figures.signal_to_noise / figures_of(maker.map(rig.sled), 0.5).signal_to_noise,
        1.0,
        kTables);
}

}  // namespace
}  // namespace aphotic::design_test
