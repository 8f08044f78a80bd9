// SPDX-License-Identifier: BSD-3-Clause
//
// The fit as a user runs it: surveys simulated and maps made of a rig that is known, and a rig
// fitted to them that began elsewhere.
#include "base/degrees.h"
#include "base/npy_file.h"
#include "image/output_images.h"
#include "rig/file/rig_reader.h"
#include "support/command_test.h"
#include "support/fit_rig.h"
#include "support/mistakes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

namespace aphotic::cli_fit_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

// Of one number, its error being what it says.
constexpr double kSigmas = 4.0;
// By maps without noise, each right to 1e-4.
constexpr double kByMaps = 2e-4;
// What such a test begins with is off by more, so that it can fail.
constexpr double kAtFirst = 0.02;

const Arguments kCamera("--bayer RGGB --black-level 64 --white-level 4095");

FitRigNumbers of_few_pixels() {
    FitRigNumbers numbers;
    numbers.width_px = 96;
    numbers.height_px = 72;
    return numbers;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    const std::size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), by);
}

class CommandFit : public CommandTest {
  protected:
    // Of what made the images, and what the fit begins with.
    void write_rigs(const std::string& truth, const std::string& rig) const {
        write_text_file(path("truth.toml"), truth);
        write_text_file(path("rig.toml"), rig);
    }
    void write_rigs(const FitRigNumbers& truth, const FitRigNumbers& rig) const {
        write_rigs(fit_rig(truth).text(), fit_rig(rig).text());
    }

    // Of truth.toml, into survey.
    void fly(const Arguments& more) const { done("survey truth.toml -o survey" + more); }
    // To which that of a rig is fitted into fitted.
    [[nodiscard]] CommandResult by_images(const Arguments& more) const {
        return aphotic(
            "fit rig.toml --images survey/raw --nav survey/navigation-measured.txt -o fitted" +
            more);
    }
    // The same to three maps of truth.toml.
    [[nodiscard]] CommandResult by_maps(const Arguments& more) const {
        Arguments fit("fit rig.toml -o fitted --maps");
        for (const std::string altitude : {"1.5", "2", "2.5"}) {
            fit.push_back(altitude + ".exr");
            done(Arguments{"lightmap", "truth.toml", "--altitude", altitude, "-o", fit.back()});
        }
        return aphotic(fit + more);
    }

    [[nodiscard]] Json number(const std::string& key) const {
        const Json numbers = json_in("fitted/fit.json").at("numbers");
        const auto at =
            std::ranges::find_if(numbers, [&](const Json& one) { return one.at("key") == key; });
        return at == numbers.end() ? Json() : *at;
    }

    // By how much a correction by the rig of truth.toml's images would be off across one: of both
    // lights at 2 m, by lightmaps, which share no code with the fit's light; rms of the logarithm.
    [[nodiscard]] double unevenness(const std::string& rig) const {
        const auto logarithm_of = [&](const std::string& of) -> Eigen::ArrayXXd {
            done(Arguments{"lightmap", of, "-o", "at-2-m.exr"});
            const std::vector<float> light = read_signals(path("at-2-m.exr")).samples;
            const Eigen::Index pixels = std::ssize(light) / kChannels;
            return Eigen::ArrayXXf::Map(light.data(), pixels, kChannels).cast<double>().log();
        };
        const Eigen::ArrayXXd off = logarithm_of(rig) - logarithm_of("truth.toml");
        return std::sqrt((off.rowwise() - off.colwise().mean()).square().mean());
    }
};

