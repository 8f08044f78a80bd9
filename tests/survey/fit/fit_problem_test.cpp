// SPDX-License-Identifier: BSD-3-Clause
#include "survey/fit/fit_problem.h"

#include "base/degrees.h"
#include "base/error.h"
#include "support/fit_rig.h"
#include "support/has.h"
#include "support/refusal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace aphotic::fit_problem_test {
namespace {

constexpr double kWidest_rad = 1.0;
constexpr double kBlock_rad = 0.02;
constexpr double kRounding = 1e-12;

using Keys = std::vector<std::string>;

FitProblem problem_of(const FitOptions& options, const RigText& rig = fit_rig({})) {
    return fit_problem(rig, options, kWidest_rad, kBlock_rad);
}

// Of words other than the floor's colour, which is always free.
Keys keys_of(const FitOptions& options, const RigText& rig = fit_rig({})) {
    Keys keys;
    for (const FitNumber& one : problem_of(options, rig).numbers)
        if (one.word != "tint") keys.push_back(one.key);
    return keys;
}

FitOptions free(const Keys& words) {
    FitOptions options;
    options.free = words;
    return options;
}

const FitNumber& number_of(const FitProblem& problem, const std::string& key) {
    return *std::ranges::find(problem.numbers, key, &FitNumber::key);
}

TEST(FitProblem, TakesNumbersByWordAndByKey) {
    EXPECT_EQ(keys_of(free({"water"})), Keys{"water.multiple"});
    EXPECT_EQ(keys_of(free({"water.uniform_loss_per_m"})), Keys{"water.uniform_loss_per_m"});
    EXPECT_EQ(keys_of(free({"power"})), (Keys{"strobe.fore.power", "strobe.aft.power"}));
    const Keys two{"strobe.aft.aim_across_deg", "strobe.fore.power"};
    Keys found = keys_of(free(two));
    std::ranges::sort(found);
    EXPECT_EQ(found, two);
    // The rig's lens is radial, so its terms are.
    EXPECT_EQ(keys_of(free({"vignetting"})).size(), 3U);
}

TEST(FitProblem, HoldIsTheOppositeOfFree) {
    FitOptions options;
    const Keys all = keys_of(options);
    options.hold = {"aim", "strobe.aft.power", "tint"};
    for (const FitNumber& one : problem_of(options).numbers) {
        EXPECT_NE(one.word, "aim");
        EXPECT_NE(one.word, "tint");
        EXPECT_NE(one.key, "strobe.aft.power");
    }
    // Four aims and a power.
    EXPECT_EQ(keys_of(options).size(), all.size() - 5);
}

TEST(FitProblem, RefusesWhatNoNumberIsCalled) {
    const auto refusal = [](const FitOptions& options) -> std::string {
        return refusal_of([&] { static_cast<void>(problem_of(options)); });
    };
    FitOptions hold;
    hold.hold = {"aims"};
    FitOptions prior;
    prior.priors = {{"strobe.stern.power", 0.1}};
    const std::string words =
        "; allowed: beam, aim, power, water, vignetting, floor, tint, altitude, attitude, or one "
        "number by its key: strobe.fore.beam, strobe.fore.aim_along_deg, ";
    EXPECT_TRUE(has(refusal(free({"water.nonsense"})), "--free: found 'water.nonsense'" + words));
    EXPECT_TRUE(has(refusal(free({"water.chlorophyll_mg_m3"})),
                    "--free: found 'water.chlorophyll_mg_m3'" + words));
    EXPECT_TRUE(has(refusal(hold), "--hold: found 'aims'" + words));
    EXPECT_TRUE(has(refusal(prior), "--prior: found 'strobe.stern.power'" + words));
    EXPECT_EQ(keys_of(free({"camera.vignetting.a2"})), Keys{"camera.vignetting.a2"});
    EXPECT_TRUE(has(refusal(free({"floor"})), "only the veil tells how bright the floor is"));
}

// In the key's unit; of what is searched for as a factor, relative.
TEST(FitProblem, PriorsAreInTheKeysUnits) {
    FitOptions options;
    options.priors = {{"aim", 1.5}, {"strobe.aft.aim_along_deg", 4.0}, {"water", 0.05}};
    const FitProblem problem = problem_of(options);
    EXPECT_NEAR(number_of(problem, "strobe.fore.aim_across_deg").spread,
                1.5 * kRadiansPerDegree,
                kRounding);
    EXPECT_NEAR(
        number_of(problem, "strobe.aft.aim_along_deg").spread, 4.0 * kRadiansPerDegree, kRounding);
    EXPECT_EQ(number_of(problem, "water.multiple").spread, 0.05);
    EXPECT_TRUE(number_of(problem, "water.multiple").is_log);
}

// Where the rig is, the prior costs nothing; a spread off, it costs 1.
TEST(FitProblem, CostsASpreadOne) {
    const FitProblem problem = problem_of(free({"aim", "water"}));
    Eigen::VectorXd x = Eigen::VectorXd::Zero(std::ssize(problem.numbers));
    const auto cost = [&] { return (problem.prior_rows * x - problem.prior_means).squaredNorm(); };
    EXPECT_NEAR(cost(), 0.0, kRounding);
    for (Eigen::Index k = 0; k < x.size(); ++k) {
        x.setZero();
        x(k) = problem.numbers[static_cast<std::size_t>(k)].spread;
        EXPECT_NEAR(cost(), 1.0, kRounding) << problem.numbers[static_cast<std::size_t>(k)].key;
    }
}

TEST(FitProblem, FactorsAreSearchedForByTheirLogarithm) {
    const FitProblem problem = problem_of(free({"power"}));
    const FitNumber& aft = number_of(problem, "strobe.aft.power");
    EXPECT_DOUBLE_EQ(aft.shown(0.0), 0.8);
    EXPECT_DOUBLE_EQ(aft.shown(std::log(1.5)), 1.2);
    EXPECT_DOUBLE_EQ(aft.shown_slope(std::log(1.5)), 1.2);
}

TEST(FitProblem, TellsALampInTheRigsUnits) {
    RigText rig = fit_rig({});
    rig.erase("strobe.aft.power");
    rig.set("strobe.aft.luminous_flux_lm", 12000.0);
    const FitProblem problem = problem_of(free({"power"}), rig);
    const FitNumber& aft = number_of(problem, "strobe.aft.luminous_flux_lm");
    EXPECT_NEAR(aft.shown(0.0), 12000.0, 1e-9);
    EXPECT_NEAR(aft.shown(std::log(1.5)), 18000.0, 1e-9);
    EXPECT_NEAR(number_of(problem, "strobe.fore.power").shown(0.0), 1.0, 1e-15);
}

TEST(FitProblem, TellsALensInTheRigsUnits) {
    const RigText rig{std::filesystem::path(APHOTIC_SOURCE_DIR "/scenes/habcam-optics.toml")};
    FitOptions options = free({"beam"});
    options.beam = FitBeamKind::Optics;
    const Strobe first = rig.rig().strobes[0];
    const FitProblem problem = problem_of(options, rig);
    const FitNumber& focal_length = problem.numbers.front();
    EXPECT_EQ(focal_length.key, "strobe." + first.name + ".beam.focal_length_mm");
    EXPECT_NEAR(focal_length.shown(0.0),
                1e3 * std::get<BeamOptics>(first.beam.pattern).focal_length_m,
                1e-9);
}

TEST(FitProblem, ALensOfAnyKindIsNaturalUnlessItIsToBeRadial) {
    std::string text = fit_rig({}).text();
    const std::size_t at = text.find("vignetting");
    text.erase(at, text.find('\n', at) - at);
    const RigText none(text, "none.toml", {});
    FitOptions options = free({"vignetting"});
    EXPECT_EQ(keys_of(options, none), Keys{"camera.vignetting.cosine"});
    options.has_radial_vignetting = true;
    EXPECT_EQ(keys_of(options, none).front(), "camera.vignetting.a1");
}

TEST(FitProblem, AStrobeThatIsOffHasNoPower) {
    RigText rig = fit_rig({});
    rig.set("strobe.fore.power", 0.0);
    EXPECT_EQ(keys_of(free({"power"}), rig), Keys{"strobe.aft.power"});
}

}  // namespace
}  // namespace aphotic::fit_problem_test
