// SPDX-License-Identifier: BSD-3-Clause
//
// Things on the floor through both renderers: scenes/objects.toml with its sphere, box and mesh in
// the light of four strobes of three cones, in water, and tilted both ways.
#include "support/has.h"
#include "support/run_command.h"
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

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    EXPECT_TRUE(has(text, from)) << from;
    return text.replace(text.find(from), from.size(), to);
}

// The small scene has 34 x 25 pixels; four times as many each way show more of the shadows.
void put_rig(const std::filesystem::path& folder, bool has_port) {
    put_small_scene(std::string(APHOTIC_SOURCE_DIR) + "/scenes/objects.toml", folder);
    std::string text = read_text_file(folder / "rig.toml");
    text = replaced(text, "[34, 25]", "[136, 102]");
    text = replaced(text, "pixel_pitch_um = 258", "pixel_pitch_um = 64.5");
    text = replaced(text, "roll_deg   = 0.0", "roll_deg   = -4.0");
    if (has_port) {
        text = replaced(text,
                        "[water]",
                        "[camera.port]\nshape = \"flat\"\ndistance_mm = 50.0\n"
                        "thickness_mm = 12.0\nglass = \"bk7\"\n\n[water]");
    }
    write_file(folder / "rig.toml", text);
}

class Objects : public testing::TestWithParam<bool> {};

TEST_P(Objects, ValidateInWaterTilted) {
    const TempFolder folder;
    put_rig(folder.path(), GetParam());
    const CommandResult run = run_aphotic(folder.path(), "validate rig.toml -o out --json");
    ASSERT_EQ(run.status, 0) << run.out << run.err;
    const auto json = nlohmann::json::parse(run.out);
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
