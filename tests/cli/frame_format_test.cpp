// SPDX-License-Identifier: BSD-3-Clause
//
// Frames as 16-bit PNG, by a POV-Ray that says it has no OpenEXR and by one that has.
#include "image/exr.h"
#include "support/command_test.h"
#include "support/has.h"
#include "support/small_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <string>
#include <vector>

namespace aphotic::frame_format_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class FrameFormatOption : public CommandTest {
  protected:
    FrameFormatOption() {
        // POV-Ray as conda-forge builds it: it says so among the formats, and nobody asks it for
        // any.
        write_script(
            path("povray"),
            "if [ \"$1\" = --version ]; then povray --version 2>&1 | sed 's/ openexr//' >&2\n"
            "else exec povray \"$@\"; fi\n");
    }
    void put(const char* scene) const {
        put_small_scene(fs::path(APHOTIC_SOURCE_DIR) / "scenes" / scene, path(""));
    }
    void make_water_scatter() const {
        std::string toml = text_of("rig.toml");
        toml = std::regex_replace(toml,
                                  std::regex(R"(absorption = .*\n *(multiple .*\n)?)"),
                                  "chlorophyll_mg_m3 = 0.05\n");
        toml = std::regex_replace(toml, std::regex(R"(\[400, 720\])"), "[400, 700]");
        write_file(path("rig.toml"), toml);
    }
    [[nodiscard]] CommandResult run_without_openexr(const Arguments& arguments) const {
        return aphotic(arguments, {{"APHOTIC_POVRAY", path("povray").string()}});
    }
    [[nodiscard]] std::vector<float> image(const std::string& folder) const {
        return ExrReader(path(folder) / "image.exr")
            .planes(std::vector<std::string>{"R", "G", "B"});
    }
};

TEST_F(FrameFormatOption, ServesAPovRayWithoutOpenExr) {
    put("habcam.toml");
    const CommandResult refused = run_without_openexr("render rig.toml -o exr");
    EXPECT_EQ(refused.status, 3);
    EXPECT_TRUE(has(refused.err,
                    "built without OpenEXR, in which frames are written; --frame-format "
                    "png16 does without"));
    EXPECT_FALSE(fs::exists(path("exr")));

    const CommandResult rendered =
        run_without_openexr("render rig.toml --frame-format png16 -o png");
    ASSERT_EQ(rendered.status, 0) << rendered.err;
    EXPECT_TRUE(has(rendered.out, "frames were PNG"));
    const CommandResult validated = aphotic("validate rig.toml --rendered png -o validation");
    EXPECT_EQ(validated.status, 0) << validated.out << validated.err;

    const CommandResult own =
        run_without_openexr("render --frame-format png16 -o own" +
                            Arguments{APHOTIC_SOURCE_DIR "/scenes/user/reef/reef.toml"});
    EXPECT_EQ(own.status, 3);
    EXPECT_TRUE(has(own.err, "in which a scene of your own is measured"));
}

// By half floats and by PNG, each within its promise: with a frame of fog, which is white above the
// horizon.
TEST_F(FrameFormatOption, ShowsTheSame) {
    put("objects.toml");
    make_water_scatter();
    std::string toml = text_of("rig.toml");
    toml = std::regex_replace(toml, std::regex(R"(altitude_m .*)"), "altitude_m = 3");
    toml = std::regex_replace(toml, std::regex(R"(pitch_deg .*)"), "pitch_deg = 80");
    write_file(path("rig.toml"), toml);
    const auto render = [&](const char* format) {
        return aphotic(
            fmt::format("render rig.toml --frame-format {0} --wavelengths 478,576,638 "
                        "--model-tolerance 1 --json -o {0}",
                        format));
    };
    const CommandResult halves = render("exr");
    ASSERT_EQ(halves.status, 0) << halves.err;
    const CommandResult made = render("png16");
    ASSERT_EQ(made.status, 0) << made.err;
    const Json json = Json::parse(made.out);
    const double digits_from = json.at("digits_from");
    EXPECT_GT(digits_from, 0.0);
    EXPECT_LT(digits_from, 0.5);
    EXPECT_TRUE(fs::exists(path("png16/povray/frames/distance.exr")));

    const std::vector<float> expected = image("exr");
    const std::vector<float> found = image("png16");
    ASSERT_EQ(found.size(), expected.size());
    const std::size_t plane = found.size() / 3;
    constexpr double kFrames = 2.0 * 4.9e-4;  // what each of the two rounds by, at the most
    for (std::size_t c = 0; c < 3; ++c) {
        const auto first = expected.begin() + static_cast<std::ptrdiff_t>(c * plane);
        const double brightest =
            *std::max_element(first, first + static_cast<std::ptrdiff_t>(plane));
        for (std::size_t i = c * plane; i < (c + 1) * plane; ++i) {
            const double size = std::max<double>(expected[i], digits_from * brightest);
            ASSERT_NEAR(found[i], expected[i], kFrames * size) << i;
        }
    }
}

TEST_F(FrameFormatOption, IsRefusedWhereItCannotServe) {
    put("habcam.toml");
    const CommandResult result = aphotic("render rig.toml --frame-format tiff -o out");
    EXPECT_EQ(result.status, 2);
    make_water_scatter();
    const CommandResult veil = aphotic("render rig.toml --frame-format png16 --veil povray -o out");
    EXPECT_EQ(veil.status, 2);
    EXPECT_TRUE(has(veil.err, "--frame-format: found png16 with --veil povray"));
}

}  // namespace
}  // namespace aphotic::frame_format_test
