// SPDX-License-Identifier: BSD-3-Clause
//
// The errors that a fit states, held against what it is off by, over random rigs: twice the
// standard error holds in 95.4 % of all cases of a normal error. `bench/fit_bench` does the same
// with four strobes over patchy floors.
#include "survey/fit/fit_errors.h"

#include "base/degrees.h"
#include "support/effort.h"
#include "support/fit_rig.h"
#include "survey/fit/fit.h"
#include "survey/simulate/floor_texture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>

namespace aphotic::fit_errors_test {
namespace {

// 90 to 97 % are asked for. Errors by halves are wide where halves differ by chance.
constexpr double kLeast = 0.90;
constexpr double kSigmas = 3.0;  // of a share's own chance

struct Drawn {
    FitRigNumbers numbers;
    std::array<std::array<double, 2>, 2> aim_deg{};
    FitSamples samples{};
};

// A third of a metre of texture, poses to 2 cm and a third of a degree.
Drawn draw(std::uint64_t seed, double contrast, int images) {
    std::mt19937_64 dice(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> even(-1.0, 1.0);
    Drawn drawn;
    drawn.numbers.width_px = 24;
    drawn.numbers.height_px = 18;
    drawn.numbers.exponent = 6.0 + 2.0 * even(dice);
    drawn.numbers.aft_power = std::exp(0.1 * normal(dice));
    drawn.numbers.multiple = std::exp(0.2 * even(dice));
    RigText text = fit_rig(drawn.numbers);
    Rig rig = text.rig();
    for (std::size_t s = 0; s < 2; ++s) {
        drawn.aim_deg[s] = {2.0 * even(dice), 2.0 * even(dice)};
        rig.strobes[s].axis = aimed_axis(
            rig,
            {drawn.aim_deg[s][0] * kRadiansPerDegree, drawn.aim_deg[s][1] * kRadiansPerDegree},
            s);
    }
    std::vector<Sled> flown;
    for (int i = 0; i < images; ++i)
        flown.push_back({.altitude_m = 2.0 + 0.7 * even(dice),
                         .pitch_rad = 4.0 * even(dice) * kRadiansPerDegree,
                         .roll_rad = 4.0 * even(dice) * kRadiansPerDegree});
    drawn.samples = fit_samples_of(rig, flown, 0.01, seed);
    drawn.samples.are_maps = false;
    for (std::size_t i = 0; i < flown.size(); ++i) {
        FitImage& image = drawn.samples.images[i];
        const FloorTexture floor(contrast, dice());
        const double level = std::exp(contrast * normal(dice));
        const double per_px =
            rig.camera.pixel_pitch_m / rig.camera.focal_length_m * flown[i].altitude_m;
        for (std::size_t k = 0; k < image.signal.size(); ++k) {
            const std::size_t place = k / kChannels;
            image.signal[k] *=
                static_cast<float>(level * floor.at(per_px * drawn.samples.places.column(place),
                                                    per_px * drawn.samples.places.row(place)));
        }
        image.sled.altitude_m += 0.02 * normal(dice);
        image.sled.pitch_rad += 0.006 * normal(dice);
        image.sled.roll_rad += 0.006 * normal(dice);
    }
    return drawn;
}

// What is looked for and known; powers have the sum of the rig that the fit begins with.
std::optional<double> truth_of(const Drawn& drawn, const FittedNumber& one) {
    const double all = 1.0 + drawn.numbers.aft_power;
    if (one.key == "strobe.fore.power") return 2.0 / all;
    if (one.key == "strobe.aft.power") return 2.0 * drawn.numbers.aft_power / all;
    if (one.key == "water.multiple") return drawn.numbers.multiple;
    for (std::size_t s = 0; s < 2; ++s) {
        const std::string aim = s == 0 ? "strobe.fore.aim_" : "strobe.aft.aim_";
        if (one.key == aim + "along_deg") return drawn.aim_deg[s][0];
        if (one.key == aim + "across_deg") return drawn.aim_deg[s][1];
    }
    return std::nullopt;
}

TEST(FitErrors, HoldAsOftenAsTheySay) {
    double within = 0.0;
    double all = 0.0;
    const int rigs = campaign(6, 60);
    for (int i = 0; i < rigs; ++i) {
        const Drawn drawn =
            draw(1000U + static_cast<std::uint64_t>(i), i % 2 == 0 ? 0.05 : 0.2, 24);
        FitRigNumbers start;
        start.width_px = drawn.numbers.width_px;
        start.height_px = drawn.numbers.height_px;
        start.aft_power = 1.0;
        FitOptions options;
        options.altitude_error_m = 0.02;
        options.attitude_error_rad = 0.006;
        options.threads = 2;
        const FitResult result = fit(fit_rig(start), drawn.samples, options, {});
        EXPECT_TRUE(result.looks_wrong.empty()) << i << ' ' << result.looks_wrong.front().what;
        for (const FittedNumber& one : result.numbers) {
            const auto truth = truth_of(drawn, one);
            if (!truth) continue;
            all += 1.0;
            within += std::abs(one.value - *truth) <= 2.0 * one.error ? 1.0 : 0.0;
        }
    }
    ASSERT_EQ(all, 7.0 * rigs);
    RecordProperty("share_within", fmt::format("{:.4f}", within / all));
    EXPECT_GT(within / all, kLeast - kSigmas * std::sqrt(kLeast * (1.0 - kLeast) / all));
}

TEST(FitErrors, PowersAreThoseOfTheRigTogether) {
    FitOptions options;
    options.free = {{"power", "water"}};
    const FitProblem problem = fit_problem(fit_rig({}), options, 1.0, 0.02);
    ASSERT_EQ(problem.numbers.size(), 5U);  // and a tint of two
    Eigen::VectorXd brighter = Eigen::VectorXd::Zero(5);
    for (std::size_t k = 0; k < 5; ++k)
        brighter(static_cast<Eigen::Index>(k)) = problem.numbers[k].word == "power" ? 0.3 : 0.0;
    const Eigen::MatrixXd keep = without_common_power(problem, {0.5, 1.5});
    EXPECT_LT((keep * brighter).norm(), 1e-15);
    brighter = Eigen::VectorXd::Ones(5) - brighter / 0.3;
    EXPECT_EQ(keep * brighter, brighter);
    // d ln(P0 / (P0 + P1)) / d ln P0 = P1 / (P0 + P1).
    EXPECT_NEAR(keep(0, 0), 0.75, 1e-15);
}

// A fit's pieces at the rig that made the images.
struct AtTheTruth {
    RigText text = fit_rig({.width_px = 16, .height_px = 12});
    FitSamples samples;
    FitOptions options{.altitude_error_m = 0.0, .attitude_error_rad = 0.0};
    FitLight light;
    FitProblem problem;
    FitObjective objective;
    FitPoint point;

    explicit AtTheTruth(FitSamples images)
        : samples(std::move(images)),
          light(text.rig(), samples.places),
          problem(fit_problem(text, options, 1.0, light.block_rad())),
          objective(text, samples, options, light, problem),
          point(objective.search(objective.first_point(), 0.05, [](int) {})) {}
};

FitSamples forty_maps() {
    std::vector<Sled> flown;
    for (int i = 0; i < 40; ++i) flown.push_back({.altitude_m = 1.4 + 0.03 * i});
    return fit_samples_of(fit_rig({.width_px = 16, .height_px = 12}).rig(), flown, 0.02, 17);
}

// Of noise that is another in each block, details are as independent as S takes them for. Of grains
// of sand that are wider than blocks, they are not.
TEST(FitErrors, DispersionIsOneOfWhiteNoise) {
    constexpr double kChance = 0.35;  // of forty images
    const auto dispersion_of = [](FitSamples samples) {
        const AtTheTruth at(std::move(samples));
        return dispersion_at(at.objective, at.point);
    };
    FitSamples samples = forty_maps();
    EXPECT_NEAR(dispersion_of(samples), 1.0, kChance);
    std::mt19937_64 dice(3);
    for (FitImage& image : samples.images) {
        constexpr double kBlock_m = 0.05;
        const FloorTexture floor(0.3, dice());
        for (std::size_t k = 0; k < image.signal.size(); ++k) {
            const std::size_t place = k / kChannels;
            image.signal[k] *= static_cast<float>(floor.at(kBlock_m * samples.places.column(place),
                                                           kBlock_m * samples.places.row(place)));
        }
    }
    EXPECT_GT(dispersion_of(samples), 1.0 + 2.0 * kChance);
}

// Halves that agree widen nothing; the errors grow as the halves differ.
TEST(FitErrors, AreWidenedByWhatHalvesDifferBy) {
    const AtTheTruth at(forty_maps());
    const auto errors_by = [&](double apart) {
        return errors_of(at.objective,
                         at.problem,
                         at.point,
                         at.problem.start.power,
                         [&](std::size_t, std::size_t which) {
                             FitPoint half = at.point;
                             half.x.array() += which == 1 ? apart : 0.0;
                             return half;
                         });
    };
    constexpr double kFar = 30.0;
    constexpr double kRounding = 1e-9;
    const FitErrors alike = errors_by(0.0);
    const FitErrors far = errors_by(kFar);
    const FitErrors twice = errors_by(2.0 * kFar);
    EXPECT_TRUE(alike.covariance.allFinite());
    for (Eigen::Index k = 0; k < alike.covariance.rows(); ++k) {
        EXPECT_GT(far.covariance(k, k), alike.covariance(k, k)) << k;
        EXPECT_NEAR(twice.covariance(k, k) / far.covariance(k, k), 4.0, kRounding) << k;
    }
    EXPECT_NEAR(twice.unevenness / far.unevenness, 2.0, kRounding);
}

// Numbers that change nothing but how bright all is leave no unevenness.
TEST(FitErrors, OfOnePowerNoMapIsUneven) {
    FitRigNumbers numbers{.width_px = 16, .height_px = 12};
    RigText rig = fit_rig(numbers);
    rig.set("strobe.aft.power", 0.0);
    FitOptions options;
    options.free = {{"power"}};
    options.hold = {"tint"};
    const FitSamples samples =
        fit_samples_of(rig.rig(), {{.altitude_m = 1.5}, {.altitude_m = 2.0}}, 0.05, 1);
    EXPECT_LT(fit(rig, samples, options, {}).unevenness, 1e-6);
}

}  // namespace
}  // namespace aphotic::fit_errors_test
