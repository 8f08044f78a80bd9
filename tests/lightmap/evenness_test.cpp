// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/evenness.h"

#include "support/design_rig.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace aphotic::evenness_test {
namespace {

constexpr double kFloats = 1e-5;  // of a map: its table, and the rounding of floats

// A lamp of cos^n right at the pupil, over a floor across the axis in clear water: of every pixel
// the lamp sees the floor as far as the camera does, h / cos(theta) away and at theta, and the
// light is cos^(n + 3)(theta).
TEST(Evenness, OfALampAtThePupilIsAPowerOfTheCosine) {
    for (const double n : {0.0, 1.0, 4.0}) {
        const Rig rig =
            design_rig(design_strobe("lamp", "[0.0, 0.0, 0.0]", "direction = [0, 0, 1]"), n);
        const Camera& camera = rig.camera;
        double sum = 0.0;
        double least = 1.0;
        double most = 0.0;
        int over_half = 0;
        std::vector<double> light;
        for (int row = 0; row < camera.height_px; ++row) {
            for (int column = 0; column < camera.width_px; ++column) {
                const double x = (column + 0.5 - 0.5 * camera.width_px) * camera.pixel_pitch_m;
                const double y = (row + 0.5 - 0.5 * camera.height_px) * camera.pixel_pitch_m;
                const double cosine =
                    1.0 / std::sqrt(1.0 + (x * x + y * y) / std::pow(camera.focal_length_m, 2));
                light.push_back(std::pow(cosine, n + 3.0));
                sum += light.back();
                least = std::min(least, light.back());
                most = std::max(most, light.back());
            }
        }
        for (const double one : light) over_half += one >= 0.5 * most ? 1 : 0;
        const auto count = static_cast<double>(light.size());
        const LightFigures found =
            figures_of(LightmapMaker(rig, std::nullopt, {}).map(rig.sled), 0.5);
        EXPECT_NEAR(found.evenness, least * count / sum, kFloats);
        EXPECT_NEAR(found.diversity, least / most, kFloats);
        EXPECT_EQ(found.coverage, over_half / count);
    }
}

TEST(Evenness, OfEvenLightIsOne) {
    const LightFigures found = figures_of_plane(std::vector<float>(7, 4.0F), {}, 1.0);
    EXPECT_EQ(found.evenness, 1.0);
    EXPECT_EQ(found.diversity, 1.0);
    EXPECT_EQ(found.coverage, 1.0);
    EXPECT_EQ(found.signal_to_noise, 2.0);  // the root of its photons
}

// 9 / sqrt(9 + 7) = 9/4; 4 / sqrt(4 + 0) = 2.
TEST(Evenness, TheVeilIsNoiseAlone) {
    EXPECT_EQ(figures_of_plane(std::vector{9.0F}, std::vector{7.0F}, 0.5).signal_to_noise, 2.25);
    EXPECT_EQ(
        figures_of_plane(std::vector{9.0F, 4.0F}, std::vector{7.0F, 0.0F}, 0.5).signal_to_noise,
        2.0);
    EXPECT_EQ(figures_of_plane(std::vector{9.0F, 4.0F}, std::vector{7.0F, 0.0F}, 0.5).evenness,
              4.0 / 6.5);
}

TEST(Evenness, IsOfTheWorstChannelThatSees) {
    const Lightmap map{
        .width_px = 2, .height_px = 1, .samples = {1.0F, 3.0F, 2.0F, 2.0F, 0.0F, 0.0F}};
    EXPECT_EQ(figures_of(map, 0.5).evenness, 0.5);
    EXPECT_EQ(figures_of(map, 0.5).coverage, 0.5);
    const Lightmap dark{.width_px = 2, .height_px = 1, .samples = std::vector<float>(6, 0.0F)};
    EXPECT_EQ(figures_of(dark, 0.5).evenness, 0.0);
    const LightFigures hole = figures_of_plane(std::vector{0.0F, 1.0F}, {}, 0.5);
    EXPECT_EQ(hole.evenness, 0.0);
    EXPECT_EQ(hole.signal_to_noise, 0.0);
}

}  // namespace
}  // namespace aphotic::evenness_test
