// SPDX-License-Identifier: BSD-3-Clause
//
// Phase functions against printed numbers and closed forms.
#include "spectral/phase_function.h"

#include "spectral/phase_loader.h"

#include <gtest/gtest.h>
#include <boost/math/quadrature/tanh_sinh.hpp>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace aphotic::phase_function_test {
namespace {

using std::numbers::pi;

constexpr double kDegree = pi / 180.0;

// 2 pi int_from^to p sin(psi) f(psi) dpsi, in the logarithm of the angle.
double moment(const PhaseFunction& phase, double from_rad, double to_rad, const auto& f) {
    boost::math::quadrature::tanh_sinh<double> quadrature;
    const auto by_log = [&](double log_psi) {
        const double psi = std::exp(log_psi);
        return 2.0 * pi * phase.at(psi) * std::sin(psi) * f(psi) * psi;
    };
    return quadrature.integrate(by_log, std::log(from_rad), std::log(to_rad));
}

std::vector<PhaseFunction> some_of_each_kind() {
    return {{.name = "hg", .kind = HenyeyGreenstein{.g = 0.924}},
            {.name = "back", .kind = HenyeyGreenstein{.g = -0.9}},
            fournier_forand(0.0183),
            {.name = "ff", .kind = FournierForand{.index = 1.15, .slope = 4.874}},
            {.name = "sea", .kind = MolecularScattering{}}};
}

}  // namespace

// At 0, a right angle and straight back, by hand.
TEST(PhaseFunction, OfHenyeyAndGreensteinIsTheClosedForm) {
    const double g = 0.8;
    const PhaseFunction phase{.name = "hg", .kind = HenyeyGreenstein{.g = g}};
    EXPECT_DOUBLE_EQ(phase.at(0.0), (1.0 + g) / (4.0 * pi * (1.0 - g) * (1.0 - g)));
    EXPECT_DOUBLE_EQ(phase.at(0.5 * pi), (1.0 - g * g) / (4.0 * pi * std::pow(1.0 + g * g, 1.5)));
    EXPECT_DOUBLE_EQ(phase.at(pi), (1.0 - g) / (4.0 * pi * (1.0 + g) * (1.0 + g)));
    const double back = (1.0 - g) / (2.0 * g) * ((1.0 + g) / std::sqrt(1.0 + g * g) - 1.0);
    EXPECT_NEAR(phase.backscatter_ratio(), back, 1e-15);
}

// Forward is where g is over 0; of -g it is the mirror image.
TEST(PhaseFunction, IsForwardWhereGIsPositive) {
    const PhaseFunction forward{.name = "hg", .kind = HenyeyGreenstein{.g = 0.7}};
    const PhaseFunction back{.name = "hg", .kind = HenyeyGreenstein{.g = -0.7}};
    EXPECT_GT(forward.at(0.1), forward.at(3.0));
    for (const double psi : {0.01, 0.5, 1.5, 3.0}) {
        EXPECT_NEAR(back.at(pi - psi) / forward.at(psi), 1.0, 1e-12);
        EXPECT_NEAR(back.share_within(pi - psi), 1.0 - forward.share_within(psi), 1e-12);
    }
}

// The mean cosine of Henyey and Greenstein's is g, molecules have none, and all light goes
// somewhere.
TEST(PhaseFunction, HasItsMeanCosine) {
    constexpr double kOfQuadrature = 1e-7;
    constexpr double kLeast = 1e-10;  // [rad]
    const auto cosine = [](double psi) { return std::cos(psi); };
    for (const double g : {-0.9, 0.3, 0.924}) {
        const PhaseFunction phase{.name = "hg", .kind = HenyeyGreenstein{.g = g}};
        EXPECT_NEAR(moment(phase, kLeast, pi, cosine), g, kOfQuadrature);
    }
    EXPECT_NEAR(moment({.name = "sea", .kind = MolecularScattering{}}, kLeast, pi, cosine),
                0.0,
                kOfQuadrature);
}

// share_within, a closed form of its own, is the integral of at.
TEST(PhaseFunction, ItsShareIsItsIntegral) {
    constexpr double kOfQuadrature = 1e-9;
    const auto one = [](double) { return 1.0; };
    for (const PhaseFunction& phase : some_of_each_kind()) {
        EXPECT_EQ(phase.share_within(0.0), 0.0) << phase.name;
        EXPECT_NEAR(phase.share_within(pi), 1.0, 1e-12) << phase.name;
        for (const auto& [from, to] : {std::pair{1e-3, 0.1}, {0.1, 1.0}, {1.0, 2.0}, {2.0, pi}}) {
            EXPECT_NEAR(phase.share_within(to) - phase.share_within(from),
                        moment(phase, from, to, one),
                        kOfQuadrature)
                << phase.name << ", " << from;
        }
    }
}

