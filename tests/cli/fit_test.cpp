// SPDX-License-Identifier: BSD-3-Clause
//
// A survey simulated, a rig fitted to it, and the files that this leaves.
#include "base/atomic_file.h"
#include "rig/file/rig_reader.h"
#include "support/fit_rig.h"
#include "support/run_command.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace aphotic::cli_fit_test {
namespace {

// Of one number, its error being what it says.
constexpr double kSigmas = 4.0;

FitRigNumbers of_few_pixels() {
    FitRigNumbers numbers;
    numbers.width_px = 96;
    numbers.height_px = 72;
    return numbers;
}

// Of truth.toml at three altitudes, made and named last on the command line.
void add_maps(const TempFolder& folder, std::vector<std::string>& command) {
    for (const std::string altitude : {"1.5", "2", "2.5"}) {
        command.push_back(altitude + ".exr");
        const CommandResult map =
            run_aphotic(folder.path(),
                        {"lightmap", "truth.toml", "--altitude", altitude, "-o", command.back()});
        ASSERT_EQ(map.status, 0) << map.err;
    }
}

TEST(CommandFit, LearnsARigFromASurvey) {
    const TempFolder folder;
    FitRigNumbers numbers = of_few_pixels();
    write_text_file(folder.path() / "truth.toml", fit_rig(numbers).text());
    numbers.fore_tilt_deg = 23.0;
    numbers.multiple = 1.3;
    write_text_file(folder.path() / "rig.toml", fit_rig(numbers).text());
    const CommandResult survey = run_aphotic(
        folder.path(),
        {"survey", "truth.toml", "--images", "20", "--texture", "0.02", "-o", "survey"});
    ASSERT_EQ(survey.status, 0) << survey.err;
    const CommandResult fit = run_aphotic(
        folder.path(), {"fit",        "rig.toml",       "--images",
                        "survey/raw", "--nav",          "survey/navigation-measured.txt",
                        "--bayer",    "RGGB",           "--black-level",
                        "64",         "--white-level",  "4095",
                        "--free",     "beam,aim,water", "--blocks",
                        "12",         "--parts",        "8",
                        "-o",         "fitted",         "--json"});
    ASSERT_EQ(fit.status, 0) << fit.err;
    const auto json = nlohmann::json::parse(fit.out);
    const auto& covariance = json.at("covariance");
    for (std::size_t i = 0; i < json.at("numbers").size(); ++i) {
        const auto& one = json.at("numbers").at(i);
        const std::size_t row = covariance.at("of").size() - json.at("numbers").size() + i;
        EXPECT_EQ(covariance.at("of").at(row), one.at("key"));
        EXPECT_NEAR(std::sqrt(covariance.at("rows").at(row).at(row).get<double>()),
                    one.at("error").get<double>(),
                    1e-9 * one.at("error").get<double>());
    }
    bool is_found = false;
    for (const auto& one : json.at("numbers")) {
        if (one.at("key") != "strobe.fore.aim_along_deg") continue;
        is_found = true;
        const double error = one.at("error");
        EXPECT_NEAR(
            one.at("value").get<double>(), 3.0 * std::cos(std::atan2(0.1, 0.5)), kSigmas * error);
        EXPECT_LT(error, 1.0);
    }
    EXPECT_TRUE(is_found);
    EXPECT_EQ(read_text_file(folder.path() / "fitted/fit.json"), fit.out);
    EXPECT_EQ(read_rig(folder.path() / "fitted/fitted.toml").strobes[0].beam.name, "fitted");
    EXPECT_EQ(json.at("fitted_to").at("images"), 20);
    EXPECT_EQ(json.at("fitted_to").at("block_px"), 8);
    EXPECT_EQ(json.at("fitted_to").at("beam"), "table");
    EXPECT_EQ(json.at("fitted_to").at("parts"), 8);
    const std::string page = read_text_file(folder.path() / "fitted/report.html");
    for (const char* part : {" and a beam of 8 splines fitted to 20 images",
                             "Observed and fitted",
                             "strobe.fore.aim_along_deg",
                             "within twice its standard error",
                             "id=\"beam-0\"",
                             "id=\"residuals\"",
                             "Not fitted, as the rig has them: ",
                             "From image to image"})
        EXPECT_NE(page.find(part), std::string::npos) << part;
    // What fit.json holds and warns of, the page does, too.
    const auto times = [&](std::string_view words) {
        std::size_t count = 0;
        for (std::size_t at = 0; (at = page.find(words, at)) != std::string::npos; ++at) ++count;
        return count;
    };
    EXPECT_EQ(times("Held: "), json.at("held").size());
    EXPECT_EQ(times(">Warnings<"), json.at("looks_wrong").empty() ? 0U : 1U);
    EXPECT_EQ(times(">Confounded<"), json.at("confounded").empty() ? 0U : 1U);
}

// Exposed so that the floor's middle fills twice what a pixel holds.
TEST(CommandFit, FindsOutASaturatedSurvey) {
    const TempFolder folder;
    write_text_file(folder.path() / "rig.toml", fit_rig({}).text());
    const CommandResult survey =
        run_aphotic(folder.path(),
                    {"survey", "rig.toml", "--images", "8", "--floor-share", "2", "-o", "survey"});
    ASSERT_EQ(survey.status, 0) << survey.err;
    const auto fit = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"fit",
                                           "rig.toml",
                                           "--images",
                                           "survey/raw",
                                           "--nav",
                                           "survey/navigation.txt",
                                           "--bayer",
                                           "RGGB",
                                           "--black-level",
                                           "64",
                                           "--free",
                                           "aim",
                                           "--blocks",
                                           "8",
                                           "-o",
                                           "fitted"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run_aphotic(folder.path(), arguments);
    };
    CommandResult run = fit({});
    EXPECT_EQ(run.status, 0);
    EXPECT_NE(run.err.find("looks wrong: white-level:"), std::string::npos) << run.err;
    EXPECT_NE(run.out.find("looks wrong: white-level:"), std::string::npos) << run.out;
    std::filesystem::remove_all(folder.path() / "fitted");
    run = fit({"--strict"});
    EXPECT_EQ(run.status, 2);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "fitted"));
    // Told, saturated blocks are left out, which is said once the fit is done.
    run = fit({"--white-level", "4095", "--strict"});
    EXPECT_EQ(run.status, 1) << run.err;
    EXPECT_NE(run.out.find("looks wrong: saturation:"), std::string::npos) << run.out;
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "fitted/fit.json"));
}

