// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/quadrature_certificate.h"

#include "support/light_family.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace aphotic::quadrature_certificate_test {
namespace {

constexpr WavelengthRange kRange{400.0, 700.0};
constexpr double kWidth_nm = 300.0;
constexpr double kPanelError = 1e-10;  // of spectral/panel_quadrature.h

Spectrum flat(double value) {
    return {"flat", {400.0, 700.0}, {value, value}};
}

// 1 from 400 nm to the edge, then nothing.
Spectrum below(double edge_nm) {
    return {"below", {400.0, edge_nm, edge_nm + 1.0, 700.0}, {1.0, 1.0, 0.0, 0.0}};
}

Spectrum above(double edge_nm) {
    return {"above", {400.0, edge_nm, edge_nm + 1.0, 700.0}, {0.0, 0.0, 1.0, 1.0}};
}

Sensor flat_sensor() {
    return {{flat(1.0), flat(2.0), flat(3.0)}, ResponseKind::Energy};
}

Water clear_water() {
    return {.absorption_per_m = flat(1.0), .multiple = 0.0};
}

LightFamily lamps_in_clear_water(std::vector<Spectrum> lamps) {
    LightFamily family{.sources = {},
                       .water = clear_water(),
                       .shortest_path_m = 1.0,
                       .longest_path_m = 2.0,
                       .tilt = {}};
    for (Spectrum& lamp : lamps) family.sources.push_back({std::move(lamp)});
    return family;
}

FrameLight frame_of(const LightFamily& family, double lambda_nm) {
    FrameLight frame{.lambda_nm = lambda_nm,
                     .attenuation_per_m = family.water.attenuation_per_m(lambda_nm),
                     .sources = {},
                     .tilt = 0.0};
    for (const auto& source : family.sources) frame.sources.push_back(source[0].at(lambda_nm));
    return frame;
}

std::array<RuleQuality, kChannels> certified(const Sensor& sensor,
                                             const LightFamily& family,
                                             const std::vector<WeightedWavelength>& rule) {
    std::vector<FrameLight> frames;
    for (const auto& w : rule) frames.push_back(frame_of(family, w.lambda_nm));
    return certified_quality(sensor, family, kRange, rule, frames);
}

TEST(RuleCertificate, FindsNoErrorInAnExactRuleAndAllOfIt) {
    const LightFamily family = lamps_in_clear_water({flat(7.0)});
    const double w = kWidth_nm;
    for (const double off : {0.0, 1e-6, 0.3}) {
        const auto quality = certified(
            flat_sensor(),
            family,
            {{.lambda_nm = 500.0, .weight = {w * (1.0 + off), 2.0 * w, 3.0 * w * (1.0 - off)}}});
        EXPECT_NEAR(quality[0].error, off, kPanelError);
        EXPECT_NEAR(quality[1].error, 0.0, kPanelError);
        EXPECT_NEAR(quality[2].error, off, kPanelError);
        EXPECT_NEAR(quality[0].amplification, 1.0 + off, kPanelError);
    }
}

// One wavelength for a K that rises by a straight line: its error is largest at an end of the
// paths.
TEST(RuleCertificate, IsTheClosedFormOverPaths) {
    constexpr double kFirst_per_m = 0.05;
    constexpr double kLast_per_m = 0.35;
    LightFamily family = lamps_in_clear_water({flat(1.0)});
    family.water = {.absorption_per_m = line(kFirst_per_m, kLast_per_m)};
    family.shortest_path_m = 2.0;
    family.longest_path_m = 8.0;
    const double K_per_m = family.water.attenuation_per_m(410.0);
    const double l_m = family.longest_path_m;
    const double fall = (kLast_per_m - kFirst_per_m) * l_m;
    const double T = kWidth_nm * std::exp(-kFirst_per_m * l_m) * -std::expm1(-fall) / fall;
    const double right = kWidth_nm * std::exp(-K_per_m * l_m) / T - 1.0;
    const auto quality =
        certified(flat_sensor(), family, {{.lambda_nm = 410.0, .weight = {kWidth_nm, 1.0, 1.0}}});
    EXPECT_NEAR(quality[0].error, right, kPanelError);
}

// Red sees the second lamp alone. A wavelength of the first lamp's, which red does not see, may
// have no weight in red, however small, for the first lamp may be the brighter by any factor.
TEST(RuleCertificate, RefusesWeightOnLightThatAChannelIsBlindTo) {
    const LightFamily family = lamps_in_clear_water({below(450.0), above(600.0)});
    const Sensor sensor({above(600.0), flat(1.0), flat(1.0)}, ResponseKind::Energy);
    const double seen_nm = 99.0 + 1.0 / 3.0;  // above(600) times itself
    const auto rule_with = [&](double blind_weight) {
        return std::vector<WeightedWavelength>{
            {.lambda_nm = 430.0, .weight = {blind_weight, 50.5, 50.5}},
            {.lambda_nm = 650.0, .weight = {seen_nm, 99.5, 99.5}}};
    };
    EXPECT_NEAR(certified(sensor, family, rule_with(0.0))[0].error, 0.0, kPanelError);
    EXPECT_NEAR(certified(sensor, family, rule_with(0.0))[1].error, 0.0, kPanelError);
    constexpr double kInfinite = std::numeric_limits<double>::infinity();
    EXPECT_EQ(certified(sensor, family, rule_with(1e-9))[0].error, kInfinite);
    EXPECT_EQ(certified(sensor, family, rule_with(-1e-9))[0].error, kInfinite);
}

TEST(RuleCertificate, IsZeroForAChannelThatSeesNothing) {
    const LightFamily family = lamps_in_clear_water({below(450.0)});
    const Sensor sensor({above(600.0), flat(1.0), flat(1.0)}, ResponseKind::Energy);
    const auto quality =
        certified(sensor, family, {{.lambda_nm = 430.0, .weight = {0.0, 50.5, 50.5}}});
    EXPECT_EQ(quality[0].error, 0.0);
    EXPECT_EQ(quality[0].amplification, 0.0);
}

}  // namespace
}  // namespace aphotic::quadrature_certificate_test
