// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/quadrature_fit.h"

#include "spectral/curve_loader.h"
#include "support/light_family.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace aphotic::quadrature_fit_test {
namespace {

constexpr WavelengthRange kRange{400.0, 700.0};
constexpr double kWidth_nm = 300.0;
// What some thousand additions of numbers of one sign may lose.
constexpr double kRounding = 1e-13;
// The stated error of the grid that a fitter compares with, and as much for the fit to it.
constexpr double kGridError = 2e-9;
// Lawson's iteration ends this near the least error there is.
constexpr double kConverged = 0.01;

Spectrum table(std::vector<double> lambda_nm, std::vector<double> values) {
    return {"table", std::move(lambda_nm), std::move(values)};
}

LightFamily sea_floor(double shortest_path_m, double longest_path_m) {
    return aphotic::sea_floor({"sand", "brown-algae"}, shortest_path_m, longest_path_m);
}

std::array<RuleQuality, kChannels> judged(const Sensor& sensor,
                                          const LightFamily& family,
                                          WavelengthRange range,
                                          const std::vector<WeightedWavelength>& rule) {
    const QuadratureFitter fitter(sensor, family, range);
    return fitter.judge(rule, frames_of(fitter, rule));
}

std::array<double, kChannels> rule_error(const Sensor& sensor,
                                         const LightFamily& family,
                                         WavelengthRange range,
                                         const std::vector<WeightedWavelength>& rule) {
    std::array<double, kChannels> errors{};
    const auto quality = judged(sensor, family, range, rule);
    for (std::size_t c = 0; c < kChannels; ++c) errors[c] = quality[c].error;
    return errors;
}

// --- The error of a rule -------------------------------------------------------------------

// All flat but K, a line that rises by k over the range. One wavelength in the middle finds
// W exp(-K_m l) where W exp(-K_m l) sinh(x) / x is right, x = k l / 2; so it errs by
// 1 - x / sinh(x), the more the longer the path.
TEST(RuleError, IsThatOfOneWavelengthInClosedForm) {
    constexpr double kRise_per_m = 0.8;
    const Water water{.absorption_per_m = line(0.1, 0.1 + kRise_per_m)};
    const auto family = family_of({{flat(1.0)}}, water, 1.0, 3.0);
    const auto worst =
        rule_error(flat_sensor(), family, kRange, equal_bands(flat_sensor(), kRange, 1));
    const double x = 0.5 * kRise_per_m * 3.0;
    for (const double error : worst) EXPECT_NEAR(error, 1.0 - x / std::sinh(x), kGridError);
}

TEST(RuleError, FindsTheWorstPathBetweenTheEnds) {
    // Two wavelengths, at the ends of the range, with weights that make them right at 1 m and
    // at 3 m: what they err by, they err between.
    const Water water{.absorption_per_m = line(0.0, 1.0)};
    const auto T_nm = [](double l_m) { return kWidth_nm * (1.0 - std::exp(-l_m)) / l_m; };
    // w0 + w1 exp(-l) = T(l) at l = 1 and 3.
    const double w1_nm = (T_nm(1.0) - T_nm(3.0)) / (std::exp(-1.0) - std::exp(-3.0));
    const double w0_nm = T_nm(1.0) - w1_nm * std::exp(-1.0);
    const std::vector<WeightedWavelength> rule{
        {.lambda_nm = 400.0, .weight = {w0_nm, 2.0 * w0_nm, 3.0 * w0_nm}},
        {.lambda_nm = 700.0, .weight = {w1_nm, 2.0 * w1_nm, 3.0 * w1_nm}}};
    double right = 0.0;
    for (int i = 0; i <= 1000; ++i) {
        const double l_m = 1.0 + 0.002 * i;
        right = std::max(right, std::abs((w0_nm + w1_nm * std::exp(-l_m)) / T_nm(l_m) - 1.0));
    }
    const auto worst =
        rule_error(flat_sensor(), family_of({{flat(1.0)}}, water, 1.0, 3.0), kRange, rule);
    // The peak of a parabola over the range is at most half a step off, (1 / steps)^2 of it; twice
    // that, for this one leans to one side.
    constexpr double kSteps = kCheckPaths - 1;
    constexpr double kSampling = 2.0 / (kSteps * kSteps);
    ASSERT_GT(right, 0.01);
    for (const double error : worst) {
        EXPECT_LE(error, right * (1.0 + 1e-6));
        EXPECT_GE(error, right * (1.0 - kSampling));
    }
}

TEST(RuleError, FindsTheWorstSource) {
    // One wavelength at 550 nm is right for a flat source, and finds 1 where 1/2 is right for a
    // peak there.
    const Spectrum peak("peak", {400.0, 550.0, 700.0}, {0.0, 1.0, 0.0});
    const auto rule = equal_bands(flat_sensor(), kRange, 1);
    const auto alone = family_of({{flat(1.0)}}, clear_water(), 1.0, 2.0);
    for (const double error : rule_error(flat_sensor(), alone, kRange, rule)) {
        EXPECT_NEAR(error, 0.0, kRounding);
    }
    for (const auto& sources : {std::vector<std::vector<Spectrum>>{{flat(1.0)}, {peak}},
                                std::vector<std::vector<Spectrum>>{{peak}, {flat(1.0)}}}) {
        const auto both = family_of(sources, clear_water(), 1.0, 2.0);
        for (const double error : rule_error(flat_sensor(), both, kRange, rule)) {
            EXPECT_NEAR(error, 1.0, kRounding);
        }
    }
}

TEST(RuleError, IsPerChannel) {
    const auto family = family_of({{flat(1.0)}}, clear_water(), 1.0, 2.0);
    auto rule = equal_bands(flat_sensor(), kRange, 3);
    for (WeightedWavelength& w : rule) {
        w.weight[1] *= 1.25;
        w.weight[2] = 0.0;
    }
    const auto worst = rule_error(flat_sensor(), family, kRange, rule);
    EXPECT_NEAR(worst[0], 0.0, kRounding);
    EXPECT_NEAR(worst[1], 0.25, kRounding);
    EXPECT_NEAR(worst[2], 1.0, kRounding);
}

TEST(RuleError, IsZeroForAChannelThatSeesNothing) {
    const Sensor sensor({flat(0.0), flat(1.0), flat(1.0)}, ResponseKind::Energy);
    const auto family = family_of({{flat(1.0)}}, clear_water(), 1.0, 2.0);
    EXPECT_EQ(rule_error(sensor, family, kRange, {})[0], 0.0);
    EXPECT_EQ(rule_error(sensor, family, kRange, {})[1], 1.0);
    // Even to a rule that finds something there.
    const auto rule = equal_bands(flat_sensor(), kRange, 2);
    EXPECT_EQ(rule_error(sensor, family, kRange, rule)[0], 0.0);
}

// --- The amplification of a rule -----------------------------------------------------------

// Weights 2 W and -W in clear water find 2 - 1 = 1 of what is there, and let in the rounding of
// 2 + 1 = 3 of it.
TEST(RuleAmplification, CountsWeightsOfEitherSign) {
    const auto family = family_of({{flat(1.0)}}, clear_water(), 1.0, 2.0);
    std::vector<WeightedWavelength> rule{
        {.lambda_nm = 450.0, .weight = {2.0 * kWidth_nm, 4.0 * kWidth_nm, 3.0 * kWidth_nm}},
        {.lambda_nm = 650.0, .weight = {-kWidth_nm, -2.0 * kWidth_nm, 0.0}}};
    const auto quality = judged(flat_sensor(), family, kRange, rule);
    EXPECT_NEAR(quality[0].error, 0.0, kRounding);
    EXPECT_NEAR(quality[0].amplification, 3.0, 3.0 * kRounding);
    EXPECT_NEAR(quality[1].error, 0.0, kRounding);
    EXPECT_NEAR(quality[1].amplification, 3.0, 3.0 * kRounding);
    EXPECT_NEAR(quality[2].error, 0.0, kRounding);
    EXPECT_NEAR(quality[2].amplification, 1.0, kRounding);
}

// K from 0 at 400 nm to 1/m at 700 nm: T = W (1 - exp(-l)) / l. Weights 2 W at 400 nm and -W at
// 700 nm let in (2 + exp(-l)) W, which is the most of T at the longest path:
//   l (2 + exp(-l)) / (1 - exp(-l))
TEST(RuleAmplification, IsThatOfTheWorstPath) {
    const Water water{.absorption_per_m = line(0.0, 1.0)};
    const std::vector<WeightedWavelength> rule{
        {.lambda_nm = 400.0, .weight = {2.0 * kWidth_nm, 0.0, 0.0}},
        {.lambda_nm = 700.0, .weight = {-kWidth_nm, 0.0, 0.0}}};
    const double l_m = 3.0;
    const double right = l_m * (2.0 + std::exp(-l_m)) / (1.0 - std::exp(-l_m));
    const auto quality =
        judged(flat_sensor(), family_of({{flat(1.0)}}, water, 1.0, l_m), kRange, rule);
    EXPECT_NEAR(quality[0].amplification, right, right * kGridError);
}

TEST(RuleQuality, PromisesItsErrorAndWhatItLetsInOfTheFrames) {
    const RuleQuality quality{.error = 0.25, .amplification = 3.0};
    EXPECT_EQ(quality.promise(0.125), 0.625);  // 0.25 + 3 * 0.125
    EXPECT_EQ(quality.promise(0.0), 0.25);
    // The worst channel, and which one that is may depend on the frames.
    const FittedRule rule{
        .wavelengths = {},
        .quality = {{{.error = 0.25, .amplification = 1.0}, quality, {.error = 0.5}}}};
    EXPECT_EQ(rule.error(), 0.5);
    EXPECT_EQ(rule.promise(0.0), 0.5);
    EXPECT_EQ(rule.promise(0.125), 0.625);
}

// --- Fits that are known by hand -----------------------------------------------------------

// The lamp rises from 1 to 3, the responses fall, rise and stay: T is the integral of a product
// of two lines, W (a c + (a d + b c) / 2 + b d / 3) for (a + b t) (c + d t), and the weight makes
// it of the lamp at the one wavelength.
TEST(QuadratureFitter, IsExactInClearWaterWithOneWavelength) {
    const Sensor sensor({line(2.0, 1.0), line(0.0, 1.0), flat(3.0)}, ResponseKind::Energy);
    const QuadratureFitter fitter(
        sensor, family_of({{line(1.0, 3.0)}}, clear_water(), 1.0, 5.0), kRange);
    const std::array<double, kChannels> T_nm{kWidth_nm * (2.0 + (4.0 - 1.0) / 2.0 - 2.0 / 3.0),
                                             kWidth_nm * (0.5 + 2.0 / 3.0),
                                             kWidth_nm * (3.0 + 6.0 / 2.0)};
    for (const double nm : {400.0, 475.0, 700.0}) {
        const double lamp = 1.0 + 2.0 * (nm - 400.0) / kWidth_nm;
        const FittedRule rule = fitter.fit(frames_at(fitter, {nm}), kFrameError);
        ASSERT_EQ(rule.wavelengths.size(), 1U);
        EXPECT_EQ(rule.wavelengths[0].lambda_nm, nm);
        for (std::size_t c = 0; c < kChannels; ++c) {
            EXPECT_NEAR(rule.wavelengths[0].weight[c] * lamp / T_nm[c], 1.0, kGridError)
                << nm << " nm, channel " << c;
            EXPECT_LT(rule.quality[c].error, kGridError) << nm << " nm, channel " << c;
            EXPECT_NEAR(rule.quality[c].amplification, 1.0, kGridError);
        }
    }
}

// The best multiple of a number that runs from r1 to r2 beside 1 is 2 / (r1 + r2): it errs by
// (r2 - r1) / (r2 + r1). Here r = exp(-K_m l) W / T = x / sinh(x), x = k l / 2, as above.
TEST(QuadratureFitter, ErrsTheLeastThatOneWavelengthCan) {
    constexpr double kRise_per_m = 0.8;
    const Water water{.absorption_per_m = line(0.1, 0.1 + kRise_per_m)};
    const QuadratureFitter fitter(flat_sensor(), family_of({{flat(1.0)}}, water, 1.0, 3.0), kRange);
    const auto r = [&](double l_m) {
        const double x = 0.5 * kRise_per_m * l_m;
        return x / std::sinh(x);
    };
    const double right = (r(1.0) - r(3.0)) / (r(1.0) + r(3.0));
    const FittedRule rule = fitter.fit(frames_at(fitter, {550.0}), 0.0);
    for (std::size_t c = 0; c < kChannels; ++c) {
        const double weight_nm =
            (static_cast<double>(c) + 1.0) * kWidth_nm * 2.0 / (r(1.0) + r(3.0));
        EXPECT_NEAR(rule.quality[c].error / right, 1.0, kConverged) << right;
        EXPECT_GT(rule.quality[c].error, right - kGridError);
        EXPECT_NEAR(rule.wavelengths[0].weight[c] / weight_nm, 1.0, kConverged * right);
    }
}

// K in steps of 40 nm, and a lamp that is dark between them: 36 nm of light under each, if the
// lamp goes up and down in 4 nm. So T is exactly a sum of exponentials, of which each wavelength
// stands for one.
struct Steps {
    std::vector<double> K_per_m;

