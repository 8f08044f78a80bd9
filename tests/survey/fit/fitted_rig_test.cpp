// SPDX-License-Identifier: BSD-3-Clause
//
// What is written reads back as what was fitted, whichever strobes share a beam; what was not
// fitted stays.
#include "survey/fit/fitted_rig.h"

#include "base/atomic_file.h"
#include "support/has.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <cmath>
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

// As a fit leaves it that finds the rig as it is.
FitResult start_of(const RigText& rig, const FitOptions& options) {
    FitResult result;
    result.state = fit_problem(rig, options, 1.0, 0.02).start;
    return result;
}

// Of a beam of cones: these shares of its flux, times a factor.
void set_shares(FitBeam& beam, const std::vector<double>& shares) {
    for (std::size_t k = 0; k < shares.size(); ++k) beam.coefficient(k) = shares[k];
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
    ASSERT_EQ(result.state.beams.size(), 4U);
    for (std::size_t s = 0; s < 4; ++s)
        set_shares(result.state.beams[s], {0.1 * static_cast<double>(s + 1), 0.2, 0.3});
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
    ASSERT_EQ(result.state.beams.size(), 1U);
    set_shares(result.state.beams[0], {0.5, 0.25, 0.25});
    for (const Strobe& strobe : written(rig, result).strobes)
        EXPECT_NEAR(strobe.beam.cones[0].weight, 0.5, kRounding) << strobe.name;
}

// Literal weights are those of POV-Ray's own lights, not shares of the flux.
TEST(FittedRig, SharesAreOfTheFlux) {
    const RigText rig(replaced(scene("habcam.toml").text(), "\"flux\"", "\"literal\""), "", {});
    FitResult result = start_of(rig, {.beam = FitBeamKind::Cones});
    set_shares(result.state.beams[0], {0.5, 0.25, 0.25});
    const Beam beam = written(rig, result).strobes[0].beam;
    EXPECT_EQ(beam.weights, ConeWeights::Flux);
    EXPECT_NEAR(beam.cones[1].weight, 0.25, kRounding);
}

TEST(FittedRig, LensesAreThoseThatWereFitted) {
    const RigText rig = scene("habcam-optics.toml");
    FitResult result = start_of(rig, {.beam = FitBeamKind::Optics});
    ASSERT_EQ(result.state.beams.size(), 2U);
    result.state.beams[0].coefficient(0) = 0.071;
    result.state.beams[1].coefficient(1) = 0.043;
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
    result.state.beams.front().coefficient(0) = 3.0;
    const Rig fitted = written(rig, result);
    ASSERT_EQ(fitted.strobes[0].beam.cones.size(), 1U);
    EXPECT_NEAR(fitted.strobes[0].beam.cones[0].exponent, 3.0, kRounding);
    // Half as bright at 60 degrees, without the digits that a rounding leaves.
    result.state.beams.front().coefficient(0) = 1.0;
    const TempFolder folder;
    write_fitted_rig(rig, result, folder.path());
    const std::string toml = read_text_file(folder.path() / kFittedRig);
    EXPECT_TRUE(has(toml, "fwhm_deg = 120"));
    EXPECT_FALSE(has(toml, "0000000"));

    result = start_of(rig, {.beam = FitBeamKind::Cones});
    set_shares(result.state.beams[0], {0.5, 0.25, 0.25});
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
    // Half as bright as the others, of four that together stay as bright as they were.
    result.state.power[0] *= 0.5;
    write_fitted_rig(rig, result, folder.path());
    EXPECT_NEAR(*RigText(folder.path() / kFittedRig).number("strobe.fore.luminous_flux_lm"),
                8000.0 * 4.0 / 7.0,
                1e-6);
}

TEST(FittedRig, LeavesNoBeamThatNoStrobeHas) {
    const RigText rig = scene("habcam.toml");
    const TempFolder folder;
    write_fitted_rig(rig, start_of(rig, {.beam = FitBeamKind::Cosine}), folder.path());
    const std::string toml = read_text_file(folder.path() / kFittedRig);
    EXPECT_TRUE(has(toml, "[beam.fitted]"));
    EXPECT_FALSE(has(toml, "fresnel"));
}

// cos^n of a rig without a lens's darkening.
TEST(FittedRig, HasTheLens) {
    FitOptions options;
    options.free = {{"vignetting"}};
    const RigText rig = scene("habcam.toml");
    FitResult result = start_of(rig, options);
    result.state.vignetting = {3.25};
    const Rig fitted = written(rig, result);
    EXPECT_EQ(std::get<NaturalVignetting>(*fitted.camera.vignetting).exponent, 3.25);
}

}  // namespace
}  // namespace aphotic::fitted_rig_test
