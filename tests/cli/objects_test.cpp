// SPDX-License-Identifier: BSD-3-Clause
//
// Things on the floor through both renderers: scenes/objects.toml with its sphere, box and mesh in
// the light of four strobes of three cones, in water, and tilted both ways.
#include "support/command_test.h"
#include "support/scene_text.h"
#include "support/small_scene.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace aphotic::objects_test {
namespace {

// A half float's rounding, 4.9e-4, and a bit.
constexpr double kHalfFloatError = 6e-4;
// Edges are lines, which few pixel centres lie on; behind a port the ball's rim towards the dark is
// a strip. So much of 136 x 102 pixels may go uncompared, and no more.
constexpr int kMostOnEdges = 136 * 102 / 300;

class Objects : public CommandTest, public testing::WithParamInterface<bool> {};

TEST_P(Objects, ValidateInWaterTilted) {
    // The small scene has 34 x 25 pixels; four times as many each way show more of the shadows.
    put_small_scene("objects.toml", home_);
    std::string text =
        with(text_of("rig.toml"),
             {{"resolution", "[136, 102]"}, {"pixel_pitch_um", "64.5"}, {"roll_deg", "-4.0"}});
    if (GetParam()) {
        text = replaced(text,
                        "[water]",
                        "[camera.port]\nshape = \"flat\"\ndistance_mm = 50.0\n"
                        "thickness_mm = 12.0\nglass = \"bk7\"\n\n[water]");
    }
    write_file(path("rig.toml"), text);
    const auto json = json_by("validate rig.toml -o out --json");
    for (const auto& wavelength : json.at("wavelengths")) {
        EXPECT_LE(wavelength.at("max_error").get<double>(), kHalfFloatError) << wavelength.dump();
        EXPECT_EQ(wavelength.at("bound").get<double>(), kHalfFloatError) << "no shift is allowed";
        EXPECT_LE(wavelength.at("on_edges").get<int>(), kMostOnEdges) << wavelength.dump();
    }
    for (const auto& channel : json.at("channels")) {
        EXPECT_LE(channel.at("max_error").get<double>(), channel.at("bound").get<double>());
        EXPECT_LE(channel.at("bound").get<double>(), 1e-3) << "the tolerance";
    }
}

INSTANTIATE_TEST_SUITE_P(Ports, Objects, testing::Bool(), [](const auto& port) {
    return port.param ? "BehindAPort" : "InTheWater";
});

}  // namespace
}  // namespace aphotic::objects_test
