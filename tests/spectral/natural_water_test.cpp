// SPDX-License-Identifier: BSD-3-Clause
//
// Natural waters against the printed tables and formulas that they come from.
#include "spectral/natural_water.h"

#include "spectral/curve_loader.h"
#include "spectral/phase_loader.h"
#include "spectral/seawater_scattering.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace aphotic::natural_water_test {
namespace {

constexpr double kSalinity_psu = 35.0;
constexpr double kTemperature_c = 10.0;

Water of_type(const std::string& name) {
    const std::vector<Spectrum> curves = load_curves(name, CurveRole::WaterType, {});
    Water water{.absorption_per_m = curves[0],
                .salinity_psu = kSalinity_psu,
                .temperature_c = kTemperature_c};
    take_type(curves[0], curves[1], builtin_phase("petzold"), water);
    return water;
}

Water of_constituents(const Constituents& constituents) {
    Water water{.absorption_per_m = load_curve("pure-2016", CurveRole::WaterAbsorption, {}),
                .salinity_psu = kSalinity_psu,
                .temperature_c = kTemperature_c};
    take_constituents(constituents, water);
    return water;
}

double scattering_per_m(const Water& water, double nm) {
    double sum = 0.0;
    for (std::size_t i = 0; i < water.scatterers.size(); ++i) sum += water.scattering_per_m(i, nm);
    return sum;
}

}  // namespace

// Smith and Baker (1981) print b of sea water to two digits, 8 to 15 % over Zhang, Hu and He
// (2009), as Morel's older power law is; Loisel et al. (2023) have b_b = 0.00592 at 350 nm.
TEST(SeawaterScattering, IsThePublished) {
    EXPECT_NEAR(0.5 * seawater_scattering_per_m(350.0, 35.0, 20.0), 0.00592, 4e-5);
    for (const auto& [nm, smith_and_baker] :
         {std::pair{400.0, 0.0076}, {450.0, 0.0045}, {500.0, 0.0029}, {550.0, 0.0019}}) {
        const double ratio = smith_and_baker / seawater_scattering_per_m(nm, 35.0, 20.0);
        EXPECT_GT(ratio, 1.08) << nm;
        EXPECT_LT(ratio, 1.16) << nm;
    }
    // The power of the wavelength is -4.32 in Morel's law for sea water (1974).
    const double power = std::log(seawater_scattering_per_m(400.0, 35.0, 20.0) /
                                  seawater_scattering_per_m(600.0, 35.0, 20.0)) /
                         std::log(400.0 / 600.0);
    EXPECT_NEAR(power, -4.32, 0.1);
}

// Of 35 to 39 psu, Morel (1974) measured 1.30 times as much as of pure water.
TEST(SeawaterScattering, IsLessWithoutSalt) {
    const double ratio =
        seawater_scattering_per_m(550.0, 35.0, 20.0) / seawater_scattering_per_m(550.0, 0.0, 20.0);
    constexpr double kThreeDigits = 0.005;
    EXPECT_NEAR(ratio, 1.30, kThreeDigits);
}

// At the wavelengths of the table, where water's own is less than the type's.
TEST(NaturalWater, OfATypeHasItsTablesCoefficients) {
    struct Printed {
        const char* type;
        double nm;
        double absorption_per_m;
        double scattering_per_m;
    };
    // Williamson and Hollins (2022); Solonenko and Mobley (2015), Tables 3 to 8.
    for (const Printed& row : {Printed{"jerlov-3C", 447.37, 0.206, 0.687},
                               Printed{"jerlov-3C", 542.11, 0.127, 0.647},
                               Printed{"jerlov-IB", 447.37, 0.041, 0.135},
                               Printed{"jerlov-3C-2015", 450.0, 0.154, 1.50},
                               Printed{"jerlov-3C-2015", 550.0, 0.082, 1.06}}) {
        const Water water = of_type(row.type);
        EXPECT_NEAR(water.absorption_per_m.at(row.nm), row.absorption_per_m, 1e-12) << row.type;
        EXPECT_NEAR(scattering_per_m(water, row.nm), row.scattering_per_m, 1e-12) << row.type;
    }
}

