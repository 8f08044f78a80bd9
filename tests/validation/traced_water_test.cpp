// SPDX-License-Identifier: BSD-3-Clause
//
// Losses and phase functions of the reference against the formulas of spectral/, of which it has no
// line, and which are held to published numbers.
#include "validation/traced_water.h"

#include "spectral/phase_loader.h"
#include "support/flat.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace aphotic::traced_water_test {
namespace {

using std::numbers::pi;

constexpr double kDegree = pi / 180.0;
constexpr double kOfQuadrature = 1e-10;
constexpr double kNm = 500.0;

}  // namespace

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

// By formulas and quadratures of its own; those of spectral/ are held to what is published.
TEST(TracedWater, ScattersAsSpectralSaysAtAnyAngle) {
    std::vector<PhaseFunction> phases;
    for (const double g : {-0.7, 0.0, 0.3, 0.924, 0.99})
        phases.push_back({.name = "hg", .kind = HenyeyGreenstein{.g = g}});
    for (const auto& [index, slope] : {std::pair{1.08, 3.483}, {1.15, 4.874}, {1.1, 3.5835}})
        phases.push_back({.name = "ff", .kind = FournierForand{.index = index, .slope = slope}});
    for (const char* name : {"petzold", "petzold-clear", "petzold-coast", "sea-water"})
        phases.push_back(builtin_phase(name));
    constexpr double kTwoQuadratures = 1e-9;
    for (const PhaseFunction& other : phases) {
        SCOPED_TRACE(other.name);
        const TracedPhase phase(other);
        for (const double degrees : {0.2, 1.0, 5.0, 9.9, 10.0, 30.0, 45.0, 91.0, 179.0}) {
            const double psi = degrees * kDegree;
            EXPECT_NEAR(phase.at(psi) / other.at(psi), 1.0, kTwoQuadratures) << degrees;
            EXPECT_NEAR(phase.share_beyond(psi), 1.0 - other.share_within(psi), kTwoQuadratures)
                << degrees;
        }
        EXPECT_EQ(phase.share_beyond(pi), 0.0);
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
