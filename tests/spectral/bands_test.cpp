// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/bands.h"

#include "base/error.h"
#include "support/refusal.h"

#include <gtest/gtest.h>

#include <cmath>

namespace aphotic::bands_test {
namespace {

// Sums of some dozen products of numbers near 1.
constexpr double kRounding = 1e-13;

// Responses 1, 2 and a straight line: 0 at 400 nm, 3 at 700 nm.
Sensor simple_sensor() {
    return {{Spectrum("red", {400.0, 700.0}, {1.0, 1.0}),
             Spectrum("green", {400.0, 700.0}, {2.0, 2.0}),
             Spectrum("blue", {400.0, 700.0}, {0.0, 3.0})},
            ResponseKind::Energy};
}

constexpr WavelengthRange kRange{400.0, 700.0};

std::string listed_error(const std::vector<double>& lambda_nm) {
    return refusal_of([&] { require_wavelengths(kRange, lambda_nm); });
}

void expect_band(const WeightedWavelength& band, double lambda_nm, double width_nm) {
    const double blue = 3.0 * (lambda_nm - 400.0) / 300.0;
    EXPECT_NEAR(band.lambda_nm, lambda_nm, kRounding * lambda_nm);
    EXPECT_NEAR(band.weight[0], width_nm, kRounding * 300.0) << lambda_nm << " nm";
    EXPECT_NEAR(band.weight[1], 2.0 * width_nm, kRounding * 300.0) << lambda_nm << " nm";
    EXPECT_NEAR(band.weight[2], blue * width_nm, kRounding * 300.0) << lambda_nm << " nm";
}

TEST(EqualBands, StandInTheMiddleOfEqualParts) {
    const auto bands = equal_bands(simple_sensor(), kRange, 3);
    ASSERT_EQ(bands.size(), 3U);
    expect_band(bands[0], 450.0, 100.0);
    expect_band(bands[1], 550.0, 100.0);
    expect_band(bands[2], 650.0, 100.0);
}

TEST(EqualBands, OneBandIsTheWholeRange) {
    const auto bands = equal_bands(simple_sensor(), kRange, 1);
    ASSERT_EQ(bands.size(), 1U);
    expect_band(bands[0], 550.0, 300.0);
}

// The midpoint rule is exact for straight lines: the integral of Q over the range.
TEST(EqualBands, IntegrateAStraightLineExactly) {
    for (const int count : {1, 2, 7, 64}) {
        double sum = 0.0;
        for (const auto& band : equal_bands(simple_sensor(), kRange, count)) sum += band.weight[2];
        EXPECT_NEAR(sum, 0.5 * 300.0 * 3.0, kRounding * 450.0) << count << " bands";
    }
}

// S = int Q L with Q = 3 t, L = t^2, t = (lambda - 400) / 300: 300 * 3/4 = 225 nm.
double cubic_error(int count) {
    double sum = 0.0;
    for (const auto& band : equal_bands(simple_sensor(), kRange, count)) {
        const double t = (band.lambda_nm - 400.0) / 300.0;
        sum += band.weight[2] * t * t;
    }
    return sum - 225.0;
}

TEST(EqualBands, ErrFourTimesLessAtHalfTheWidth) {
    // The midpoint rule's error on a cubic is C / n^2 and nothing else.
    constexpr double kRatioRounding = 1e-6;
    const double coarse = cubic_error(8);
    const double fine = cubic_error(16);
    EXPECT_NEAR(coarse / fine, 4.0, kRatioRounding) << coarse << " and " << fine;
}

// A sum of a million terms: of any order, it must stay within its rounding of the integral. The
// midpoint rule itself errs by 1e-12 here: a millionth of the range, squared.
TEST(EqualBands, AMillionSumToTheIntegralInAnyOrder) {
    constexpr int kMillion = 1'000'000;
    constexpr double kMillionRoundings = kMillion * 1.2e-16;
    const Sensor sensor = builtin_sensor("nikon-d5100");
    const WavelengthRange range = sensor.range();
    const std::vector<WeightedWavelength> bands = equal_bands(sensor, range, kMillion);
    ASSERT_EQ(bands.size(), static_cast<std::size_t>(kMillion));
    for (std::size_t c = 0; c < kChannels; ++c) {
        // By trapezoids between the table's knots, which is exact for an energy response.
        const Spectrum& response = *sensor.curves()[c];
        long double integral = 0.0L;
        for (std::size_t i = 0; i + 1 < response.values().size(); ++i) {
            integral += 0.5L * (response.values()[i] + response.values()[i + 1]) *
                        (response.lambda_nm()[i + 1] - response.lambda_nm()[i]);
        }
        double forwards = 0.0;
        for (const WeightedWavelength& band : bands) forwards += band.weight[c];
        double backwards = 0.0;
        for (auto band = bands.rbegin(); band != bands.rend(); ++band) backwards += band->weight[c];
        const auto exact = static_cast<double>(integral);
        EXPECT_NEAR(forwards, exact, kMillionRoundings * exact);
        EXPECT_NEAR(backwards, exact, kMillionRoundings * exact);
    }
}

TEST(Wavelengths, MustIncreaseWithinTheRange) {
    const std::string allowed = "; allowed: increasing wavelengths from 400 to 700 nm";
    EXPECT_EQ(listed_error({399.9}), "wavelengths: found 399.9 nm at position 1" + allowed);
    EXPECT_EQ(listed_error({500.0, 700.1}), "wavelengths: found 700.1 nm at position 2" + allowed);
    EXPECT_EQ(listed_error({500.0, 500.0}), "wavelengths: found 500 nm at position 2" + allowed);
    EXPECT_EQ(listed_error({500.0, 600.0, 550.0}),
              "wavelengths: found 550 nm at position 3" + allowed);
    EXPECT_EQ(listed_error({std::nan("")}), "wavelengths: found nan nm at position 1" + allowed);
    EXPECT_EQ(listed_error({400.0, 700.0}), "nothing was said");
}

}  // namespace
}  // namespace aphotic::bands_test