    [[nodiscard]] static double middle_nm(std::size_t i) {
        return 420.0 + 60.0 * static_cast<double>(i);
    }
    [[nodiscard]] LightFamily family() const {
        std::vector<double> lamp_nm;
        std::vector<double> lamp;
        std::vector<double> water_nm;
        std::vector<double> loss_per_m;
        for (std::size_t i = 0; i < K_per_m.size(); ++i) {
            for (const double from_nm : {-20.0, -16.0, 16.0, 20.0}) {
                lamp_nm.push_back(middle_nm(i) + from_nm);
                lamp.push_back(std::abs(from_nm) < 20.0 ? 1.0 : 0.0);
            }
            for (const double from_nm : {-20.0, 20.0}) {
                water_nm.push_back(middle_nm(i) + from_nm);
                loss_per_m.push_back(K_per_m[i]);
            }
        }
        lamp_nm.push_back(700.0);
        lamp.push_back(0.0);
        water_nm.push_back(700.0);
        loss_per_m.push_back(K_per_m.back());
        return family_of({{Spectrum("lamp", lamp_nm, lamp)}},
                         {.absorption_per_m = Spectrum("steps", water_nm, loss_per_m)},
                         0.5,
                         4.0);
    }
};

TEST(QuadratureFitter, FindsTheWeightsOfASumOfExponentials) {
    constexpr double kArea_nm = 36.0;
    // Exponentials are like one another: an error of 1e-10 is as much times the condition of the
    // weights.
    constexpr double kCondition = 1e-5;
    const std::vector<double> K_per_m{0.1, 0.9, 2.5, 6.0};
    for (std::size_t n = 1; n <= K_per_m.size(); ++n) {
        const Steps steps{{K_per_m.begin(), K_per_m.begin() + static_cast<std::ptrdiff_t>(n)}};
        const QuadratureFitter fitter(flat_sensor(), steps.family(), kRange);
        std::vector<double> lambda_nm;
        for (std::size_t i = 0; i < n; ++i) lambda_nm.push_back(Steps::middle_nm(i) + 3.0);
        const FittedRule rule = fitter.fit(frames_at(fitter, lambda_nm), kFrameError);
        for (std::size_t c = 0; c < kChannels; ++c) {
            EXPECT_LT(rule.quality[c].error, kGridError) << n << " wavelengths";
            EXPECT_NEAR(rule.quality[c].amplification, 1.0, kCondition);
            const double right_nm = kArea_nm * (static_cast<double>(c) + 1.0);
            for (std::size_t i = 0; i < n; ++i) {
                EXPECT_NEAR(rule.wavelengths[i].weight[c] / right_nm, 1.0, kCondition)
                    << "wavelength " << i << " of " << n;
            }
        }
    }
}

TEST(QuadratureFitter, GivesAChannelThatSeesNothingNoWeight) {
    const Sensor sensor({flat(1.0), flat(0.0), line(0.0, 1.0)}, ResponseKind::Energy);
    const QuadratureFitter fitter(sensor, sea_floor(1.0, 3.0), kRange);
    const FittedRule rule = fitter.fit(frames_at(fitter, {450.0, 550.0, 620.0}), kFrameError);
    for (const WeightedWavelength& w : rule.wavelengths) EXPECT_EQ(w.weight[1], 0.0);
    EXPECT_EQ(rule.quality[1].error, 0.0);
    EXPECT_EQ(rule.quality[1].amplification, 0.0);
    EXPECT_GT(rule.quality[0].error, 0.0);
}

// --- Fits against other ways to weigh ------------------------------------------------------

// What a fit says of itself is what a judge says of its weights.
TEST(QuadratureFitter, JudgesItselfAsItJudgesOthers) {
    const QuadratureFitter fitter(builtin_sensor("nikon-d5100"), sea_floor(1.0, 8.0), kRange);
    const auto frames = frames_at(fitter, {450.0, 540.0, 600.0, 650.0});
    const FittedRule rule = fitter.fit(frames, kFrameError);
    const auto quality = fitter.judge(rule.wavelengths, frames);
    for (std::size_t c = 0; c < kChannels; ++c) {
        EXPECT_EQ(rule.quality[c].error, quality[c].error);
        EXPECT_EQ(rule.quality[c].amplification, quality[c].amplification);
    }
}

// A dozen wavelengths within 12 nm can be told apart only by large weights of either sign.
TEST(QuadratureFitter, HoldsWeightsDownWhereFramesAreRough) {
    const QuadratureFitter fitter(builtin_sensor("nikon-d5100"), sea_floor(1.0, 8.0), kRange);
    std::vector<double> lambda_nm;
    for (int j = 0; j < 12; ++j) lambda_nm.push_back(600.0 + j);
    const auto frames = frames_at(fitter, lambda_nm);
    const FittedRule free = fitter.fit(frames, 0.0);
    double last = free.quality[1].amplification;
    EXPECT_GT(last, 10.0);
    for (const double frame_error : {1e-4, 1e-2}) {
        const FittedRule held = fitter.fit(frames, frame_error);
        EXPECT_LT(held.promise(frame_error), free.promise(frame_error)) << frame_error;
        EXPECT_LT(held.quality[1].amplification, last) << frame_error;
        last = held.quality[1].amplification;
    }
}

// --- The tilt behind a port ----------------------------------------------------------------

// A tilt of h at the one wavelength's indices and none elsewhere: in clear water the frame holds
// exp(h), 1 and exp(-h) of the same signal. Best is 1 / cosh(h), which errs by tanh(h).
TEST(QuadratureFitter, KnowsTheTiltOfAFrameFromItsOwnIndices) {
    constexpr double kTilt = 0.2;
    LightFamily family = family_of({{flat(1.0)}}, clear_water(), 1.0, 2.0);
    family.tilt = flat(0.0);
    const QuadratureFitter fitter(flat_sensor(), family, kRange);
    FrameLight frame = fitter.frame_at(550.0);
    EXPECT_EQ(frame.tilt, 0.0);
    frame.tilt = kTilt;
    const FittedRule rule = fitter.fit(std::vector{frame}, 0.0);
    for (std::size_t c = 0; c < kChannels; ++c) {
        EXPECT_NEAR(rule.quality[c].error / std::tanh(kTilt), 1.0, kConverged);
    }
}

// --- Light that a channel does not see -----------------------------------------------------

// Red sees nothing under 600 nm, so nothing of the second lamp. At 450 nm both shine: a weight
// there would be no error to the first lamp, and show red the second, which may be brighter by any
// factor.
TEST(QuadratureFitter, GivesNoWeightToLightThatAChannelIsBlindTo) {
    const Spectrum red = table({400.0, 600.0, 601.0, 700.0}, {0.0, 0.0, 1.0, 1.0});
    const Spectrum blue_lamp = table({400.0, 500.0, 501.0, 700.0}, {1.0, 1.0, 0.0, 0.0});
    const LightFamily family = family_of({{flat(1.0)}, {blue_lamp}}, pure_water(), 1.0, 5.0);
    const QuadratureFitter fitter(
        {{red, flat(1.0), flat(1.0)}, ResponseKind::Energy}, family, kRange);
    const FittedRule rule =
        fitter.fit(frames_at(fitter, {450.0, 520.0, 620.0, 660.0, 690.0}), kFrameError);
    EXPECT_EQ(rule.wavelengths[0].weight[0], 0.0);
    EXPECT_NE(rule.wavelengths[1].weight[0], 0.0);  // the second lamp does not shine there
    EXPECT_NE(rule.wavelengths[0].weight[1], 0.0);
    EXPECT_LT(rule.quality[0].error, 1e-2);
}

// The same when the weights are given.
TEST(QuadratureFitter, JudgesWeightOnLightThatAChannelIsBlindToAsInfinitelyWrong) {
    const Spectrum red = table({400.0, 600.0, 601.0, 700.0}, {0.0, 0.0, 1.0, 1.0});
    const Spectrum blue_lamp = table({400.0, 500.0, 501.0, 700.0}, {1.0, 1.0, 0.0, 0.0});
    const LightFamily family = family_of({{flat(1.0)}, {blue_lamp}}, clear_water(), 1.0, 5.0);
    const Sensor sensor({red, flat(1.0), flat(1.0)}, ResponseKind::Energy);
    const auto judged_with = [&](double blind_weight) {
        return judged(sensor,
                      family,
                      kRange,
                      {{.lambda_nm = 450.0, .weight = {blind_weight, 100.5, 100.5}},
                       {.lambda_nm = 650.0, .weight = {99.5, 199.5, 199.5}}});
    };
    EXPECT_LT(judged_with(0.0)[0].error, kGridError);
    EXPECT_EQ(judged_with(1e-6)[0].error, std::numeric_limits<double>::infinity());
}

// In a notch 70 decades deep there is no light that a frame could hold, and a weight of 1e70 would
// make it count.
TEST(QuadratureFitter, GivesNoWeightToLightThatNoFrameHolds) {
    const Spectrum notched =
        table({400.0, 499.0, 500.0, 510.0, 511.0, 700.0}, {1.0, 1.0, 1e-70, 1e-70, 1.0, 1.0});
    const LightFamily family = family_of({{notched}}, pure_water(), 1.0, 5.0);
    const QuadratureFitter fitter(flat_sensor(), family, kRange);
    const FittedRule rule =
        fitter.fit(frames_at(fitter, {450.0, 505.0, 560.0, 620.0}), kFrameError);
    for (std::size_t c = 0; c < kChannels; ++c) {
        EXPECT_EQ(rule.wavelengths[1].weight[c], 0.0);
        EXPECT_NE(rule.wavelengths[2].weight[c], 0.0);
    }
}

// --- Invariance ----------------------------------------------------------------------------

void expect_equal(const FittedRule& one, const FittedRule& other, double relative) {
    for (std::size_t c = 0; c < kChannels; ++c) {
        EXPECT_NEAR(one.quality[c].error / other.quality[c].error, 1.0, relative)
            << one.quality[c].error << " and " << other.quality[c].error;
        EXPECT_NEAR(one.quality[c].amplification / other.quality[c].amplification, 1.0, relative);
        for (std::size_t j = 0; j < one.wavelengths.size(); ++j) {
            EXPECT_NEAR(
                one.wavelengths[j].weight[c] / other.wavelengths[j].weight[c], 1.0, relative)
                << "wavelength " << j << ", channel " << c;
        }
    }
}

// Rounding to other numbers, passed on by sixty steps of the iteration.
constexpr double kSixtySteps = 1e-8;
const std::vector<double> kThree_nm{450.0, 540.0, 610.0};

// The sensor's scale is in the weights.
TEST(QuadratureFitter, WeighsInTheUnitsOfTheSensor) {
    const LightFamily family = sea_floor(1.0, 5.0);
    const std::array responses{line(0.2, 1.0), line(1.0, 0.1), line(0.5, 0.6)};
    const auto fitted = [&](double scale) {
        const QuadratureFitter fitter(
            {{times(responses[0], scale), times(responses[1], scale), times(responses[2], scale)},
             ResponseKind::Energy},
            family,
            kRange);
        FittedRule rule = fitter.fit(frames_at(fitter, kThree_nm), kFrameError);
        for (WeightedWavelength& w : rule.wavelengths) {
            for (double& weight : w.weight) weight /= scale;
        }
        return rule;
    };
    const FittedRule rule = fitted(1.0);
    expect_equal(fitted(0x1p-80), rule, 0.0);
    expect_equal(fitted(1e30), rule, kSixtySteps);
}

// A loss without colour takes from the frames what it takes from the signals.
TEST(QuadratureFitter, DoesNotCareForALossWithoutColour) {
    const Sensor sensor = builtin_sensor("nikon-d5100");
    const auto fitted = [&](double loss_per_m) {
        LightFamily family = sea_floor(1.0, 5.0);
        family.water.uniform_loss_per_m = loss_per_m;
        const QuadratureFitter fitter(sensor, family, kRange);
        return fitter.fit(frames_at(fitter, kThree_nm), kFrameError);
    };
    const FittedRule rule = fitted(0.0);
    expect_equal(fitted(0.5), rule, kSixtySteps);
    // exp(-3500) and exp(-1e4): nothing that a double could hold. K l is rounded to 1e-12.
    expect_equal(fitted(700.0), rule, kSixtySteps);
    expect_equal(fitted(2000.0), rule, 100.0 * kSixtySteps);
}

// --- Black water ---------------------------------------------------------------------------

// K rises from 0 to k: T = W (1 - exp(-k l)) / (k l), all of it at 400 nm, where the frame holds
// 1. So T of the frame runs as 1 / l, from 1 to 3 if the path does: best is half the sum, which
// errs by (3 - 1) / (3 + 1).
TEST(QuadratureFitter, SeesTheLastNanometreOfBlackWater) {
    for (const double k_per_m : {700.0, 1e4}) {
        const Water water{.absorption_per_m = line(0.0, k_per_m)};
        const QuadratureFitter fitter(
            flat_sensor(), family_of({{flat(1.0)}}, water, 1.0, 3.0), kRange);
        const FittedRule rule = fitter.fit(frames_at(fitter, {400.0}), kFrameError);
        for (std::size_t c = 0; c < kChannels; ++c) {
            EXPECT_NEAR(rule.quality[c].error, 0.5, 0.5 * kConverged) << k_per_m << " 1/m";
            const double weight_nm = (static_cast<double>(c) + 1.0) * kWidth_nm / k_per_m / 2.0;
            EXPECT_NEAR(rule.wavelengths[0].weight[c] / weight_nm, 1.0, kConverged)
                << k_per_m << " 1/m";
        }
    }
}

// The frames' light falls by some tenths per metre, the family's by 100 per metre and more: three
// wavelengths cannot undo that, and the best rule gives them nothing and errs by 1, or hardly less.
// It must say so.
TEST(QuadratureFitter, StaysFiniteWithFramesOfMuchClearerWater) {
    LightFamily family = sea_floor(1.0, 5.0);
    for (const double uniform_per_m : {100.0, 700.0, 1e4}) {
        family.water.uniform_loss_per_m = uniform_per_m;
        const QuadratureFitter fitter(builtin_sensor("nikon-d5100"), family, kRange);
        auto frames = frames_at(fitter, kThree_nm);
        for (FrameLight& frame : frames) frame.attenuation_per_m -= uniform_per_m;
        const FittedRule rule = fitter.fit(frames, kFrameError);
        for (std::size_t c = 0; c < kChannels; ++c) {
            EXPECT_LE(rule.quality[c].error, 1.0 + kRounding) << uniform_per_m << " 1/m";
            EXPECT_GT(rule.quality[c].error, 0.9) << uniform_per_m << " 1/m";
            EXPECT_TRUE(std::isfinite(rule.quality[c].amplification)) << uniform_per_m << " 1/m";
            for (const WeightedWavelength& w : rule.wavelengths) {
                EXPECT_TRUE(std::isfinite(w.weight[c])) << uniform_per_m << " 1/m";
            }
        }
    }
}

// --- Where the light is, and what plots show -----------------------------------------------

// Two lines of a thousandth of a nanometre beside a lamp that shines everywhere.
TEST(QuadratureFitter, LooksForLightInLinesTooNarrowToHaveAShare) {
    const Spectrum lines = table({400.0, 450.0, 450.001, 450.002, 620.0, 620.001, 620.002, 700.0},
                                 {0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0});
    const QuadratureFitter fitter(
        flat_sensor(), family_of({{flat(1.0)}, {lines}}, pure_water(), 1.0, 5.0), kRange);
    const auto places = fitter.places_of_light(64);
    for (const double line_nm : {450.001, 620.001}) {
        EXPECT_TRUE(std::ranges::any_of(places, [&](double nm) {
            return std::abs(nm - line_nm) < 0.001;
        })) << line_nm;
    }
    EXPECT_TRUE(std::ranges::is_sorted(places));
}

// Blue sees a lamp where it is down to 1e-60 of its brightest. Its weights are as large as any.
TEST(QuadratureFitter, FitsAChannelToLightHoweverFaint) {
    const Spectrum blue = table({400.0, 600.0, 601.0, 700.0}, {0.0, 0.0, 1.0, 1.0});
    const Spectrum lamp = table({400.0, 500.0, 501.0, 700.0}, {1.0, 1.0, 1e-60, 1e-60});
    const QuadratureFitter fitter({{flat(1.0), flat(1.0), blue}, ResponseKind::Energy},
                                  family_of({{lamp}}, pure_water(), 1.0, 2.0),
                                  kRange);
    const FittedRule rule =
        fitter.fit(frames_at(fitter, {450.0, 480.0, 620.0, 650.0, 680.0}), kFrameError);
    EXPECT_LT(rule.quality[2].error, 1e-2);
    EXPECT_GT(rule.wavelengths[3].weight[2], 1.0);
}

// One wavelength in the middle, K a line: x / sinh(x) of what is right, as above.
TEST(QuadratureFitter, TellsItsErrorOverThePath) {
    constexpr double kRise_per_m = 0.8;
    const Water water{.absorption_per_m = line(0.1, 0.1 + kRise_per_m)};
    const QuadratureFitter fitter(
        flat_sensor(), family_of({{flat(1.0)}, {flat(7.0)}}, water, 1.0, 3.0), kRange);
    const FittedRule rule{.wavelengths = equal_bands(flat_sensor(), kRange, 1), .quality = {}};
    const auto frames = frames_of(fitter, rule.wavelengths);
    for (const std::size_t source : {0U, 1U}) {
        const auto errors = fitter.errors_over_path(rule, frames, source);
        ASSERT_EQ(errors.size(), static_cast<std::size_t>(kCheckPaths));
        EXPECT_NEAR(errors.front().path_m, 1.0, kRounding);
        EXPECT_NEAR(errors.back().path_m, 3.0, kRounding);
        double last_m = 0.0;
        for (const QuadratureFitter::PathError& at : errors) {
            EXPECT_GT(at.path_m, last_m);
            last_m = at.path_m;
            const double x = 0.5 * kRise_per_m * at.path_m;
            for (const double error : at.error) {
                EXPECT_NEAR(error, x / std::sinh(x) - 1.0, kGridError) << at.path_m << " m";
            }
        }
    }
}

}  // namespace
}  // namespace aphotic::quadrature_fit_test
