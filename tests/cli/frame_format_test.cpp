// SPDX-License-Identifier: BSD-3-Clause
//
// Frames as 16-bit PNG, by a POV-Ray that says it has no OpenEXR and by one that has.
#include "support/command_test.h"
#include "support/exr_file.h"
#include "support/scene_text.h"
#include "support/small_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
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
    void make_water_scatter() const {
        const std::string toml =
            std::regex_replace(text_of("rig.toml"),
                               std::regex(R"(absorption = .*\n *(multiple .*\n)?)"),
                               "chlorophyll_mg_m3 = 0.05\n");
        write_file(path("rig.toml"), with(toml, {{"range_nm", "[400, 700]"}}));
    }
    [[nodiscard]] CommandResult run_without_openexr(const Arguments& arguments) const {
        return aphotic(arguments, {{"APHOTIC_POVRAY", path("povray").string()}});
    }
    [[nodiscard]] std::vector<float> image(const std::string& folder) const {
        return read_exr(path(folder + "/image.exr"));
    }
};

TEST_F(FrameFormatOption, ServesAPovRayWithoutOpenExr) {
    put_small_scene("habcam.toml", home_);
    refused(run_without_openexr("render rig.toml -o exr"),
            "built without OpenEXR, which frames need; --frame-format png16 does without",
            kRunFailed);
    EXPECT_FALSE(fs::exists(path("exr")));

    done(run_without_openexr("render rig.toml --frame-format png16 -o png"), "frames were PNG");
    done("validate rig.toml --rendered png -o validation");

    refused(run_without_openexr("render --frame-format png16 -o own" +
                                Arguments{APHOTIC_SOURCE_DIR "/scenes/user/reef/reef.toml"}),
            "which the probe of a scene of your own needs",
            kRunFailed);
}

// By half floats and by PNG, each within its promise: with a frame of fog, which is white above the
// horizon.
TEST_F(FrameFormatOption, ShowsTheSame) {
    put_small_scene("objects.toml", home_);
    make_water_scatter();
    write_file(path("rig.toml"),
               with(text_of("rig.toml"), {{"altitude_m", "3"}, {"pitch_deg", "80"}}));
    const auto render = [&](const char* format) {
        return aphotic(
            fmt::format("render rig.toml --frame-format {0} --wavelengths 478,576,638 "
                        "--model-tolerance 1 --json -o {0}",
                        format));
    };
    done(render("exr"));
    const Json json = json_by(render("png16"));
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
    put_small_scene("habcam.toml", home_);
    refused("render rig.toml --frame-format tiff -o out", "--frame-format");
    make_water_scatter();
    refused("render rig.toml --frame-format png16 --veil povray -o out",
            "--frame-format: found png16 with --veil povray");
}

}  // namespace
}  // namespace aphotic::frame_format_test
