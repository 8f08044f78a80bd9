// SPDX-License-Identifier: BSD-3-Clause
//
// Losses and phase functions of the reference against published numbers, closed forms, and the
// formulas of spectral/, of which it has no line.
#include "validation/traced_water.h"

#include "spectral/phase_loader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace aphotic::traced_water_test {
namespace {

using std::numbers::pi;

constexpr double kDegree = pi / 180.0;
constexpr double kOfQuadrature = 1e-10;
constexpr double kNm = 500.0;

Spectrum flat(double value) {
    return {"flat", {300.0, 900.0}, {value, value}};
}

TracedPhase henyey_greenstein(double g) {
    return TracedPhase({.name = "hg", .kind = HenyeyGreenstein{.g = g}});
}

}  // namespace

// F = (1 - g^2)/(2 g) (1/(1 - g) - (1 + g^2 - 2 g cos)^-1/2), and so 1 - F.
TEST(TracedWater, HenyeyAndGreensteinsShareIsTheClosedForm) {
    for (const double g : {-0.7, 0.3, 0.924, 0.99}) {
        for (const double degrees : {0.1, 1.0, 10.0, 45.0, 120.0}) {
            const double root = std::sqrt(1.0 + g * g - 2.0 * g * std::cos(degrees * kDegree));
            const double F = (1.0 - g * g) / (2.0 * g) * (1.0 / (1.0 - g) - 1.0 / root);
            EXPECT_NEAR(
                henyey_greenstein(g).share_beyond(degrees * kDegree), 1.0 - F, kOfQuadrature)
                << g << ", " << degrees;
        }
    }
}

// Forward is where g is over 0.
TEST(TracedWater, LightIsTurnedLittleWhereGIsPositive) {
    EXPECT_GT(henyey_greenstein(0.9).at(0.2), 100.0 * henyey_greenstein(0.9).at(3.0));
}

// Mobley, Sundman and Boss (2002), with the second term's own fall: B of (n, mu).
TEST(TracedWater, FournierAndForandsBackscatterIsThePublished) {
    struct Published {
        double index;
        double slope;
        double backscatter;
    };
    for (const Published& row : {Published{1.08, 3.483, 0.01004},
                                 Published{1.175, 4.065, 0.1001},
                                 Published{1.15, 4.874, 0.4005},
                                 Published{1.10, 3.5835, 0.0183}}) {
        const TracedPhase phase(
            {.name = "ff", .kind = FournierForand{.index = row.index, .slope = row.slope}});
        constexpr double kPrinted = 3e-3;  // of B, printed to three or four digits
        EXPECT_NEAR(phase.share_beyond(0.5 * pi) / row.backscatter, 1.0, kPrinted) << row.index;
    }
}

// Through d = 1, where the formula is 0/0.
TEST(TracedWater, FournierAndForandIsSmoothWhereItsFormulaEnds) {
    const FournierForand kind{.index = 1.1, .slope = 3.5835};
    const PhaseFunction other{.name = "ff", .kind = kind};
    const TracedPhase phase(other);
    const double at_one = 2.0 * std::asin(0.5 * std::sqrt(3.0) * (kind.index - 1.0));
    for (const double off : {-1e-2, -1e-4, -2e-5, 0.0, 1e-9, 3e-5, 6e-5, 1e-3, 0.1}) {
        const double psi = at_one * (1.0 + off);
        EXPECT_NEAR(phase.at(psi) / other.at(psi), 1.0, kOfQuadrature) << off;
    }
}

TEST(TracedWater, MoleculesScatterAsMuchBackAsForth) {
    const TracedPhase phase({.name = "sea", .kind = MolecularScattering{}});
    EXPECT_NEAR(phase.share_beyond(0.5 * pi), 0.5, kOfQuadrature);
    // Rayleigh without depolarisation: 3 (1 + cos^2) / (16 pi).
    const TracedPhase rayleigh({.name = "r", .kind = MolecularScattering{.depolarisation = 0.0}});
    EXPECT_NEAR(rayleigh.at(0.5 * pi), 3.0 / (16.0 * pi), kOfQuadrature);
}

