// SPDX-License-Identifier: BSD-3-Clause
//
// The turns that a Monte Carlo draws against the phase functions that they are of.
#include "validation/turn_table.h"

#include "spectral/phase_loader.h"
#include "support/flat.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace aphotic::turn_table_test {
namespace {

using std::numbers::pi;

constexpr double kNm = 500.0;
constexpr double kLeast = 0.02;
constexpr double kOfNodes = 1e-4;  // as the header says

TracedWater two_scatterers() {
    return TracedWater({.absorption_per_m = flat(0.1),
                        .scatterers = {{flat(0.3), builtin_phase("petzold")},
                                       {flat(0.1), {.name = "even", .kind = HenyeyGreenstein{}}}}});
}

}  // namespace

TEST(TurnTable, IsTheMixtureOfWhatScatters) {
    const TracedWater water = two_scatterers();
    const TurnTable turns(water, kNm, kLeast);
    const double petzold = water.phases()[0].share_beyond(kLeast);
    const double even = 0.5 * (1.0 + std::cos(kLeast));
    const double all = 0.3 * petzold + 0.1 * even;
    EXPECT_NEAR(turns.scattering_per_m(), all, 1e-9);
    for (const double psi : {0.0201, 0.05, 0.3, 1.0, 2.0, 3.0, 3.14}) {
        const double mixed = (0.3 * water.phases()[0].at(psi) + 0.1 / (4.0 * pi)) / all;
        EXPECT_NEAR(turns.density(psi) / mixed, 1.0, kOfNodes) << psi;
    }
    EXPECT_EQ(turns.density(0.0199), 0.0);
}

// The share of turns below psi is 1 - S(psi)/S(least).
TEST(TurnTable, DrawsAsManyOfEachTurnAsThereAre) {
    const TracedWater water = two_scatterers();
    const TurnTable turns(water, kNm, kLeast);
    const auto beyond = [&](double psi) {
        return 0.3 * water.phases()[0].share_beyond(psi) + 0.1 * 0.5 * (1.0 + std::cos(psi));
    };
    for (const double uniform : {0.0, 0.1, 0.5, 0.9, 0.999, 1.0 - 0x1p-53}) {
        const double psi = turns.quantile(uniform);
        ASSERT_GE(psi, kLeast);
        ASSERT_LE(psi, pi);
        EXPECT_NEAR(1.0 - beyond(psi) / beyond(kLeast), uniform, kOfNodes);
    }
}

}  // namespace aphotic::turn_table_test
