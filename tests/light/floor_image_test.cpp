// SPDX-License-Identifier: BSD-3-Clause
//
// Images by tiles against the same light pixel by pixel.
#include "light/floor_image.h"

#include "support/random_beam.h"
#include "support/random_camera.h"
#include "support/scene_rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace aphotic::floor_image_test {
namespace {

// Of a few groups of lamps that are added as floats, on top of what interpolation may be off by.
constexpr double kRounding = 6.0 * 0x1p-24;

std::vector<float> painted(const FloorLight& light, const Camera& camera, int first, int count) {
    std::vector<float> samples(kChannels * static_cast<std::size_t>(camera.width_px) *
                               static_cast<std::size_t>(count));
    const Outside outside = paint_floor(light,
                                        2,
                                        {.width_px = camera.width_px,
                                         .height_px = camera.height_px,
                                         .first = first,
                                         .count = count,
                                         .samples = samples.data()});
    EXPECT_FALSE(outside.is_before || outside.is_beyond);
    return samples;
}

void expect_light_of_each_pixel(const Rig& rig, const std::string& what) {
    const SignalTable table = signal_table(rig, path_range(rig), 1e-5);
    const CameraRays rays(rig, 1);
    const FloorLight light(rig, rig.sled, table, rays);
    const Camera& camera = rig.camera;
    const std::vector<float> found = painted(light, camera, 0, camera.height_px);
    const std::size_t plane = found.size() / kChannels;
    double worst = 0.0;
    for (int row = 0; row < camera.height_px; row += 3) {
        for (int column = 0; column < camera.width_px; ++column) {
            LaneLight all;
            const LaneRays at =
                light.rays_at(every_lane(column + 0.5), every_lane(row + 0.5), false);
            for (const FloorLamp& lamp : light.lamps()) light.add(lamp, at, all);
            const PlaceLight expected = all.of_lane(0);
            const auto i = static_cast<std::size_t>(row * camera.width_px + column);
            for (std::size_t c = 0; c < kChannels; ++c) {
                if (expected.signals[c] == 0.0) {
                    EXPECT_EQ(found[c * plane + i], 0.0F) << what;
                    continue;
                }
                worst = std::max(
                    worst,
                    std::abs(static_cast<double>(found[c * plane + i]) / expected.signals[c] -
                             1.0));
            }
        }
    }
    EXPECT_LE(worst, kTileError + kRounding) << what;
}

TEST(FloorImage, IsTheLightOfEachPixel) {
    for (const BeamKind kind : kBeamKinds) {
        for (int i = 0; i < 4; ++i) {
            Dice dice(4200 + static_cast<std::uint64_t>(i));
            Rig rig = habcam(i % 2 == 0 ? 700 : 97, i % 2 == 0 ? 130 : 71);
            for (Strobe& strobe : rig.strobes) strobe.beam = random_beam_of(kind, dice);
            if (i == 1) give_lens(LensKind::Fisheye, dice, rig.camera);
            if (i == 3) rig.seafloor.phong = 0.5;
            expect_light_of_each_pixel(
                rig,
                "kind " + std::to_string(static_cast<int>(kind)) + ", rig " + std::to_string(i));
        }
    }
}

TEST(FloorImage, IsTheSameToTheBitForAnyRowsOfTiles) {
    const Rig rig = habcam(200, 150);
    const SignalTable table = signal_table(rig, path_range(rig), 1e-5);
    const CameraRays rays(rig, 1);
    const FloorLight light(rig, rig.sled, table, rays);
    const std::vector<float> whole = painted(light, rig.camera, 0, 150);
    const std::vector<float> some = painted(light, rig.camera, 64, 64);
    for (std::size_t c = 0; c < kChannels; ++c) {
        EXPECT_TRUE(
            std::equal(some.begin() + static_cast<std::ptrdiff_t>(c * 200 * 64),
                       some.begin() + static_cast<std::ptrdiff_t>((c + 1) * 200 * 64),
                       whole.begin() + static_cast<std::ptrdiff_t>(c * 200 * 150 + 64 * 200)));
    }
}

}  // namespace
}  // namespace aphotic::floor_image_test
