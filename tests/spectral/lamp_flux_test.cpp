// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/lamp_flux.h"

#include "base/error.h"
#include "spectral/curve_loader.h"
#include "support/has.h"
#include "support/refusal.h"

#include <gtest/gtest.h>

namespace aphotic::lamp_flux_test {
namespace {

TEST(LampFlux, OfATriangleIsHalfItsBaseTimesItsHeight) {
    const Spectrum lamp("triangle", {400.0, 450.0, 700.0}, {0.0, 3.0, 0.0});
    EXPECT_DOUBLE_EQ(radiant_flux_w(lamp), 450.0);
}

// The equal-energy spectrum: the integral of V is 106.86 nm (CIE 018:2019, 1 nm sums: 106.857).
TEST(LampFlux, OfEqualEnergyIsTheIntegralOfV) {
    constexpr double kFiveNanometres = 1e-4;  // the table has every fifth nanometre
    const Spectrum lamp("equal", {360.0, 830.0}, {1.0, 1.0});
    EXPECT_NEAR(luminous_flux_lm(lamp) / (683.0 * 106.857), 1.0, kFiveNanometres);
}

// A source at 555 nm, all within one step of the table, has 683 lm/W but for what V falls in it.
TEST(LampFlux, OfGreenIsTheMostThereIs) {
    const Spectrum lamp("green", {360.0, 552.9, 555.0, 557.1, 830.0}, {0.0, 0.0, 1.0, 0.0, 0.0});
    EXPECT_NEAR(luminous_flux_lm(lamp) / radiant_flux_w(lamp), 683.0, 0.5);
}

TEST(LampFlux, OfATableThatEndsInTheVisibleIsRefused) {
    const Spectrum lamp("short", {450.0, 600.0}, {1.0, 1.0});
    EXPECT_TRUE(
        has(refusal_of([&] { (void)luminous_flux_lm(lamp); }), "450 to 600 nm, which leaves out"));
    EXPECT_DOUBLE_EQ(radiant_flux_w(lamp), 150.0);
}

}  // namespace
}  // namespace aphotic::lamp_flux_test