TEST_F(CommandFit, LearnsARigFromASurvey) {
    FitRigNumbers numbers = of_few_pixels();
    numbers.fore_tilt_deg = 26.0;
    numbers.multiple = 1.3;
    write_rigs(of_few_pixels(), numbers);
    // Errors are widened by how far fits to halves of the images lie apart: of 20, other noise in
    // 330 of 140,000 pixels made 1.2 degrees of 0.75.
    fly("--images 40 --texture 0.005");
    const std::string out =
        done(by_images(kCamera + "--blocks 12"), "correction by this rig is expected to be even to")
            .out;
    EXPECT_TRUE(has(out, "splines fitted to 40 images\n"));
    EXPECT_TRUE(has(out, "not fitted, as the rig has them: floor\n"));

    const Json json = json_in("fitted/fit.json");
    const auto error_of = [&](const std::string& key) {
        return number(key).at("error").get<double>();
    };
    EXPECT_NEAR(number("water.multiple").at("value").get<double>(),
                1.0,
                kSigmas * error_of("water.multiple"));
    const Rig truth = read_rig(path("truth.toml"));
    const Rig fitted = read_rig(path("fitted/fitted.toml"));
    for (std::size_t s = 0; s < 2; ++s) {
        const std::string key = "strobe." + truth.strobes[s].name;
        const double error_deg =
            std::hypot(error_of(key + ".aim_along_deg"), error_of(key + ".aim_across_deg"));
        const double off_rad = std::acos(truth.strobes[s].axis.dot(fitted.strobes[s].axis));
        EXPECT_LT(kDegreesPerRadian * off_rad, kSigmas * error_deg) << key;
        EXPECT_LT(error_deg, 1.0) << key;
    }
    EXPECT_EQ(fitted.strobes[0].beam.name, "fitted");
    constexpr double kOnce = 3.0;  // one sample of an rms, of few directions at worst
    const double expected = json.at("expected_unevenness").get<double>();
    EXPECT_LT(unevenness("fitted/fitted.toml"), kOnce * expected);
    EXPECT_LT(kOnce * expected, unevenness("rig.toml"));
    const double by_rig = json.at("rig_expected_unevenness").get<double>();
    EXPECT_LT(by_rig, kOnce * unevenness("rig.toml"));
    EXPECT_LT(unevenness("rig.toml"), kOnce * by_rig);

    const Json source = json.at("fitted_to");
    EXPECT_EQ(Json({source["images"], source["block_px"], source["beam"]}), Json({40, 8, "table"}));
    constexpr double kRounding = 1e-9;
    const Json& covariance = json.at("covariance");
    for (std::size_t i = 0; i < json.at("numbers").size(); ++i) {
        const double error = json.at("numbers").at(i).at("error");
        EXPECT_EQ(covariance.at("of").at(i), json.at("numbers").at(i).at("key"));
        const double variance = covariance.at("rows").at(i).at(i);
        EXPECT_NEAR(variance, error * error, kRounding * error * error);
    }

    const std::string page = text_of("fitted/report.html");
    for (const std::string part : {"splines fitted to 40 images",
                                   "Correction by this rig is expected to be even to",
                                   "What was found",
                                   "Not fitted, as the rig has them: floor.",
                                   "Observed and fitted",
                                   "fixed pattern",
                                   "id=\"beam-0\"",
                                   "within twice its standard error",
                                   "id=\"brightness\"",
                                   "The starting rig",
                                   "aphotic fit rig.toml --images survey/raw --nav survey/"})
        EXPECT_TRUE(page.find(part) != std::string::npos) << part;
    // What fit.json and the terminal name, the page does, too.
    for (const Json& one : json.at("numbers")) {
        if (one.at("determined")) continue;
        const std::string words =
            one.at("key").get<std::string>() + " is not determined by this survey (+-";
        EXPECT_TRUE(has(out, words));
        EXPECT_TRUE(page.find(words) != std::string::npos) << words;
    }
    EXPECT_EQ(page.find(">Confounded<") != std::string::npos, !json.at("confounded").empty());
}

// The aim stays off where only powers are free.
TEST_F(CommandFit, PromisesNoEvennessWhereAPatternStays) {
    FitRigNumbers numbers = of_few_pixels();
    numbers.fore_tilt_deg += 5.0;
    write_rigs(of_few_pixels(), numbers);
    fly("--images 20 --texture 0.005");
    const std::string out =
        done(by_images(kCamera + "--blocks 12 --free power"), "no evenness is promised").out;
    const std::string page = text_of("fitted/report.html");
    EXPECT_TRUE(has(page, "So no evenness is promised"));
    for (const std::string& text : {out, page}) EXPECT_FALSE(has(text, "is expected to be even"));
}

