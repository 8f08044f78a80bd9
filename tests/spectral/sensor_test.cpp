// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/sensor.h"

#include "base/error.h"

#include <gtest/gtest.h>

#include <limits>

namespace aphotic::sensor_test {
namespace {

// Photons in 1 J at 555 nm, 555e-9 / (6.62607015e-34 * 299792458), to the digits given.
constexpr double kPhotonsPerJouleAt555nm = 2.7939e18;
constexpr double kPhotonRounding = 0.5e14;
constexpr double kRelativeRounding = 4.0 * std::numeric_limits<double>::epsilon();

std::vector<Spectrum> channels(double red, double green, double blue) {
    return {{"red", {380.0, 780.0}, {red, red}},
            {"green", {400.0, 780.0}, {green, green}},
            {"blue", {380.0, 700.0}, {blue, blue}}};
}

TEST(Sensor, EnergyResponseIsTheCurve) {
    const Sensor sensor(channels(0.25, 0.5, 0.75), ResponseKind::Energy);
    EXPECT_EQ(sensor.response(0, 555.0), 0.25);
    EXPECT_EQ(sensor.response(1, 600.0), 0.5);
    EXPECT_EQ(sensor.response(2, 700.0), 0.75);
}

TEST(Sensor, QuantumResponseCountsPhotonsPerJoule) {
    const Sensor sensor(channels(1.0, 0.5, 0.0), ResponseKind::Quantum);
    EXPECT_NEAR(sensor.response(0, 555.0), kPhotonsPerJouleAt555nm, kPhotonRounding);
    EXPECT_NEAR(sensor.response(1, 555.0), 0.5 * kPhotonsPerJouleAt555nm, kPhotonRounding);
    EXPECT_EQ(sensor.response(2, 555.0), 0.0);
}

TEST(Sensor, QuantumResponseGrowsWithWavelength) {
    const Sensor sensor(channels(1.0, 1.0, 1.0), ResponseKind::Quantum);
    const double ratio = sensor.response(0, 700.0) / sensor.response(0, 400.0);
    EXPECT_NEAR(ratio, 1.75, 1.75 * kRelativeRounding);
}

TEST(Sensor, FilteredIsTheProductOfFilterAndQuantumEfficiency) {
    const Sensor sensor =
        Sensor::filtered(channels(0.5, 1.0, 0.0), {"ccd", {390.0, 720.0}, {0.4, 0.4}});
    EXPECT_NEAR(sensor.response(0, 555.0), 0.2 * kPhotonsPerJouleAt555nm, kPhotonRounding);
    EXPECT_EQ(sensor.curves().size(), 4U);
    EXPECT_EQ(sensor.range().first_nm, 400.0);
    EXPECT_EQ(sensor.range().last_nm, 700.0);
}

TEST(Sensor, AMonoCamerasChannelsAreOne) {
    const Sensor sensor = Sensor::mono({"ccd", {380.0, 780.0}, {0.5, 0.5}});
    EXPECT_TRUE(sensor.is_mono());
    for (int channel = 0; channel < kChannels; ++channel) {
        EXPECT_NEAR(
            sensor.response(channel, 555.0), 0.5 * kPhotonsPerJouleAt555nm, kPhotonRounding);
    }
    EXPECT_FALSE(Sensor(channels(0.5, 0.5, 0.5), ResponseKind::Energy).is_mono());
}

TEST(Sensor, KeepsItsCurvesWhenCopied) {
    const Sensor copy = Sensor(channels(1.0, 1.0, 1.0), ResponseKind::Energy);
    ASSERT_EQ(copy.curves().size(), 3U);
    EXPECT_EQ(copy.curves()[1]->name(), "green");
}

TEST(Sensor, HasNoResponseOutsideACurve) {
    const Sensor sensor(channels(1.0, 1.0, 1.0), ResponseKind::Energy);
    EXPECT_THROW(static_cast<void>(sensor.response(2, 701.0)), InputError);
}

TEST(Sensor, NeedsThreeChannels) {
    std::vector<Spectrum> two = channels(1.0, 1.0, 1.0);
    two.pop_back();
    EXPECT_THROW(Sensor(two, ResponseKind::Energy), InputError);
}

TEST(BuiltinSensor, NikonIsAnEnergyResponse) {
    const Sensor sensor = builtin_sensor("nikon-d5100");
    EXPECT_EQ(sensor.response(1, 530.0), 1.0);  // the tabulated peak of green
    EXPECT_EQ(sensor.range().first_nm, 380.0);
    EXPECT_EQ(sensor.range().last_nm, 780.0);
    EXPECT_EQ(sensor.curves()[0]->name(), "sensor response 'nikon-d5100' (red)");
    EXPECT_THROW(static_cast<void>(builtin_sensor("sand")), InputError);
}

}  // namespace
}  // namespace aphotic::sensor_test
