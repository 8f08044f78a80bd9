// SPDX-License-Identifier: BSD-3-Clause
#include "validation/full_spectrum.h"

#include "spectral/curve_loader.h"
#include "support/light_family.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace aphotic::full_spectrum_test {
namespace {

constexpr WavelengthRange kRange{400.0, 700.0};
constexpr double kWidth_nm = 300.0;
constexpr double kError = 1e-8;

LightFamily lights_of(Spectrum source, Water water, double shortest_m, double longest_m) {
    return {.sources = {{std::move(source)}},
            .water = std::move(water),
            .shortest_path_m = shortest_m,
            .longest_path_m = longest_m,
            .tilt = std::nullopt};
}

LightFamily habcam_light(double shortest_m, double longest_m) {
    LightFamily lights =
        lights_of(load_curve("xenon-flash", CurveRole::LampSpectrum, {}),
                  {.absorption_per_m = load_curve("pope-fry-1997", CurveRole::WaterAbsorption, {})},
                  shortest_m,
                  longest_m);
    lights.sources[0].push_back(load_curve("sand", CurveRole::Reflectance, {}));
    return lights;
}

std::array<double, kChannels> signals_by(const std::vector<WeightedWavelength>& spectrum,
                                         const LightFamily& lights,
                                         double path_m) {
    std::array<double, kChannels> signals{};
    for (const WeightedWavelength& w : spectrum) {
        double light = std::exp(-lights.water.attenuation_per_m(w.lambda_nm) * path_m);
        for (const Spectrum& factor : lights.sources[0]) light *= factor.at(w.lambda_nm);
        for (std::size_t c = 0; c < kChannels; ++c) signals[c] += w.weight[c] * light;
    }
    return signals;
}

// K a straight line from k0 to k1, all else flat:  W (exp(-k0 l) - exp(-k1 l)) / ((k1 - k0) l).
TEST(FullSpectrum, IsTheClosedFormOfFallingLightBetweenItsPathsToo) {
    for (const auto& [k0, k1] : {std::pair{0.02, 0.9}, {0.9, 0.02}}) {
        const LightFamily lights =
            lights_of(flat(7.0), {.absorption_per_m = line(k0, k1)}, 0.5, 900.0);
        const auto spectrum = full_spectrum(flat_sensor(), lights, kRange, kError);
        for (const double path_m : {0.5, 0.7, 3.0, 20.0, 111.0, 500.0, 900.0}) {
            const double right = 7.0 * kWidth_nm *
                                 (std::exp(-k0 * path_m) - std::exp(-k1 * path_m)) /
                                 ((k1 - k0) * path_m);
            const auto found = signals_by(spectrum, lights, path_m);
            EXPECT_NEAR(found[0] / right, 1.0, kError) << path_m << " m";
            EXPECT_NEAR(found[2] / right, 3.0, 3.0 * kError) << path_m << " m";
        }
    }
}

// Two quadratures that know nothing of each other.
TEST(FullSpectrum, AgreesWithThePlansOwnGrid) {
    const Sensor sensor = builtin_sensor("nikon-d5100");
    const LightFamily lights = habcam_light(0.3, 40.0);
    const auto spectrum = full_spectrum(sensor, lights, kRange, kError);
    const auto grid = reference_grid(sensor, lights, kRange, kError);
    for (const double path_m : {0.3, 1.0, 4.0, 17.0, 40.0}) {
        const auto one = signals_by(spectrum, lights, path_m);
        const auto other = signals_by(grid, lights, path_m);
        for (std::size_t c = 0; c < kChannels; ++c) {
            EXPECT_NEAR(one[c] / other[c], 1.0, 2.0 * kError) << path_m << " m, channel " << c;
        }
    }
}

// What a trace costs is in proportion to its wavelengths.
TEST(FullSpectrum, OfHabCamTakesLittleMoreThanAPointAnInterval) {
    const auto spectrum =
        full_spectrum(builtin_sensor("nikon-d5100"), habcam_light(3.9, 4.8), kRange, kError);
    constexpr std::size_t kMost = 600;
    EXPECT_LE(spectrum.size(), kMost);
}

TEST(FullSpectrum, GoesUpInWavelengthWithinTheRange) {
    const auto spectrum =
        full_spectrum(builtin_sensor("nikon-d5100"), habcam_light(1.0, 3000.0), kRange, kError);
    double before_nm = kRange.first_nm;
    for (const WeightedWavelength& w : spectrum) {
        EXPECT_GE(w.lambda_nm, before_nm);
        EXPECT_LE(w.lambda_nm, kRange.last_nm);
        before_nm = w.lambda_nm;
    }
}

TEST(FullSpectrum, BearsALampThatShinesNowhere) {
    const LightFamily dark = lights_of(flat(0.0), {.absorption_per_m = line(0.1, 0.2)}, 1.0, 2.0);
    const auto spectrum = full_spectrum(flat_sensor(), dark, kRange, kError);
    EXPECT_FALSE(spectrum.empty());
    EXPECT_EQ(signals_by(spectrum, dark, 1.5)[0], 0.0);
}

}  // namespace
}  // namespace aphotic::full_spectrum_test