TEST(TracedWater, AllLightGoesSomewhere) {
    constexpr double kForward = 1e-30;  // [rad]
    EXPECT_NEAR(henyey_greenstein(0.924).share_beyond(kForward), 1.0, kOfQuadrature);
    const TracedPhase table(builtin_phase("petzold"));
    constexpr double kScaledToAll = 1e-9;
    EXPECT_NEAR(table.share_beyond(kForward), 1.0, kScaledToAll);
    EXPECT_EQ(table.share_beyond(pi), 0.0);
}

// Integrals of Petzold's tables as others print them, to two digits.
TEST(TracedWater, PetzoldsSharesArePublished) {
    struct Published {
        const char* name;
        double within_1, within_5, within_10, within_30;
    };
    constexpr double kPrinted = 0.0075;
    for (const Published& row : {Published{"petzold-clear", 0.20, 0.46, 0.60, 0.83},
                                 Published{"petzold-coast", 0.35, 0.62, 0.75, 0.92}}) {
        const TracedPhase phase(builtin_phase(row.name));
        EXPECT_NEAR(1.0 - phase.share_beyond(1.0 * kDegree), row.within_1, kPrinted) << row.name;
        EXPECT_NEAR(1.0 - phase.share_beyond(5.0 * kDegree), row.within_5, kPrinted) << row.name;
        EXPECT_NEAR(1.0 - phase.share_beyond(10.0 * kDegree), row.within_10, kPrinted) << row.name;
        EXPECT_NEAR(1.0 - phase.share_beyond(30.0 * kDegree), row.within_30, kPrinted) << row.name;
    }
}

// A table's p by another quadrature, and the same at its rows and between them.
TEST(TracedWater, TablesAreScaledAlike) {
    const PhaseFunction other = builtin_phase("petzold");
    const TracedPhase phase(other);
    for (const double degrees : {0.2, 1.0, 5.0, 9.9, 10.0, 30.0, 45.0, 91.0, 179.0}) {
        const double psi = degrees * kDegree;
        EXPECT_NEAR(phase.at(psi) / other.at(psi), 1.0, 1e-9) << degrees;
        EXPECT_NEAR(phase.share_beyond(psi), 1.0 - other.share_within(psi), 1e-9) << degrees;
    }
}

TEST(TracedWater, LosesWhatIsTurnedBeyondTheCut) {
    Water water{.absorption_per_m = flat(0.1), .multiple = 0.5, .uniform_loss_per_m = 0.02};
    EXPECT_FALSE(TracedWater(water).scatters());
    EXPECT_EQ(TracedWater(water).loss_per_m(kNm), water.attenuation_per_m(kNm));
    water.scatterers = {{flat(0.4), {.name = "even", .kind = HenyeyGreenstein{.g = 0.0}}},
                        {flat(0.002), {.name = "sea", .kind = MolecularScattering{}}}};
    const TracedWater traced(water);
    // Even scattering: (1 + cos)/2 is beyond.
    const double sea = 0.002 * traced.phases()[1].share_beyond(kLossCut);
    EXPECT_NEAR(traced.loss_per_m(kNm),
                0.5 * (0.1 + 0.2 * (1.0 + std::cos(45.0 * kDegree)) + sea) + 0.02,
                kOfQuadrature);
    EXPECT_NEAR(traced.loss_per_m(kNm), water.attenuation_per_m(kNm), kOfQuadrature);
    EXPECT_NEAR(traced.scattering_per_m(0, kNm), 0.2, kOfQuadrature);
    water.multiple = 0.0;
    EXPECT_FALSE(TracedWater(water).scatters());
    EXPECT_EQ(TracedWater(water).loss_per_m(kNm), 0.02);
}

}  // namespace aphotic::traced_water_test