// The rig keeps its own size.
TEST_F(CommandFit, ScalesTheRigToSmallerImages) {
    FitRigNumbers numbers = of_few_pixels();
    numbers.width_px *= 2;
    numbers.height_px *= 2;
    FitRigNumbers weaker = numbers;
    weaker.aft_power *= 0.8;
    write_rigs(numbers, weaker);
    fly("--images 20 --texture 0.005 --scale 0.5");
    const Arguments powers = kCamera + "--blocks 12 --free power";
    done(by_images(powers), "rig of 192 x 144 pixels scaled to 96 x 72\n");
    EXPECT_EQ(json_in("fitted/fit.json")["fitted_to"]["rig_scale"], 0.5);
    const Rig truth = read_rig(path("truth.toml"));
    const Rig fitted = read_rig(path("fitted/fitted.toml"));
    EXPECT_EQ(fitted.camera.width_px, truth.camera.width_px);
    const auto ratio_of = [](const Rig& rig) {
        return rig.strobes[0].power / rig.strobes[1].power;
    };
    const double error = number("strobe.fore.power").at("error").get<double>();
    constexpr double kOfBoth = 2.0;  // what one has more, the other has less
    EXPECT_NEAR(ratio_of(fitted), ratio_of(truth), kOfBoth * kSigmas * error);
    EXPECT_GT(ratio_of(read_rig(path("rig.toml"))) - ratio_of(truth), kOfBoth * kSigmas * error);
    // So does a rig that is smaller by its own scale.
    done(by_images(powers + "--set camera.scale=0.25"), "fitted to 20 images");
    // A part of the rig's own image is not its whole one, smaller.
    done("survey truth.toml --images 2 -o whole");
    refused(Arguments("fit rig.toml --images whole/raw --nav whole/navigation-measured.txt -o part "
                      "--crop 0,0,96,72") +
                kCamera,
            "--crop: found 96 x 72 of files that have the rig's 192 x 144 pixels");
}

// Without a navigation: depths along the axis are those of the true poses. Of one image the map is
// missing, of another it is empty from row 24 on, but for what the plane around fills; and at one a
// strobe was out.
TEST_F(CommandFit, TakesTheFloorOfEachImageFromItsDepthMap) {
    FitRigNumbers numbers = of_few_pixels();
    numbers.fore_tilt_deg += 2.0;
    write_rigs(of_few_pixels(), numbers);
    fly("--images 20 --texture 0.005 --truth depth");
    done("survey truth.toml --set strobe.aft.power=0.01 --images 20 --texture 0.005 -o unlit");
    fs::copy_file(path("unlit/raw/000007.tif"),
                  path("survey/raw/000007.tif"),
                  fs::copy_options::overwrite_existing);
    fs::remove(path("survey/depth/000003.exr"));
    fs::remove(path("survey/depth/000005.exr"));
    std::vector<float> third(std::size_t{96} * 72, 0.0F);
    std::fill_n(third.begin(), std::size_t{96} * 24, 2.0F);
    write_npy(path("survey/depth/000005.npy"), {72, 96}, third);
    const Arguments fit = "fit rig.toml --images survey/raw --depth-map survey/depth -o fitted" +
                          kCamera + "--blocks 12 --allow-skipped 2";
    const CommandResult run = done(aphotic(fit), "splines fitted to 17 images\n");
    EXPECT_TRUE(has(run.err, "000003.tif: found no depth map for it in survey/depth; allowed: "));
    EXPECT_TRUE(has(run.err,
                    "000005.tif: found 36 of 108 blocks with one plane that every strobe lights; "
                    "allowed: half or more; skipped"));
    EXPECT_TRUE(has(run.err, "000007.tif: strobe aft did not fire"));
    const Json aim = number("strobe.fore.aim_along_deg");
    const double error_deg = aim.at("error").get<double>();
    EXPECT_NEAR(
        aim.at("value").get<double>(), 2.0 * std::cos(std::atan2(0.1, 0.5)), kSigmas * error_deg);
    EXPECT_LT(error_deg, 0.5);
    const Json json = json_in("fitted/fit.json");
    EXPECT_EQ(json.at("depth").at("is"), "axis");
    for (const Json& image : json.at("images")) {
        EXPECT_EQ(image.at("altitude_off_m").get<double>(), 0.0);
        EXPECT_GT(image.at("altitude_m").get<double>(), 1.2);  // 1.3 to 3.2 were flown
    }
}

