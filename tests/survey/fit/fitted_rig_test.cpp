// SPDX-License-Identifier: BSD-3-Clause
//
// What is written reads back as what was fitted, whichever strobes share a beam; what was not
// fitted stays.
#include "survey/fit/fitted_rig.h"

#include "base/atomic_file.h"
#include "support/has.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>

namespace aphotic::fitted_rig_test {
namespace {

namespace fs = std::filesystem;

// Of what is written and read back by its decimal digits.
constexpr double kRounding = 1e-11;  // rigs are written in twelve digits

RigText scene(const std::string& name) {
    return RigText(fs::path(APHOTIC_SOURCE_DIR) / "scenes" / name);
}

FitResult start_of(const RigText& rig, const FitOptions& options) {
    FitResult result;
    result.state = fit_problem(rig, options, {.widest_rad = 1.0, .block_rad = 0.02}).state;
    Eigen::Index parts = 0;
    for (const FitBeam& beam : result.state.beams) parts += static_cast<Eigen::Index>(beam.parts());
    result.shares = Eigen::VectorXd::Constant(parts, 1.0);
    return result;
}

Rig written(const RigText& rig, const FitResult& result) {
    const TempFolder folder;
    write_fitted_rig(rig, result, folder.path());
    return RigText(folder.path() / kFittedRig).rig();
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos;
         at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
    return text;
}

TEST(FittedRig, EachStrobeHasTheConesThatWereFittedToIt) {
    const RigText rig = scene("habcam.toml");
    FitResult result = start_of(rig, {.beam = FitBeamKind::Cones, .has_beam_each = true});
    ASSERT_EQ(result.shares.size(), 12);
    for (Eigen::Index s = 0; s < 4; ++s)
        result.shares.segment(3 * s, 3) << 0.1 * static_cast<double>(s + 1), 0.2, 0.3;
    const Rig fitted = written(rig, result);
    for (std::size_t s = 0; s < 4; ++s) {
        const double flux = 0.1 * static_cast<double>(s + 1) + 0.5;
        EXPECT_NEAR(fitted.strobes[s].beam.cones[0].weight, (flux - 0.5) / flux, kRounding) << s;
        EXPECT_NEAR(fitted.strobes[s].beam.cones[2].weight, 0.3 / flux, kRounding) << s;
        // A fifth and so on of all light.
        EXPECT_NEAR(fitted.strobes[s].power, 4.0 * flux / 3.0, kRounding) << s;
    }
}

TEST(FittedRig, BeamsThatAreAlikeShareOne) {
    const std::string text = scene("habcam.toml").text();
    const std::size_t at = text.find("[beam.fresnel]");
    const std::string beam = text.substr(at, text.find("[[strobe]]") - at);
    std::string twice =
        replaced(text, beam, beam + replaced(beam, "[beam.fresnel]", "[beam.other]"));
    twice.replace(twice.rfind("\"fresnel\""), 9, "\"other\"");
    const RigText rig(twice, "twice.toml", {});
    ASSERT_EQ(rig.rig().strobes[3].beam.name, "other");
    FitResult result = start_of(rig, {.beam = FitBeamKind::Cones});
    ASSERT_EQ(result.shares.size(), 3);
    result.shares << 0.5, 0.25, 0.25;
    for (const Strobe& strobe : written(rig, result).strobes)
        EXPECT_NEAR(strobe.beam.cones[0].weight, 0.5, kRounding) << strobe.name;
}

// Literal weights are those of POV-Ray's own lights, not shares of the flux.
TEST(FittedRig, SharesAreOfTheFlux) {
    const RigText rig(replaced(scene("habcam.toml").text(), "\"flux\"", "\"literal\""), "", {});
    FitResult result = start_of(rig, {.beam = FitBeamKind::Cones});
    result.shares << 0.5, 0.25, 0.25;
    const Beam beam = written(rig, result).strobes[0].beam;
    EXPECT_EQ(beam.weights, ConeWeights::Flux);
    EXPECT_NEAR(beam.cones[1].weight, 0.25, kRounding);
}

TEST(FittedRig, LensesAreThoseThatWereFitted) {
    const RigText rig = scene("habcam-optics.toml");
    FitResult result = start_of(rig, {.beam = FitBeamKind::Optics});
    ASSERT_EQ(result.state.beams.size(), 2U);
    result.state.beams[0].shape(0) = 0.071;
    result.state.beams[1].shape(1) = 0.043;
    const Rig fitted = written(rig, result);
    const Rig was = rig.rig();
    for (std::size_t s = 0; s < 4; ++s) {
        const auto& optics = std::get<BeamOptics>(fitted.strobes[s].beam.pattern);
        auto expected = std::get<BeamOptics>(was.strobes[s].beam.pattern);
        (s < 2 ? expected.focal_length_m : expected.distance_m) = s < 2 ? 0.071 : 0.043;
        EXPECT_NEAR(optics.focal_length_m, expected.focal_length_m, kRounding) << s;
        EXPECT_NEAR(optics.distance_m, expected.distance_m, kRounding) << s;
        EXPECT_EQ(fitted.strobes[s].beam.turn_rad, was.strobes[s].beam.turn_rad) << s;
    }
}

// A rig that was fitted once has a beam of that name.
TEST(FittedRig, IsWrittenAgain) {
    const RigText rig(replaced(scene("habcam.toml").text(), "fresnel", "fitted"), "rig.toml", {});
    FitResult result = start_of(rig, {.beam = FitBeamKind::Cosine});
    result.state.beams.front().shape(0) = 3.0;
    const Rig fitted = written(rig, result);
    ASSERT_EQ(fitted.strobes[0].beam.cones.size(), 1U);
    EXPECT_NEAR(fitted.strobes[0].beam.cones[0].exponent, 3.0, kRounding);
    // Half as bright at 60 degrees, without the digits that a rounding leaves.
    result.state.beams.front().shape(0) = 1.0;
    const TempFolder folder;
    write_fitted_rig(rig, result, folder.path());
    const std::string toml = read_text_file(folder.path() / kFittedRig);
    EXPECT_TRUE(has(toml, "fwhm_deg = 120"));
    EXPECT_FALSE(has(toml, "0000000"));

    result = start_of(rig, {.beam = FitBeamKind::Cones});
    result.shares << 0.5, 0.25, 0.25;
    EXPECT_NEAR(written(rig, result).strobes[0].beam.cones[0].weight, 0.5, kRounding);
}

TEST(FittedRig, LampsThatWereNotFittedKeepTheirFigures) {
    const RigText rig(replaced(scene("habcam.toml").text(),
                               "spectrum   = \"xenon-flash\"",
                               "spectrum   = \"xenon-flash\"\nluminous_flux_lm = 8000.0"),
                      "rig.toml",
                      {});
    FitResult result = start_of(rig, {.free = {{"altitude"}}});
    result.state.offset.altitude_m = 0.05;
    const TempFolder folder;
    write_fitted_rig(rig, result, folder.path());
    const RigText fitted(folder.path() / kFittedRig);
    EXPECT_EQ(fitted.number("strobe.fore.luminous_flux_lm"), 8000.0);
    EXPECT_FALSE(fitted.has("strobe.fore.power"));
    EXPECT_EQ(fitted.number("sled.altitude_offset_m"), 0.05);
}

}  // namespace
}  // namespace aphotic::fitted_rig_test
