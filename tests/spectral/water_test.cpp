// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/water.h"
#include "spectral/phase_loader.h"
#include "spectral/refractive_index.h"

#include <gtest/gtest.h>

namespace aphotic::water_test {
namespace {

const Spectrum kAbsorption("water", {400.0, 500.0, 700.0}, {0.3, 0.1, 0.6});

TEST(Water, TakesItsMultipleOfAbsorptionAndTheUniformLoss) {
    const Water water{.absorption_per_m = kAbsorption, .multiple = 2.0, .uniform_loss_per_m = 0.5};
    EXPECT_DOUBLE_EQ(water.attenuation_per_m(600.0), 2.0 * 0.35 + 0.5);
    EXPECT_DOUBLE_EQ(water.least_attenuation_per_m(), 2.0 * 0.1 + 0.5);
    ASSERT_EQ(water.curves().size(), 1U);
    EXPECT_EQ(water.curves().front(), &water.absorption_per_m);
    EXPECT_FALSE(water.is_clear());
}

// Petzold's clear and coastal water at 514 nm: what the floor's irradiance loses a metre, below a
// Lambertian lamp at 2 m, by a Monte Carlo of all orders by other hands than
// validation/monte_carlo.h's. c, 0.151 and 0.398, is far from it.
TEST(Water, LosesWhatAMonteCarloOfAllOrdersLoses) {
    constexpr double kOfMonteCarlo = 0.004;  // its digits, and that other lamps lose a bit more
    const auto flat = [](double value) { return Spectrum("flat", {400.0, 700.0}, {value, value}); };
    const Water clear{.absorption_per_m = flat(0.114),
                      .scatterers = {{flat(0.037), builtin_phase("petzold-clear")}}};
    EXPECT_NEAR(clear.attenuation_per_m(514.0), 0.116, kOfMonteCarlo);
    const Water coast{.absorption_per_m = flat(0.179),
                      .scatterers = {{flat(0.219), builtin_phase("petzold-coast")}}};
    EXPECT_NEAR(coast.attenuation_per_m(514.0), 0.185, kOfMonteCarlo);
}

TEST(Water, OfNoAbsorptionReadsNoTable) {
    const Water water{.absorption_per_m = kAbsorption, .multiple = 0.0, .uniform_loss_per_m = 0.5};
    EXPECT_EQ(water.attenuation_per_m(1000.0), 0.5) << "which the table does not cover";
    EXPECT_EQ(water.least_attenuation_per_m(), 0.5);
    EXPECT_TRUE(water.curves().empty());
}

TEST(Water, BendsAsItsSaltAndTemperatureSay) {
    Water water{.absorption_per_m = kAbsorption, .salinity_psu = 20.0, .temperature_c = 4.0};
    EXPECT_EQ(water.refractive_index(550.0), seawater_index(550.0, 20.0, 4.0));
    const auto before = water.index_signature();
    water.multiple = 3.0;
    EXPECT_EQ(water.index_signature(), before);
    water.salinity_psu += 1e-9;
    EXPECT_NE(water.index_signature(), before);
    water.salinity_psu = 20.0;
    water.temperature_c += 1e-9;
    EXPECT_NE(water.index_signature(), before);
}

}  // namespace
}  // namespace aphotic::water_test