// A level mesh 20 m deep, over which each image is placed by its depth; altitudes are wrong.
TEST_F(CommandFit, TakesTheFloorFromAMesh) {
    FitRigNumbers numbers = of_few_pixels();
    numbers.fore_tilt_deg += 2.0;
    write_rigs(of_few_pixels(), numbers);
    fly("--images 16 --texture 0.005 --pitch 0,0 --roll 0,0");
    write_file(path("level.ply"),
               "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
               "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
               "end_header\n-50 -50 -20\n50 -50 -20\n50 50 -20\n-50 50 -20\n4 0 1 2 3\n");
    std::istringstream flown(text_of("survey/navigation.txt"));
    std::string image;
    std::getline(flown, image);  // the header
    std::string nav = "image,altitude_m,pitch_deg,roll_deg,east_m,north_m,heading_deg,depth_m\n";
    for (std::string rest; std::getline(flown, image, ',') && std::getline(flown, rest);)
        nav += fmt::format("{},3.5,0,0,3,4,30,{}\n", image, 20.0 - std::stod(rest));
    write_file(path("nav.csv"), nav);
    done(aphotic("fit rig.toml --images survey/raw --nav nav.csv --relief level.ply -o fitted" +
                 kCamera + "--blocks 12"),
         "splines fitted to 16 images\n");
    const Json aim = number("strobe.fore.aim_along_deg");
    const double error_deg = aim.at("error").get<double>();
    EXPECT_NEAR(
        aim.at("value").get<double>(), 2.0 * std::cos(std::atan2(0.1, 0.5)), kSigmas * error_deg);
    EXPECT_LT(error_deg, 0.5);
    const Json water = number("water.multiple");
    EXPECT_NEAR(water.at("value").get<double>(), 1.0, kSigmas * water.at("error").get<double>());
    const Json json = json_in("fitted/fit.json");
    for (const Json& one : json.at("images"))
        EXPECT_EQ(one.at("altitude_off_m").get<double>(), 0.0);
}

// A lamp of a millionth of the light has no aim that anybody sees.
TEST_F(CommandFit, NamesWhatThePriorAloneTells) {
    FitRigNumbers numbers = of_few_pixels();
    numbers.aft_power = 1e-6;
    write_rigs(numbers, numbers);
    fly("--images 10 --texture 0.02");
    const CommandResult run = done(
        by_images(kCamera + "--blocks 8 --free aim,water --hold strobe.fore.aim_across_deg,tint "
                            "--prior aim=3deg,water=0.001"),
        "strobe.aft.aim_along_deg is not determined by this survey (+-");
    EXPECT_TRUE(has(run.out, "water.multiple is not determined by this survey (+-0.001"));
    constexpr double kUnseen_deg = 0.01;
    constexpr double kOfPrior = 0.05;  // halves that agree by chance, too
    const Json aft = number("strobe.aft.aim_along_deg");
    EXPECT_EQ(aft.at("determined"), false);
    EXPECT_NEAR(aft.at("value").get<double>(), 0.0, kUnseen_deg);
    EXPECT_NEAR(aft.at("error").get<double>(), 3.0, 3.0 * kOfPrior);
    // What is known well beforehand stays.
    EXPECT_EQ(number("water.multiple").at("determined"), false);
    EXPECT_NEAR(number("water.multiple").at("value").get<double>(), 1.0, kSigmas * 0.001);
    // The other lamp's is seen, as far as it is free.
    EXPECT_EQ(number("strobe.fore.aim_along_deg").at("determined"), true);
    for (const char* held : {"strobe.fore.aim_across_deg", "floor.redness", "strobe.fore.power"})
        EXPECT_TRUE(number(held).is_null()) << held;
    EXPECT_TRUE(has(run.out, "not fitted, as the rig has them: beam, power, vignetting, floor\n"));
}

