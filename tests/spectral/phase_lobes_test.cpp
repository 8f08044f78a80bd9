// SPDX-License-Identifier: BSD-3-Clause
//
// Phase functions as sums of lobes, against the functions themselves at angles between those of the
// fit.
#include "spectral/phase_lobes.h"

#include "spectral/curve_loader.h"
#include "spectral/phase_loader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aphotic::phase_lobes_test {
namespace {

using std::numbers::pi;

constexpr double kDegree = pi / 180.0;
constexpr double kRounding = 1e-12;
// Between the angles of the fit a smooth function is hardly farther off than at them.
constexpr double kBetween = 1.1;

const PhaseFunction kForward{.name = "forward", .kind = HenyeyGreenstein{.g = 0.924}};
const PhaseFunction kSea{.name = "molecular", .kind = MolecularScattering{}};

struct Found {
    double error = 0.0;
    double amplification = 0.0;
};

Found found(const PhaseFunction& phase,
            const PhaseLobes& lobes,
            const std::vector<double>& share,
            double from_rad,
            double to_rad) {
    constexpr int kSteps = 1777;
    Found worst;
    for (int i = 0; i <= kSteps; ++i) {
        const double psi_rad = std::lerp(from_rad, to_rad, i / double{kSteps});
        double sum = 0.0;
        double parts = 0.0;
        for (std::size_t m = 0; m < share.size(); ++m) {
            sum += share[m] * lobes.lobes[m].at(psi_rad);
            parts += std::abs(share[m]) * lobes.lobes[m].at(psi_rad);
        }
        worst.error = std::max(worst.error, std::abs(sum / phase.at(psi_rad) - 1.0));
        worst.amplification = std::max(worst.amplification, parts / phase.at(psi_rad));
    }
    return worst;
}

TEST(PhaseLobes, AreExactlyHenyeyAndGreensteinsAndMoleculars) {
    const std::vector<PhaseFunction> phases{kSea, kForward};
    const PhaseLobes lobes = lobes_of(phases, 60.0 * kDegree, pi);
    EXPECT_EQ(lobes.lobes.size(), 3U) << "Rayleigh's, the isotropic, and the forward one";
    EXPECT_EQ(lobes.error, 0.0);
    EXPECT_EQ(lobes.amplification, 1.0);
    // At all angles, not only where anything is fitted.
    for (std::size_t i = 0; i < phases.size(); ++i)
        EXPECT_LE(found(phases[i], lobes, lobes.share[i], 0.0, pi).error, kRounding);
}

TEST(PhaseLobes, OfFournierAndForandSufficeOverTheAnglesOfBackscatter) {
    for (const double backscatter : {0.005, 0.0135, 0.0183, 0.03}) {
        const PhaseFunction phase = fournier_forand(backscatter);
        const PhaseLobes lobes = lobes_of(std::vector{phase}, 60.0 * kDegree, pi);
        const Found worst = found(phase, lobes, lobes.share[0], 60.0 * kDegree, pi);
        EXPECT_LE(lobes.lobes.size(), kMostLobes);
        EXPECT_LE(worst.error, 2.0 * kLobesSuffice) << backscatter;
        EXPECT_LE(worst.error, kBetween * lobes.error) << backscatter;
        EXPECT_LE(worst.amplification, kBetween * lobes.amplification) << backscatter;
        EXPECT_LT(lobes.amplification, 4.0) << backscatter;
    }
}

// A table has kinks, which no lobe has: what is off is said.
TEST(PhaseLobes, OfATableSayHowFarTheyAreOff) {
    const PhaseFunction phase = builtin_phase("petzold");
    for (const double from_deg : {10.0, 60.0}) {
        const PhaseLobes lobes = lobes_of(std::vector{phase}, from_deg * kDegree, pi);
        EXPECT_EQ(lobes.lobes.size(), kMostLobes);
        EXPECT_LE(found(phase, lobes, lobes.share[0], from_deg * kDegree, pi).error,
                  kBetween * lobes.error);
        EXPECT_LT(lobes.error, 0.1);
        EXPECT_GT(lobes.error, kLobesSuffice);
    }
}

TEST(PhaseLobes, AreSharedByAllScatterers) {
    const std::vector<PhaseFunction> phases{kSea, fournier_forand(0.0183), kForward};
    const PhaseLobes lobes = lobes_of(phases, 60.0 * kDegree, pi);
    EXPECT_LE(lobes.lobes.size(), kMostLobes);
    for (std::size_t i = 0; i < phases.size(); ++i) {
        EXPECT_EQ(lobes.share[i].size(), lobes.lobes.size());
        EXPECT_LE(found(phases[i], lobes, lobes.share[i], 60.0 * kDegree, pi).error,
                  2.0 * kLobesSuffice);
    }
}

}  // namespace
}  // namespace aphotic::phase_lobes_test