// (n, mu) and their b_b/b along the line of Mobley, Sundman and Boss (2002), and two that lie off
// it; printed to three or four digits.
TEST(PhaseFunction, OfFournierAndForandScattersBackAsPublished) {
    struct Published {
        double index;
        double slope;
        double backscatter;
    };
    constexpr double kPrinted = 5e-3;
    for (const Published& row : {Published{1.04, 3.201, 0.00100},
                                 Published{1.08, 3.483, 0.01004},
                                 Published{1.175, 4.065, 0.1001},
                                 Published{1.15, 4.874, 0.4005},
                                 Published{1.10, 3.5835, 0.0183}}) {
        const PhaseFunction phase{.name = "ff",
                                  .kind = FournierForand{.index = row.index, .slope = row.slope}};
        EXPECT_NEAR(phase.backscatter_ratio() / row.backscatter, 1.0, kPrinted) << row.index;
    }
    for (const double ratio : {kLeastBackscatter, 0.0183, 0.1, kMostBackscatter}) {
        const PhaseFunction phase = fournier_forand(ratio);
        EXPECT_NEAR(phase.backscatter_ratio(), ratio, 1e-9);
        const auto& kind = std::get<FournierForand>(phase.kind);
        EXPECT_NEAR(kind.index, 1.01 + 0.1542 * (kind.slope - 3.0), 1e-12);
    }
}

// Petzold's report prints b and b_b/b of its stations; their tables are of the volume scattering
// function, b p. (The average particle's: Mobley et al. 1993.)
TEST(PhaseFunction, OfPetzoldsStationsHasTheirPrintedIntegrals) {
    struct Printed {
        const char* name;
        double scattering_per_m;  // 0: the table has no scale
        double backscatter;
        double mean_cosine;  // 0: not printed
    };
    for (const Printed& row : {Printed{"petzold-clear", 0.037, 0.044, 0.0},
                               Printed{"petzold-coast", 0.219, 0.013, 0.0},
                               Printed{"petzold-harbour", 1.824, 0.020, 0.0},
                               Printed{"petzold", 0.0, 0.0183, 0.924}}) {
        const PhaseFunction phase = builtin_phase(row.name);
        constexpr double kTwoDigits = 5.5e-4;
        EXPECT_NEAR(phase.backscatter_ratio(), row.backscatter, kTwoDigits) << row.name;
        const auto found = std::ranges::find(builtin_phase_tables(), row.name, &BuiltinTable::name);
        const Table table = parse_table(row.name, found->csv);
        if (row.scattering_per_m > 0.0) {
            constexpr double kOfB = 7e-3;  // three digits, and the rule between rows
            const double at = phase.at(table.rows[20].fields[0] * kDegree);
            EXPECT_NEAR(table.rows[20].fields[1] / at / row.scattering_per_m, 1.0, kOfB)
                << row.name;
        }
        if (row.mean_cosine > 0.0) {
            constexpr double kThreeDigits = 1e-3;
            const double below = phase.share_within(0.1 * kDegree);  // turned by nothing
            EXPECT_NEAR(
                below + moment(phase, 0.1 * kDegree, pi, [](double psi) { return std::cos(psi); }),
                row.mean_cosine,
                kThreeDigits);
        }
    }
}

// 3 (1 + P cos^2) / (4 pi (3 + P)) with P = 0.925 (Zhang, Hu and He 2009): as much back as forth.
TEST(PhaseFunction, OfMoleculesIsThePublished) {
    const PhaseFunction sea = builtin_phase("sea-water");
    constexpr double kThreeDigits = 5e-4;
    EXPECT_NEAR(sea.at(0.5 * pi) / (3.0 / (4.0 * pi * 3.925)), 1.0, kThreeDigits);
    EXPECT_NEAR(sea.at(0.0) / sea.at(0.5 * pi), 1.925, kThreeDigits);
    EXPECT_NEAR(sea.backscatter_ratio(), 0.5, 1e-15);
}

// 1/psi at its rows is 1/psi between and below them.
TEST(PhaseFunction, OfATableIsAPowerLawBetweenItsRows) {
    const std::vector<double> angles{0.01, 0.1, 1.0, pi};
    std::vector<double> values;
    for (const double psi : angles) values.push_back(7.0 / psi);
    const PhaseFunction phase = phase_table("power", angles, values);
    EXPECT_NEAR(phase.at(0.03) / phase.at(0.3), 10.0, 1e-12);
    EXPECT_NEAR(phase.at(0.001) / phase.at(0.01), 10.0, 1e-12) << "below the first row";
    EXPECT_EQ(phase.share_within(pi), 1.0);
}

}  // namespace aphotic::phase_function_test