// Both sets list less than pure water in the red.
TEST(NaturalWater, OfATypeAbsorbsNoLessThanWater) {
    const Spectrum pure = load_curve("pure-2016", CurveRole::WaterAbsorption, {});
    for (const std::string& name : builtin_names(role_name(CurveRole::WaterType))) {
        const Water water = of_type(name);
        for (const double nm : water.absorption_per_m.lambda_nm()) {
            EXPECT_GE(water.absorption_per_m.at(nm), pure.at(nm)) << name << ", " << nm;
        }
    }
    EXPECT_EQ(of_type("jerlov-IB").absorption_per_m.at(700.0), pure.at(700.0));
}

// By hand, for Chl = 1: a(440) = 1.2 (a_w + 0.06), b_p(550) = 0.416, v = -0.15, b_b/b = 0.007.
TEST(NaturalWater, OfOneMilligramOfChlorophyllIsByHand) {
    const Spectrum pure = load_curve("pure-2016", CurveRole::WaterAbsorption, {});
    const Water water = of_constituents({.chlorophyll_mg_m3 = 1.0});
    EXPECT_NEAR(water.absorption_per_m.at(440.0), 1.2 * (pure.at(440.0) + 0.06), 1e-12);
    ASSERT_EQ(water.scatterers.size(), 2U);
    EXPECT_NEAR(water.scattering_per_m(1, 550.0), 0.416, 1e-12);
    EXPECT_NEAR(water.scattering_per_m(1, 440.0), 0.416 * std::pow(0.8, -0.15), 1e-6);
    EXPECT_NEAR(water.scatterers[1].phase.backscatter_ratio(), 0.007, 1e-9);
    EXPECT_EQ(water.scattering_per_m(0, 550.0), seawater_scattering_per_m(550.0, 35.0, 10.0));
}

// Morel et al. (2007) measured K_d(490) = 0.0166 + 0.07242 Chl^0.68955 in case-1 waters. K_d is
// 1.04 (a + b_b) over the cosine of the sun's angle in water (Gordon 1989), which is 0.75 to 1.
TEST(NaturalWater, OfChlorophyllAttenuatesDaylightAsMeasured) {
    constexpr double kScatter = 1.2;  // of either formula about measurements
    for (const double chl : {0.1, 0.3, 1.0, 3.0, 10.0}) {
        const Water water = of_constituents({.chlorophyll_mg_m3 = chl});
        double loss = water.absorption_per_m.at(490.0);
        for (std::size_t i = 0; i < 2; ++i)
            loss +=
                water.scattering_per_m(i, 490.0) * water.scatterers[i].phase.backscatter_ratio();
        const double measured = 0.0166 + 0.07242 * std::pow(chl, 0.68955);
        EXPECT_GT(measured / loss, 1.04 / kScatter) << chl;
        EXPECT_LT(measured / loss, 1.04 / 0.75 * kScatter) << chl;
    }
}

TEST(NaturalWater, TakesDissolvedMatterAndParticlesAsTold) {
    const Water usual = of_constituents({.chlorophyll_mg_m3 = 1.0});
    const Water other =
        of_constituents({.chlorophyll_mg_m3 = 1.0, .cdom_440_per_m = 0.5, .particles = 3.0});
    const Water none = of_constituents({.chlorophyll_mg_m3 = 1.0, .cdom_440_per_m = 0.0});
    EXPECT_NEAR(other.absorption_per_m.at(440.0) - none.absorption_per_m.at(440.0), 0.5, 1e-12);
    // exp(-0.014 (540 - 440))
    EXPECT_NEAR(other.absorption_per_m.at(540.0) - none.absorption_per_m.at(540.0),
                0.5 * std::exp(-1.4),
                1e-12);
    EXPECT_NEAR(other.scattering_per_m(1, 550.0), 3.0 * usual.scattering_per_m(1, 550.0), 1e-12);
    EXPECT_EQ(other.scattering_per_m(0, 550.0), usual.scattering_per_m(0, 550.0));
}

}  // namespace aphotic::natural_water_test