// Maps by observe of few images keep their floors' texture, which errors take for noise; those by
// lightmap have none.
TEST(CommandFit, SaysOfMapsWhatTheyHaveKept) {
    const TempFolder folder;
    write_text_file(folder.path() / "rig.toml", fit_rig(of_few_pixels()).text());
    const auto run = [&](const std::vector<std::string>& arguments) {
        CommandResult result = run_aphotic(folder.path(), arguments);
        EXPECT_EQ(result.status, 0) << result.err;
        return result;
    };
    run({"survey", "rig.toml", "--images", "24", "--texture", "0.1", "-o", "survey"});
    std::vector<std::string> observed{"fit", "rig.toml", "--free", "aim", "-o", "a", "--maps"};
    std::vector<std::string> modelled{"fit", "rig.toml", "--free", "aim", "-o", "b", "--maps"};
    for (const std::string altitude : {"1.5", "2", "2.5"}) {
        const std::string map = "observed" + altitude + ".exr";
        run({"observe",
             "survey/raw",
             "--nav",
             "survey/navigation.txt",
             "--altitude",
             altitude,
             "--within",
             "0.3",
             "--bayer",
             "RGGB",
             "--black-level",
             "64",
             "--demosaic",
             "-o",
             map});
        observed.push_back(map);
        modelled.push_back("modelled" + altitude + ".exr");
        run({"lightmap", "rig.toml", "--altitude", altitude, "-o", modelled.back()});
    }
    EXPECT_NE(run(observed).out.find("looks wrong: maps: neighbouring blocks"), std::string::npos);
    const std::string well = run(modelled).out;
    EXPECT_EQ(well.find("looks wrong"), std::string::npos) << well;
    EXPECT_NE(well.find("not fitted, as the rig has them: beam, power, water, vignetting, floor, "
                        "altitude, attitude, gain\n"),
              std::string::npos)
        << well;
}

