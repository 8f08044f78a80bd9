// SPDX-License-Identifier: BSD-3-Clause
//
// Of a mean the jackknife's variance is the sample's over its size, and what its groups' means
// scatter by where groups are left out.
#include "survey/fit_jackknife.h"

#include "support/fit_rig.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace aphotic::fit_jackknife_test {
namespace {

// Signals are floats, whose rounding is some ten-thousandths of what images differ by.
constexpr double kFloats = 1e-3;

// How bright each image is over the first: all that is fitted is their mean, for their noise is
// alike.
const std::vector<double> kBrightness{
    1.0, 1.0002, 0.9999, 1.0004, 0.9996, 1.0001, 1.0003, 0.9998, 1.0, 0.9997, 1.0002, 1.0005};

double variance_by_jackknife(std::size_t groups) {
    FitRigNumbers numbers;
    numbers.width_px = 8;
    numbers.height_px = 6;
    const RigText text = fit_rig(numbers);
    const Rig rig = text.rig();
    FitProblem problem;
    problem.state.beams = {FitBeam::held(rig.strobes[0].beam)};
    problem.state.beam_of = {0, 0};
    problem.state.aim_rad = {{0.0, 0.0}, {0.0, 0.0}};
    problem.state.power = {1.0, 0.8};

    const Sled sled{.altitude_m = 2.0};
    FitSamples samples = fit_samples_of(rig, {sled}, 0.0, 1);
    const FitImage first = samples.images.front();
    samples.images.clear();
    for (const double brightness : kBrightness) {
        samples.images.push_back(first);
        for (float& value : samples.images.back().signal) value *= static_cast<float>(brightness);
    }
    const FitLight light(rig, samples.places);
    FitEquations equations(light, samples, 1);
    equations.assume_noise();
    const LightOf light_of = [&](const FitState& state) {
        return PathLight(text, state.water, state.floor, light.paths({sled}), true);
    };
    const auto parts = equations.parts(problem.state, light_of(problem.state));
    const Eigen::VectorXd shares = Eigen::VectorXd::Constant(1, parts.b(0) / parts.G(0, 0));
    return jackknife(equations, problem, light_of, shares, groups, {})(0) /
           std::pow(shares(0), 2.0);
}

double mean_of(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// Sum of squares about the mean, over n (n - 1).
double variance_of_mean(const std::vector<double>& values) {
    double squares = 0.0;
    for (const double value : values) squares += std::pow(value - mean_of(values), 2.0);
    return squares / static_cast<double>(values.size() * (values.size() - 1));
}

TEST(FitJackknife, IsTheVarianceOfAMeanWhereEachImageIsLeftOut) {
    const double wanted = variance_of_mean(kBrightness);
    EXPECT_NEAR(variance_by_jackknife(kBrightness.size()), wanted, kFloats * wanted);
}

TEST(FitJackknife, IsTheVarianceOfTheGroupsMeans) {
    constexpr std::size_t kThree = 3;
    std::vector<double> means;
    for (std::size_t group = 0; group < kThree; ++group) {
        std::vector<double> of_group;
        for (std::size_t i = group; i < kBrightness.size(); i += kThree)
            of_group.push_back(kBrightness[i]);
        means.push_back(mean_of(of_group));
    }
    const double wanted = variance_of_mean(means);
    EXPECT_NEAR(variance_by_jackknife(kThree), wanted, kFloats * wanted);
}

}  // namespace
}  // namespace aphotic::fit_jackknife_test