// Each kind of beam and lens makes up for what the rig has wrong of it, so that its light is the
// truth's.
TEST_F(CommandFit, FindsBeamsAndLensesOfEveryKind) {
    const std::string smooth = fit_rig(of_few_pixels()).text();
    const auto of_cones = [&](const std::string& cones) {
        return replaced(smooth, "weight = 1.0, exponent = 6 }", cones + " }");
    };
    const std::string rim = ", { part = \"rim\", half_angle_deg = 90.0, exponent = 2.0, weight = ";
    const auto of_lens = [&](const std::string& focal_length_mm) {
        return replaced(of_cones(""),
                        "cones = [{ part = \"all\", half_angle_deg = 90.0,  }]",
                        "diffuser_mm = [30.0, 60.0]\naperture_mm = 60.0\ndistance_mm = 40.0\n"
                        "focal_length_mm = " +
                            focal_length_mm);
    };
    const auto of_vignetting = [&](const std::string& lens) {
        return replaced(smooth, "radial = [-0.1, 0.0, 0.0]", lens);
    };
    const std::string broad_aft =
        replaced(smooth, "beam = \"smooth\"\npower", "beam = \"broad\"\npower") +
        "[beam.broad]\ncones = [{ part = \"all\", half_angle_deg = 90.0, weight = 1.0 }]\n";
    const std::string narrow = of_cones("weight = 1.0, exponent = 4.0");
    const std::string core = "exponent = 12.0, weight = ";
    struct Kind {
        std::string options;
        std::string truth;
        std::string rig;
    };
    for (const auto& [options, truth, rig] : std::vector<Kind>{
             {"beam", smooth, narrow},
             {"beam --beam cosine", smooth, narrow},
             {"beam --beam cones",
              of_cones(core + "0.7 }" + rim + "0.3"),
              of_cones(core + "0.5 }" + rim + "0.5")},
             {"beam --beam optics", of_lens("50.0"), of_lens("47.0")},
             {"beam,power --beam cosine --beam-each", broad_aft, smooth},
             {"vignetting", of_vignetting("cosine = 4.0"), of_vignetting("cosine = 3.0")},
             {"vignetting --vignetting radial",
              of_vignetting("cosine = 4.0"),
              of_vignetting("cosine = 3.0")},
             {"vignetting", smooth, of_vignetting("radial = [-0.3, 0.0, 0.0]")}}) {
        SCOPED_TRACE(options);
        write_rigs(truth, rig);
        const std::string out = done(by_maps("--hold tint --blocks 24 --free " + options)).out;
        EXPECT_FALSE(has(out, "is not round"));
        EXPECT_GT(unevenness("rig.toml"), kAtFirst);
        EXPECT_LT(unevenness("fitted/fitted.toml"), kByMaps);
        // No beam is left that no strobe has.
        const std::string fitted = text_of("fitted/fitted.toml");
        EXPECT_EQ(has(fitted, "[beam.smooth]"), !has(options, "beam")) << fitted;
        EXPECT_EQ(has(fitted, "[beam.fitted-2]"), has(options, "--beam-each")) << fitted;
        EXPECT_EQ(has(fitted, "radial"), has(rig + options, "radial")) << fitted;
        fs::remove_all(path("fitted"));
    }
    // A table is round.
    write_rigs(of_lens("50.0"), of_lens("50.0"));
    done(by_maps("--blocks 12 --free beam"),
         "beam 'smooth' of fore is not round, the fitted one is: --hold beam keeps the rig's\n");
}

// Together as much as before, shared out as the truth has it.
TEST_F(CommandFit, LeavesLumensLumens) {
    const std::string toml = replaced(fit_rig(of_few_pixels()).text(),
                                      "name = \"fore\"",
                                      "name = \"fore\"\nluminous_flux_lm = 10000.0");
    write_rigs(replaced(toml, "power = 0.8", "luminous_flux_lm = 8000.0"),
               replaced(toml, "power = 0.8", "luminous_flux_lm = 9000.0"));
    const std::string out = done(by_maps("--free power --hold tint --blocks 24 --json")).out;
    EXPECT_EQ(out, text_of("fitted/fit.json"));
    EXPECT_EQ(json_in("fitted/fit.json").at("fitted_to").at("maps"), 3);
    const std::string fitted = text_of("fitted/fitted.toml");
    EXPECT_FALSE(has(fitted, "power")) << fitted;
    const auto expect_lumens = [&](const std::string& strobe, double lumens) {
        const std::string key = "luminous_flux_lm = ";
        const std::size_t at = fitted.find(key, fitted.find(strobe)) + key.size();
        EXPECT_NEAR(std::stod(fitted.substr(at)), lumens, lumens * kByMaps) << strobe;
    };
    expect_lumens("\"fore\"", 19000.0 / 1.8);
    expect_lumens("\"aft\"", 19000.0 * 0.8 / 1.8);
}

