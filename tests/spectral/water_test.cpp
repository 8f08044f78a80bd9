// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/water.h"
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
