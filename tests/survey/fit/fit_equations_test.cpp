// SPDX-License-Identifier: BSD-3-Clause
//
// The normal equations of an image against the dense covariance that their header writes down, what
// a floor is brighter by, of which the veil knows nothing, and by how much floors differ.
#include "survey/fit/fit_equations.h"

#include "base/non_negative_fit.h"
#include "support/fit_rig.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace aphotic::fit_equations_test {
namespace {

// Two ways to invert a matrix whose condition is a thousand.
constexpr double kRounding = 1e-9;
// A prior of a level of 1, against some hundred blocks of 5 % of noise.
constexpr double kPrior = 1e-4;

FitRigNumbers small_and_green() {
    FitRigNumbers numbers;
    numbers.water = "chlorophyll_mg_m3 = {}";
    numbers.multiple = 0.4;
    numbers.width_px = 8;
    numbers.height_px = 6;
    return numbers;
}

struct Seen {
    RigText text;
    Rig rig = text.rig();
    FitPlaces places = fit_places(8, 6, 8);
    FitLight light{rig, places};
    Sled sled{.altitude_m = 2.5};
    FitState state{};

    Seen() : text(fit_rig(small_and_green())) {
        state.beams = {FitBeam::held(rig.strobes[0].beam)};
        state.beam_of = {0, 0};
        state.aim_rad = {{0.0, 0.0}, {0.0, 0.0}};
        state.power = {1.0, 0.8};
    }
    [[nodiscard]] PathLight path() const {
        return {text, state.water, state.floor, light.paths({sled}), true};
    }
    [[nodiscard]] FitLight::Rows columns(const FitState& of, const Eigen::VectorXd& shares) const {
        FitLight::Rows all;
        light.columns_into(of, path(), sled, shares, {}, all);
        return all;
    }
    [[nodiscard]] FitSamples samples(const Eigen::VectorXd& signal) const {
        FitSamples all;
        all.places = places;
        all.images = {{.name = "one", .sled = sled, .signal = {signal.begin(), signal.end()}}};
        return all;
    }
    // An image for each level of the floor, with relative noise.
    [[nodiscard]] FitSamples samples_of(const std::vector<double>& levels, double noise) const {
        std::mt19937_64 random(11);
        std::normal_distribution<double> normal;
        FitSamples all;
        all.places = places;
        for (const double level : levels) {
            FitState bright = state;
            bright.floor_brightness = level;
            const Eigen::VectorXd signal = columns(bright, Eigen::VectorXd::Ones(1)).rightCols<1>();
            FitImage image{.name = "one", .sled = sled, .signal = {}};
            for (const double value : signal)
                image.signal.push_back(static_cast<float>(value * (1.0 + noise * normal(random))));
            all.images.push_back(std::move(image));
        }
        return all;
    }
};

const Eigen::VectorXd kOne = Eigen::VectorXd::Ones(1);  // share, of a held beam

EffectVariances of_level(double variance) {
    EffectVariances effects{};
    effects[0] = variance;
    return effects;
}

// H = A^T V^-1 A, V = D + Gamma f f^T, f the floor's light.
TEST(FitEquations, AreThoseOfTheDenseCovariance) {
    constexpr double kVariance = 0.04;
    Seen seen;
    seen.state.beams = {FitBeam::table(5, seen.light.widest_rad({seen.sled}))};
    const Eigen::VectorXd shares = Eigen::VectorXd::LinSpaced(5, 1.0, 0.2);
    const FitLight::Rows columns = seen.columns(seen.state, shares);
    const Eigen::VectorXd signal = columns.rightCols<1>();
    FitEquations equations(seen.light, seen.samples(signal), 1);
    equations.assume_noise();
    equations.set_effects(of_level(kVariance));

    const Eigen::VectorXd f = columns.rightCols<2>().col(0);
    Eigen::MatrixXd V = kVariance * f * f.transpose();
    for (Eigen::Index row = 0; row < signal.size(); ++row)
        V(row, row) += equations.noise().at(signal(row));
    const Eigen::MatrixXd A = columns.leftCols<5>();
    const Eigen::MatrixXd wanted = A.transpose() * V.llt().solve(A);
    const Eigen::MatrixXd H = equations.normal_of(seen.state, seen.path(), shares, {}, seen.sled);
    EXPECT_LT((H - wanted).cwiseAbs().maxCoeff(), kRounding * wanted.cwiseAbs().maxCoeff());
}

// (s_m - s_m+1)^2 / (kTie size_m)^2 + (s_m - 2 s_m+1 + s_m+2)^2 / (kBend size_m)^2: of shares that
// fall off, a step and a bend far out are as unlikely as larger ones near the axis; and what the
// beam is brighter by farther out makes no step there likelier.
TEST(FitEquations, TieDimPartsMoreFirmly) {
    Seen seen;
    seen.state.beams = {FitBeam::table(5, seen.light.widest_rad({seen.sled}))};
    const Eigen::VectorXd shares = Eigen::Vector<double, 5>(1.0, 0.4, 0.01, 0.3, 0.02);
    const Eigen::VectorXd sizes =
        Eigen::Vector<double, 5>(1.0, 0.4, kDimmestTie, kDimmestTie, kDimmestTie);
    const FitLight::Rows columns = seen.columns(seen.state, shares);
    FitEquations equations(seen.light, seen.samples(columns.rightCols<1>()), 1);
    equations.assume_noise();
    const PathLight path = seen.path();
    const Eigen::MatrixXd before = equations.parts(seen.state, path).G;
    equations.tie_parts(seen.state, shares);
    const Eigen::MatrixXd ties = equations.parts(seen.state, path).G - before;
    std::mt19937_64 random(7);
    std::normal_distribution<double> normal;
    for (int k = 0; k < 5; ++k) {
        Eigen::VectorXd s(5);
        for (double& share : s) share = normal(random);
        double wanted = 0.0;
        for (Eigen::Index m = 0; m < 4; ++m)
            wanted += std::pow((s(m) - s(m + 1)) / (kTie * sizes(m)), 2.0);
        for (Eigen::Index m = 0; m < 3; ++m)
            wanted += std::pow((s(m) - 2.0 * s(m + 1) + s(m + 2)) / (kBend * sizes(m)), 2.0);
        EXPECT_NEAR(s.dot(ties * s) / wanted, 1.0, kRounding);
    }
}

TEST(FitEquations, WhatAFloorIsBrighterByLeavesTheVeilAlone) {
    const Seen seen;
    FitState bright = seen.state;
    bright.floor_brightness = 1.3;
    const Eigen::VectorXd signal = seen.columns(bright, kOne).rightCols<1>();
    FitEquations equations(seen.light, seen.samples(signal), 1);
    equations.assume_noise();
    equations.set_effects(of_level(1.0));
    const auto left = equations.residual_of(0, seen.state, seen.path(), kOne);
    const double veil =
        1.0 - seen.columns(seen.state, kOne).rightCols<2>().col(0).sum() / left.signal.sum();
    EXPECT_GT(veil, 0.04);
    EXPECT_NEAR(left.effects[0], 0.3, 0.3 * kPrior);
    EXPECT_LT(left.residual.cwiseAbs().maxCoeff(), kPrior * signal.maxCoeff());
}

// The variance of five levels about their mean, over 5 - 2: the beam's scale takes up one degree of
// freedom, the water may take up another.
TEST(FitEquations, LearnByHowMuchFloorsDiffer) {
    const std::vector<double> levels{0.93, 1.02, 1.06, 0.97, 1.02};  // mean 1
    constexpr double kNoise = 0.01;
    // Over 144 values an image, a level is off by kNoise / 12, some 2 % of what levels differ by.
    constexpr double kLevelNoise = 0.1;
    const Seen seen;
    const PathLight path = seen.path();
    double wanted = 0.0;
    for (const double level : levels) wanted += std::pow(level - 1.0, 2.0) / 3.0;
    FitEquations equations(seen.light, seen.samples_of(levels, kNoise), 1);
    equations.assume_noise();
    equations.set_effects(of_level(wanted));
    for (int round = 0; round < 8; ++round) {
        const auto parts = equations.parts(seen.state, path);
        const Eigen::VectorXd shares = non_negative_fit(parts.G, parts.b);
        equations.learn_noise(seen.state, path, shares, Robust::Huber, true);
    }
    EXPECT_NEAR(equations.effects()[0], wanted, kLevelNoise * wanted);
}

// Six times as bright as the darkest: no floors, but a wrong beam.
TEST(FitEquations, FloorsDifferByNoMoreThanFloorsDo) {
    const Seen seen;
    const PathLight path = seen.path();
    FitEquations equations(seen.light, seen.samples_of({0.3, 0.5, 1.0, 1.4, 1.8}, 0.0), 1);
    equations.assume_noise();
    equations.set_effects(of_level(0.01));
    for (int round = 0; round < 8; ++round)
        equations.learn_noise(seen.state, path, kOne, Robust::Huber, true);
    EXPECT_EQ(equations.effects()[0], kMostEffect * kMostEffect);
}

// The navigation is 0.4 m too high, and said to be right to 2 cm.
TEST(FitEquations, PosesMoveNoFartherThanTheNavigationMayBeOff) {
    constexpr double kAltitude_m = 0.02;
    Seen seen;
    const Eigen::VectorXd signal = seen.columns(seen.state, kOne).rightCols<1>();
    seen.sled.altitude_m += 0.4;
    const PathLight path = seen.path();
    FitEquations equations(seen.light, seen.samples(signal), 1);
    equations.assume_noise();
    EffectVariances effects{};
    effects[kPoseEffect] = kAltitude_m * kAltitude_m;
    equations.set_effects(effects);
    equations.learn_noise(seen.state, path, kOne, Robust::Huber, false);
    const auto moved = equations.residual_of(0, seen.state, path, kOne).signal;
    seen.sled.altitude_m -= kMostMove * kAltitude_m;
    FitLight::Rows columns;
    seen.light.columns_into(seen.state, path, seen.sled, kOne, {}, columns);
    const Eigen::VectorXd farthest = columns.rightCols<1>();
    EXPECT_LT((moved - farthest).cwiseAbs().maxCoeff(), kRounding * farthest.maxCoeff());
}

// Of a grey card as small as the noise, and of floors as large as they may be at first.
TEST(FitEquations, EffectsBeginAsTheResidualsShowThem) {
    constexpr double kFirst = 0.05;
    constexpr double kNoise = 1e-3;
    const Seen seen;
    const PathLight path = seen.path();
    const auto begun = [&](const std::vector<double>& levels) {
        FitEquations equations(seen.light, seen.samples_of(levels, kNoise), 1);
        equations.assume_noise();
        equations.start_effects(seen.state, path, kOne, of_level(kFirst * kFirst));
        return std::sqrt(equations.effects()[0]);
    };
    EXPECT_LT(begun({1.0, 1.0, 1.0}), kNoise);
    EXPECT_EQ(begun({0.9, 1.0, 1.1}), kFirst);
}

}  // namespace
}  // namespace aphotic::fit_equations_test