TEST(CommandFit, SaysOfAllImagesAtOnceThatNoneCanBeRead) {
    const TempFolder folder;
    write_text_file(folder.path() / "rig.toml", fit_rig({}).text());
    const CommandResult survey =
        run_aphotic(folder.path(), {"survey", "rig.toml", "--images", "3", "-o", "survey"});
    ASSERT_EQ(survey.status, 0) << survey.err;
    const CommandResult run = run_aphotic(folder.path(),
                                          {"fit",
                                           "rig.toml",
                                           "--images",
                                           "survey/raw",
                                           "--nav",
                                           "survey/navigation.txt",
                                           "-o",
                                           "fitted"});
    EXPECT_EQ(run.status, 2);
    EXPECT_EQ(run.err.find("aphotic: none of the 3 images looked at can be read; 000001: found one "
                           "channel and no --bayer; allowed: "),
              0U)
        << run.err;
    EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "fitted"));
}

// Red over blue falls as water's red does: in images whose mosaic is read as its mirror image it
// rises. That is found out before the minutes that the fit takes.
TEST(CommandFit, FindsOutRedForBlue) {
    const TempFolder folder;
    write_text_file(folder.path() / "rig.toml", fit_rig(of_few_pixels()).text());
    const CommandResult survey =
        run_aphotic(folder.path(),
                    {"survey", "rig.toml", "--images", "12", "--texture", "0.1", "-o", "survey"});
    ASSERT_EQ(survey.status, 0) << survey.err;
    const auto fit = [&](const std::string& pattern) {
        return run_aphotic(folder.path(),
                           {"fit",
                            "rig.toml",
                            "--images",
                            "survey/raw",
                            "--nav",
                            "survey/navigation-measured.txt",
                            "--bayer",
                            pattern,
                            "--black-level",
                            "64",
                            "--white-level",
                            "4095",
                            "--free",
                            "aim",
                            "--blocks",
                            "8",
                            "--strict",
                            "-o",
                            pattern});
    };
    const CommandResult right = fit("RGGB");
    EXPECT_EQ(right.status, 0) << right.out << right.err;
    const CommandResult wrong = fit("BGGR");
    EXPECT_EQ(wrong.status, 2) << wrong.out;
    EXPECT_NE(wrong.err.find("bayer: red over blue varies"), std::string::npos) << wrong.err;
    EXPECT_NE(wrong.err.find("--bayer RGGB puts them right"), std::string::npos) << wrong.err;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "BGGR"));
}

// Two lamps that differ: by one beam for both neither is right.
TEST(CommandFit, GivesEachStrobeABeamOfItsOwn) {
    const TempFolder folder;
    std::string toml = fit_rig(of_few_pixels()).text();
    write_text_file(folder.path() / "rig.toml", toml);
    toml.replace(toml.rfind("beam = \"smooth\""), 15, "beam = \"broad\"");
    toml += "[beam.broad]\ncones = [{ part = \"all\", half_angle_deg = 90.0, weight = 1.0 }]\n";
    write_text_file(folder.path() / "truth.toml", toml);
    std::vector<std::string> fit{"fit",
                                 "rig.toml",
                                 "--free",
                                 "beam,power",
                                 "--beam-each",
                                 "--beam",
                                 "cosine",
                                 "--blocks",
                                 "16",
                                 "-o",
                                 "fitted",
                                 "--maps"};
    add_maps(folder, fit);
    const CommandResult run = run_aphotic(folder.path(), fit);
    ASSERT_EQ(run.status, 0) << run.err;
    const Rig fitted = read_rig(folder.path() / "fitted/fitted.toml");
    EXPECT_EQ(fitted.strobes[0].beam.name, "fitted-1");
    EXPECT_EQ(fitted.strobes[1].beam.name, "fitted-2");
    constexpr double kOff = 0.02;  // of exponents, by maps without noise
    EXPECT_NEAR(fitted.strobes[0].beam.cones.at(0).exponent, 6.0, 6.0 * kOff);
    EXPECT_NEAR(fitted.strobes[1].beam.cones.at(0).exponent, 1.0, kOff);
}

