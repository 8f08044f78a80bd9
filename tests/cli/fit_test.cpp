// SPDX-License-Identifier: BSD-3-Clause
//
// A survey simulated, a rig fitted to it, and the files that this leaves.
#include "base/atomic_file.h"
#include "rig/rig_reader.h"
#include "support/fit_rig.h"
#include "support/run_command.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

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

TEST(CommandFit, LearnsARigFromASurvey) {
    const TempFolder folder;
    FitRigNumbers numbers = of_few_pixels();
    write_text_file(folder.path() / "truth.toml", fit_rig(numbers).text());
    numbers.fore_tilt_deg = 23.0;
    numbers.multiple = 1.3;
    write_text_file(folder.path() / "rig.toml", fit_rig(numbers).text());
    const CommandResult survey = run_aphotic(
        folder.path(),
        {"survey", "truth.toml", "--images", "30", "--texture", "0.02", "-o", "survey"});
    ASSERT_EQ(survey.status, 0) << survey.err;
    const CommandResult fit = run_aphotic(folder.path(),
                                          {"fit",
                                           "rig.toml",
                                           "--images",
                                           "survey/raw",
                                           "--nav",
                                           "survey/navigation-measured.txt",
                                           "--bayer",
                                           "RGGB",
                                           "--black-level",
                                           "64",
                                           "--white-level",
                                           "4095",
                                           "--blocks",
                                           "12",
                                           "--parts",
                                           "8",
                                           "-o",
                                           "fitted",
                                           "--json"});
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
    EXPECT_NE(read_text_file(folder.path() / "fitted/report.html").find("Observed and fitted"),
              std::string::npos);
}

// Exposed so that the floor's middle fills twice what a pixel holds.
TEST(CommandFit, FindsOutASaturatedSurvey) {
    const TempFolder folder;
    write_text_file(folder.path() / "rig.toml", fit_rig({}).text());
    const CommandResult survey =
        run_aphotic(folder.path(),
                    {"survey", "rig.toml", "--images", "12", "--floor-share", "2", "-o", "survey"});
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
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "fitted"));
}

}  // namespace
}  // namespace aphotic::cli_fit_test
