// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/refractive_index.h"

#include "base/error.h"
#include "spectral/curve_loader.h"
#include "support/refusal.h"

#include <gtest/gtest.h>

namespace aphotic::refractive_index_test {
namespace {

constexpr double kFiveDecimals = 0.5e-5;  // expected values are given to five decimals
constexpr double kSixDecimals = 0.5e-6;   // and to six
constexpr double kFourDecimals = 0.5e-4;  // and to four
constexpr double kHelium_nm = 587.6;      // d line, at which glass indices are stated

struct SeawaterPoint {
    double salinity_psu, temperature_c, lambda_nm, index, tolerance;
};

// Evaluated by hand from the equation of X. Quan and E. S. Fry, Applied Optics 34, 3477 (1995).
TEST(SeawaterIndex, HasTheValuesOfQuanAndFry) {
    for (const SeawaterPoint& point : {SeawaterPoint{35, 10, 400.0, 1.35085, kFiveDecimals},
                                       {35, 10, 450.0, 1.34676, kFiveDecimals},
                                       {35, 10, 550.0, 1.34167, kFiveDecimals},
                                       {35, 10, 650.0, 1.33853, kFiveDecimals},
                                       {35, 10, 700.0, 1.33735, kFiveDecimals},
                                       {0, 20, 550.0, 1.33434, kFiveDecimals},
                                       {0, 20, 589.3, 1.333004, kSixDecimals}}) {
        EXPECT_NEAR(seawater_index(point.lambda_nm, point.salinity_psu, point.temperature_c),
                    point.index,
                    point.tolerance)
            << point.lambda_nm;
    }
}

// An independent measurement: water at 20 C and 589.26 nm has n = 1.33299 against air
// (Tilton and Taylor, J. Res. Natl. Bur. Stand. 20, 419, 1938).
TEST(SeawaterIndex, AgreesWithTiltonAndTaylor) {
    constexpr double kStatedAccuracy = 2e-5;  // of Quan and Fry
    EXPECT_NEAR(seawater_index(589.26, 0.0, 20.0), 1.33299, kStatedAccuracy);
}

TEST(SeawaterIndex, RefusesWhatLiesOutsideTheUsableRange) {
    EXPECT_NO_THROW(static_cast<void>(seawater_index(200.0, 0.0, -2.0)));
    EXPECT_NO_THROW(static_cast<void>(seawater_index(1100.0, 40.0, 35.0)));
    EXPECT_THROW(static_cast<void>(seawater_index(199.0, 35.0, 10.0)), InputError);
    EXPECT_THROW(static_cast<void>(seawater_index(1101.0, 35.0, 10.0)), InputError);
    EXPECT_THROW(static_cast<void>(seawater_index(550.0, 41.0, 10.0)), InputError);
    EXPECT_THROW(static_cast<void>(seawater_index(550.0, -1.0, 10.0)), InputError);
    EXPECT_THROW(static_cast<void>(seawater_index(550.0, 35.0, 36.0)), InputError);
    EXPECT_EQ(refusal_of([&] { static_cast<void>(seawater_index(550.0, 35.0, 50.0)); }),
              "refractive index of seawater: temperature found 50 C; allowed: -2 to 35");
}

TEST(Glass, HasThePublishedIndexAtTheHeliumLine) {
    EXPECT_NEAR(builtin_glass("bk7").index(kHelium_nm), 1.51680, kFiveDecimals);
    EXPECT_NEAR(builtin_glass("fused-silica").index(kHelium_nm), 1.45846, kFiveDecimals);
    EXPECT_NEAR(builtin_glass("sapphire").index(kHelium_nm), 1.76817, kFiveDecimals);
    EXPECT_NEAR(builtin_glass("pmma").index(kHelium_nm), 1.4925, kFourDecimals);
    EXPECT_NEAR(builtin_glass("polycarbonate").index(kHelium_nm), 1.5848, kFourDecimals);
}

// SCHOTT's data sheet of N-BK7: n_F = 1.52238 at 486.1 nm, n_C = 1.51432 at 656.3 nm.
TEST(Glass, DispersesAsTheDataSheetSays) {
    const Glass glass = builtin_glass("bk7");
    EXPECT_NEAR(glass.index(486.1327), 1.52238, kFiveDecimals);
    EXPECT_NEAR(glass.index(656.2725), 1.51432, kFiveDecimals);
}

TEST(Glass, IsRefusedOutsideItsRange) {
    const Glass glass = builtin_glass("pmma");
    EXPECT_NO_THROW(static_cast<void>(glass.index(420.0)));
    EXPECT_EQ(refusal_of([&] { static_cast<void>(glass.index(400.0)); }),
              "refractive index of 'pmma' covers 420 to 1620 nm and has no value at 400 nm");
}

TEST(Glass, IsRefusedWhenUnknown) {
    EXPECT_EQ(refusal_of([&] { static_cast<void>(builtin_glass("sand")); }),
              "no built-in glass is named 'sand'; allowed: bk7, fused-silica, pmma, "
              "polycarbonate, sapphire");
}

TEST(StatedRange, IsReadFromTheComment) {
    const std::string rows = "term,p,q\n1,2,3\n";
    const WavelengthRange range =
        stated_range(parse_table("g", "# range: 380 to 727.5 nm\n" + rows));
    EXPECT_EQ(range.first_nm, 380.0);
    EXPECT_EQ(range.last_nm, 727.5);
    for (const std::string bad :
         {"", "380-780 nm", "780 to 380 nm", "380 to 780", "0.3 to 0.7 um"}) {
        EXPECT_THROW(
            static_cast<void>(stated_range(parse_table("g", "# range: " + bad + "\n" + rows))),
            InputError)
            << bad;
    }
}

}  // namespace
}  // namespace aphotic::refractive_index_test
