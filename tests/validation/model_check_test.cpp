// SPDX-License-Identifier: BSD-3-Clause
#include "validation/model_check.h"

#include "spectral/phase_loader.h"
#include "support/flat.h"
#include "support/scene_rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace aphotic::model_check_test {
namespace {

constexpr std::size_t kPaths = 100;

Rig led_rig(double a, double b) {
    Rig rig = scene_rig("habcam-led.toml");
    rig.water.absorption_per_m = flat(a);
    rig.water.scatterers = {{flat(b), builtin_phase("petzold-coast")}};
    return rig;
}

}  // namespace

TEST(ModelCheck, IsOfWaterThatScatters) {
    Rig rig = led_rig(0.2, 0.2);
    rig.water.scatterers.clear();
    EXPECT_TRUE(check_model(rig, kPaths, 1).places.empty());
}

// rms of errors that are 0.1, -0.1 and, of another channel, 0.5.
TEST(ModelCheck, IsTheRootMeanSquareOfTheErrors) {
    const auto place = [](std::size_t channel, double model) {
        return ModelPlace{.channel = channel,
                          .floor = 0.75 * model,
                          .veil = 0.25 * model,
                          .truth = {.floor = {}, .veil = {}, .sum = {2.0, 0.1}}};
    };
    const ModelCheck check{.paths = 1, .places = {place(0, 2.2), place(0, 1.8), place(2, 3.0)}};
    EXPECT_NEAR(check.rms()[0], 0.1, 1e-15);
    EXPECT_EQ(check.rms()[1], 0.0);
    EXPECT_NEAR(check.rms()[2], 0.5, 1e-15);
    EXPECT_NEAR(check.places.front().noise(), 0.05, 1e-15);
}

// An error that grows as the square of the distance from the middle, x^2 + y^2 with x and y from -1
// to 1, has the mean square 2/5 + 2/9 over the image. Even places find 16 % less than its root.
TEST(ModelCheck, IsOfTheWholeImage) {
    constexpr double kRounding = 2e-3;  // of places to pixels, of 1216 down
    const Rig rig = led_rig(0.2, 0.2);
    ModelCheck check = check_model(rig, 2, 1);
    for (ModelPlace& place : check.places) {
        const double x = 2.0 * place.column / rig.camera.width_px - 1.0;
        const double y = 2.0 * place.row / rig.camera.height_px - 1.0;
        place.veil = 0.0;
        place.floor = 1.0 + x * x + y * y;
        place.truth = {.floor = {}, .veil = {}, .sum = {1.0, 0.0}};
    }
    for (const double rms : check.rms()) EXPECT_NEAR(rms, std::sqrt(28.0 / 45.0), kRounding);
}

// What paths were not followed for counts as error.
TEST(ModelCheck, CountsTheTail) {
    const ModelCheck check{
        .paths = 1,
        .places = {
            {.floor = 0.9, .truth = {.floor = {}, .veil = {}, .sum = {1.0, 0.0}, .tail = 0.2}}}};
    EXPECT_NEAR(check.rms()[0], 0.3, 1e-15);
}

// Of light that is turned once at most the model leaves nothing out.
TEST(ModelCheck, FindsNothingInThinWater) {
    constexpr double kThin_per_m = 1e-6;
    constexpr double kNothing = 1e-5;  // twice turned: b l, squared, and the turns under kLeastTurn
    const ModelCheck check = check_model(led_rig(0.2, kThin_per_m), kPaths, 2);
    ASSERT_EQ(check.places.size(), 27U);
    for (const double rms : check.rms()) EXPECT_LT(rms, kNothing);
}

// Coastal water at 2 m is told to a few percent, harbour water at 4 m is not told at all: what the
// default tolerance of 10 % parts.
TEST(ModelCheck, PartsCoastalWaterFromHarbours) {
    for (const double rms : check_model(led_rig(0.179, 0.219), kPaths, 2).rms())
        EXPECT_LT(rms, 0.05);
    Rig harbour = led_rig(0.366, 1.82);
    harbour.sled.altitude_m = 4.0;
    // The worst channel decides, as it does for the command.
    EXPECT_GT(std::ranges::max(check_model(harbour, kPaths, 2).rms()), 0.1);
}

// Were light lost at c, a coastal floor would be too dark by a factor of 2.4 at 4 m of path
// (docs/reference/water.md): the check must see it.
TEST(ModelCheck, SeesWaterThatLosesAllThatItTurns) {
    Rig rig = led_rig(0.179, 0.219);
    const ModelCheck check = check_model(rig, kPaths, 2);
    Rig lossy = rig;
    const double share = lossy.water.scatterers.front().phase.share_within(kLossCut);
    lossy.water.absorption_per_m = flat(0.179 + share * 0.219);
    const ModelCheck wrong = check_model(lossy, kPaths, 2);
    for (std::size_t i = 0; i < check.places.size(); ++i) {
        EXPECT_LT(wrong.places[i].floor, 0.5 * check.places[i].truth.floor.mean);
    }
}

TEST(ModelCheck, IsOfTheBareFloorAndTheSameWhateverTheThreads) {
    Rig rig = led_rig(0.2, 0.1);
    const auto rms = check_model(rig, kPaths, 1).rms();
    rig.seafloor.phong = 0.3;
    rig.objects.push_back({.name = "ball",
                           .shape = Sphere{.centre_m = {0.0, 0.0, 1.5}, .radius_m = 0.3},
                           .reflectance = flat(0.1)});
    EXPECT_EQ(check_model(rig, kPaths, 3).rms(), rms);
}

}  // namespace aphotic::model_check_test