// A plate of LEDs in a lens' focus but for its focal length, which is told wrong.
TEST(CommandFit, FindsALensByItsOptics) {
    const TempFolder folder;
    const auto with_lens = [&](const std::string& name, double focal_length_mm) {
        std::string toml = fit_rig(of_few_pixels()).text();
        const std::size_t cones = toml.find("cones = ");
        toml.replace(cones,
                     toml.find('\n', cones) - cones,
                     fmt::format("diffuser_mm = [30.0, 60.0]\naperture_mm = 60.0\n"
                                 "focal_length_mm = {}\ndistance_mm = 40.0",
                                 focal_length_mm));
        write_text_file(folder.path() / name, toml);
    };
    with_lens("truth.toml", 50.0);
    with_lens("rig.toml", 47.0);
    std::vector<std::string> fit{
        "fit", "rig.toml", "--free", "beam", "--beam", "optics", "-o", "fitted", "--maps"};
    add_maps(folder, fit);
    const CommandResult run = run_aphotic(folder.path(), fit);
    ASSERT_EQ(run.status, 0) << run.err;
    const Rig fitted = read_rig(folder.path() / "fitted/fitted.toml");
    const auto& optics = std::get<BeamOptics>(fitted.strobes[0].beam.pattern);
    constexpr double kOff = 0.01;
    EXPECT_NEAR(optics.focal_length_m / 0.050, 1.0, kOff);
    EXPECT_NEAR(optics.distance_m / 0.040, 1.0, kOff);
}

TEST(CommandFit, SaysWhatItNeeds) {
    const TempFolder folder;
    write_text_file(folder.path() / "rig.toml", fit_rig({}).text());
    CommandResult run = run_aphotic(folder.path(), {"fit", "rig.toml", "-o", "fitted"});
    EXPECT_EQ(run.status, 2);
    EXPECT_EQ(run.err,
              "aphotic: found neither --maps nor --images; allowed: either --maps or --images\n");
    run = run_aphotic(folder.path(), {"fit", "rig.toml", "--images", ".", "-o", "fitted"});
    EXPECT_EQ(run.status, 2);
    EXPECT_EQ(run.err, "aphotic: --images: found no navigation; allowed: with --nav FILE\n");
    const auto refused = [&](const std::vector<std::string>& more, const std::string& why) {
        std::vector<std::string> all{"fit", "rig.toml", "--maps", "a.exr", "-o", "fitted"};
        all.insert(all.end(), more.begin(), more.end());
        run = run_aphotic(folder.path(), all);
        EXPECT_EQ(run.status, 2);
        EXPECT_EQ(run.err, "aphotic: " + why + "\n");
    };
    refused({"--nav", "a.txt"}, "--nav: found with --maps; allowed: with --images");
    refused({"--bayer", "RGGB"}, "--bayer: found with --maps; allowed: with --images");
    for (const std::vector<std::string>& of_beams :
         {std::vector<std::string>{"--beam", "cosine"}, {"--beam-each"}, {"--parts", "20"}}) {
        std::vector<std::string> held = of_beams;
        held.insert(held.end(), {"--free", "aim,water"});
        refused(
            held,
            of_beams[0] + ": found with a beam that is not fitted; allowed: with beam in --free");
    }
    refused({"--parts", "20", "--beam", "cosine"},
            "--parts: found with another beam; allowed: with --beam table");
    refused({}, "a.exr: cannot be read: No such file or directory");
    // Before the images are read, which take longer.
    run = run_aphotic(folder.path(), {"fit", "rig.toml", "--maps", "a.exr", "-o", "rig.toml/in"});
    EXPECT_EQ(run.status, 3);
    EXPECT_NE(run.err.find("rig.toml/in: cannot be created: "), std::string::npos) << run.err;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "fitted"));

    std::filesystem::rename(folder.path() / "rig.toml", folder.path() / "fitted.toml");
    run = run_aphotic(folder.path(), {"fit", "fitted.toml", "--maps", "a.exr", "-o", "."});
    EXPECT_EQ(run.status, 2);
    EXPECT_EQ(run.err,
              "aphotic: --output: found the folder of fitted.toml, which would be replaced; "
              "allowed: another\n");
}

}  // namespace
}  // namespace aphotic::cli_fit_test
