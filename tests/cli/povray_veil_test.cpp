// SPDX-License-Identifier: BSD-3-Clause
//
// `--veil povray` through the command: kept, integrated and validated like any render, and in
// scenes of the user's own. tests/plugin/povray_veil_test.cpp holds its numbers.
#include "image/output_images.h"
#include "spectral/manifest.h"
#include "support/command_test.h"
#include "support/scene_text.h"
#include "support/small_scene.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace aphotic::povray_veil_command_test {
namespace {

class PovrayVeilCommand : public CommandTest {
  protected:
    PovrayVeilCommand() {
        // Smooth beams, in water that scatters; 17 x 12 pixels.
        std::string rig =
            replaced(with(small_scene("habcam.toml", 80), {{"range_nm", "[400, 700]"}}),
                     "absorption = \"pope-fry-1997\"",
                     "type = \"jerlov-1C\"\nphase = { henyey_greenstein = 0.924 }");
        const std::size_t beam = rig.find("weights = \"flux\"");
        rig = rig.substr(0, beam) + "fwhm_deg = 80\n\n" + rig.substr(rig.find("[[strobe]]"));
        write_file(path("rig.toml"), rig);
    }
    nlohmann::json rendered(const std::string& folder, const Arguments& more) {
        return json_by("render rig.toml --json -o " + folder + more);
    }
    [[nodiscard]] std::vector<float> signals(const std::string& folder) const {
        return read_signals(path(folder) / "image.exr").samples;
    }
    // Of each sample, what POV-Ray's veil makes of the quadrature's.
    std::vector<double> ratios(const std::string& scene) {
        write_file(path("reef.pov"), "#version 3.7;\n#include \"aphotic.inc\"\n" + scene);
        rendered("quadrature", "--scene reef.pov");
        rendered("povray", "--scene reef.pov --veil povray");
        std::vector<double> found;
        const std::vector<float> a = signals("povray");
        const std::vector<float> b = signals("quadrature");
        for (std::size_t i = 0; i < a.size(); ++i) found.push_back(a[i] / b[i]);
        return found;
    }
};

TEST_F(PovrayVeilCommand, KeepsItsFramesAndIntegratesThem) {
    const auto first = rendered("out", "--veil povray");
    EXPECT_EQ(first.at("veil").at("by"), "povray");
    EXPECT_EQ(first.at("veil").at("samples"), 50);
    EXPECT_LE(first.at("veil").at("error").get<double>(), 1e-3);
    const std::vector<float> image = signals("out");
    const auto again = rendered("out", "--veil povray");
    EXPECT_EQ(again.at("frames_rendered"), 0);
    done("integrate out", "which is no bound");
    EXPECT_EQ(signals("out"), image);
    // Other samples make other frames, and only of the veil.
    const auto finer = rendered("out", "--veil povray --veil-samples 60");
    EXPECT_EQ(finer.at("frames_kept"), read_manifest(path("out")).direct_frames());
    // A frame that is another is refused.
    const Manifest manifest = read_manifest(path("out"));
    write_file(image_path(path("out"), manifest.frames.back()), "no image");
    EXPECT_NE(aphotic("integrate out").status, 0);
}

TEST_F(PovrayVeilCommand, IsValidatedOverTheBareFloor) {
    done("validate rig.toml --veil povray -o out");
    // A veil that is 5 % too bright does not pass.
    Manifest manifest = read_manifest(path("out"));
    for (PlannedWavelength& w : manifest.wavelengths)
        for (double& weight : w.veil->weight) weight *= 1.05;
    write_manifest(path("out"), manifest);
    done("integrate out");
    done("validate rig.toml --veil povray --rendered out -o v", "", kAnswerIsNo);
}

// The reference leaves out the shadows, and nothing bounds what samples find of them.
TEST_F(PovrayVeilCommand, IsNotValidatedWithObjects) {
    write_file(path("ball.toml"),
               text_of("rig.toml") +
                   "\n[[object]]\nname = \"ball\"\nshape = \"sphere\"\n"
                   "centre_m = [0.3, 0.2, 1.2]\nradius_m = 0.25\nreflectance = \"sand\"\n");
    refused("validate ball.toml --veil povray -o out", "shadows");
}

// Colours that are numbers are not black in the veil's frames: what they show is taken off.
TEST_F(PovrayVeilCommand, OverGreyThingsOfTheUsersIsTheQuadratures) {
    // Promises of 1e-3 each, and half floats of a floor that is taken off.
    constexpr double kTwoRenders = 5e-3;
    for (const double ratio : ratios("Aphotic_Rig ()\nplane { -z, -2 pigment { rgb 0.3 } }\n"))
        ASSERT_NEAR(ratio, 1.0, kTwoRenders);
}

// A board beside the camera, out of its sight.
TEST_F(PovrayVeilCommand, HasTheShadowsOfTheUsersThings) {
    constexpr double kTwoRenders = 5e-3;
    const std::vector<double> found = ratios(
        "Aphotic_Rig ()\nAphotic_Rig_Seafloor ()\n"
        "box { <-0.02, 0.3, 0.1>, <0.02, 0.32, 0.35> pigment { rgb 0.5 } }\n");
    EXPECT_LE(*std::ranges::max_element(found), 1.0 + kTwoRenders);
    EXPECT_LT(*std::ranges::min_element(found), 0.99);
}

}  // namespace
}  // namespace aphotic::povray_veil_command_test