// Exposed so that the floor's middle fills twice what a pixel holds.
TEST_F(CommandFit, FindsOutASaturatedSurvey) {
    write_rigs(FitRigNumbers{}, FitRigNumbers{});
    fly("--images 8 --floor-share 2");
    const Arguments untold("--bayer RGGB --black-level 64 --free aim --blocks 8");
    const CommandResult run = done(by_images(untold), "looks wrong: white-level:");
    EXPECT_TRUE(has(run.err, "looks wrong: white-level:"));
    fs::remove_all(path("fitted"));
    refused(by_images(untold + "--strict"), "white-level");
    EXPECT_FALSE(fs::exists(path("fitted")));
    // Told, saturated samples are left out, which is said once the fit is done.
    done(
        by_images(untold + "--white-level 4095 --strict"), "looks wrong: saturation:", kAnswerIsNo);
    EXPECT_TRUE(has(text_of("fitted/report.html"), ">Warnings<"));
    EXPECT_EQ(json_in("fitted/fit.json").at("looks_wrong").size(), 1U);
}

// Red over blue falls as water's red does: in images whose mosaic is read as its mirror image it
// rises. That is found out before the minutes that the fit takes.
TEST_F(CommandFit, FindsOutRedForBlue) {
    write_rigs(of_few_pixels(), of_few_pixels());
    fly("--images 12 --texture 0.1");
    const Arguments options("--black-level 64 --white-level 4095 --free aim --blocks 8 --strict");
    const CommandResult wrong =
        refused(by_images(options + "--bayer BGGR"), "bayer: red over blue varies");
    EXPECT_TRUE(has(wrong.err, "--bayer RGGB corrects this"));
    EXPECT_FALSE(fs::exists(path("fitted")));
    done(by_images(options + "--bayer RGGB"));
}

TEST_F(CommandFit, SaysOfAllImagesAtOnceThatNoneCanBeRead) {
    write_rigs(FitRigNumbers{}, FitRigNumbers{});
    fly("--images 3");
    const CommandResult run = refused(by_images({}),
                                      "aphotic: none of the 3 images examined can be read; 000001: "
                                      "found one channel and no --bayer; allowed: ");
    EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
    EXPECT_FALSE(fs::exists(path("fitted")));
}

TEST_F(CommandFit, SaysWhatItNeeds) {
    write_rigs(FitRigNumbers{}, FitRigNumbers{});
    done("lightmap rig.toml -o a.exr");
    const std::string object =
        "[[object]]\nname = \"ball\"\nshape = \"sphere\"\ncentre_m = [0.0, 0.0, 1.8]\n"
        "radius_m = 0.1\nreflectance = \"sand\"\n";
    write_text_file(path("ball.toml"), fit_rig({}).text() + object);
    for (const Mistake& mistake : mistakes_in("cli/mistakes/fit.txt", 29)) {
        SCOPED_TRACE(testing::PrintToString(mistake));
        const auto& [command, rest] = mistake.parts.front();
        const CommandResult run = refused(command + " " + rest, mistake.message);
        EXPECT_LE(std::ranges::count(run.err, '\n'), 2) << run.err;
    }
    // Before the images are read, which take longer.
    refused(
        "fit rig.toml --maps b.exr -o rig.toml/in", "rig.toml/in: cannot be created: ", kRunFailed);
    fs::rename(path("rig.toml"), path("fitted.toml"));
    refused("fit fitted.toml --maps a.exr -o .",
            "--output: found the folder of fitted.toml, which would be replaced; allowed: another");
}

}  // namespace
}  // namespace aphotic::cli_fit_test
