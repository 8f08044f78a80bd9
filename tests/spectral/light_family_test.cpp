// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/light_family.h"

#include "spectral/curve_loader.h"
#include "support/dice.h"
#include "support/light_family.h"
#include "support/simpson.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace aphotic::light_family_test {
namespace {

constexpr WavelengthRange kRange{400.0, 700.0};
constexpr double kWidth_nm = 300.0;
// What some thousand additions of numbers of one sign may lose.
constexpr double kRounding = 1e-13;

// The signal that a rule gives to a source after a path.
double applied(const std::vector<WeightedWavelength>& rule,
               const std::vector<Spectrum>& source,
               const Water& water,
               double path_m,
               std::size_t channel) {
    double sum = 0.0;
    for (const WeightedWavelength& w : rule) {
        double f = w.weight[channel];
        for (const Spectrum& curve : source) f *= curve.at(w.lambda_nm);
        const double K_per_m =
            water.uniform_loss_per_m +
            (water.multiple > 0.0 ? water.multiple * water.absorption_per_m.at(w.lambda_nm) : 0.0);
        sum += f * std::exp(-K_per_m * path_m);
    }
    return sum;
}

double total_weight(const std::vector<WeightedWavelength>& rule, std::size_t channel) {
    double sum = 0.0;
    for (const WeightedWavelength& w : rule) sum += w.weight[channel];
    return sum;
}

// --- The reference grid against integrals done by hand -------------------------------------

// K a straight line from k0 to k1 over the range, all else flat:
//   T_c(l) = q_c W (exp(-k0 l) - exp(-k1 l)) / ((k1 - k0) l)
TEST(ReferenceGrid, IntegratesAnExponentialToTheStatedError) {
    const double k0_per_m = 0.02;
    for (const double rise_per_m : {0.1, 1.0, 4.0}) {
        const Water water{.absorption_per_m = line(k0_per_m, k0_per_m + rise_per_m)};
        const auto family = family_of({{flat(1.0)}}, water, 1.0, 3.0);
        for (const double error : {1e-3, 1e-6, 1e-9}) {
            const auto grid = reference_grid(flat_sensor(), family, kRange, error);
            for (const double path_m : {1.0, 2.0, 3.0}) {
                const double T_nm =
                    kWidth_nm *
                    (std::exp(-k0_per_m * path_m) - std::exp(-(k0_per_m + rise_per_m) * path_m)) /
                    (rise_per_m * path_m);
                for (std::size_t c = 0; c < kChannels; ++c) {
                    const double right = (static_cast<double>(c) + 1.0) * T_nm;
                    EXPECT_NEAR(applied(grid, {flat(1.0)}, water, path_m, c) / right,
                                1.0,
                                error + kRounding)
                        << "K rises by " << rise_per_m << " 1/m; path " << path_m << " m";
                }
            }
        }
    }
}

// The same where the light falls by factors of up to exp(3e6) between two knots, towards either
// end: no rule of a dozen points reaches that.
TEST(ReferenceGrid, HoldsItsErrorHoweverSteeplyLightFalls) {
    constexpr double kError = 1e-8;
    for (const double rise_per_m : {8.0, 30.0, -30.0, 400.0, -1e6}) {
        const Water water{.absorption_per_m =
                              line(std::max(0.0, -rise_per_m), std::max(0.0, rise_per_m))};
        const auto family = family_of({{flat(1.0)}}, water, 0.5, 3.0);
        const auto grid = reference_grid(flat_sensor(), family, kRange, kError);
        for (const double path_m : {0.5, 1.3, 3.0}) {
            const double x = std::abs(rise_per_m) * path_m;
            const double T_nm = kWidth_nm * (1.0 - std::exp(-x)) / x;
            EXPECT_NEAR(
                applied(grid, {flat(1.0)}, water, path_m, 0) / T_nm, 1.0, kError + kRounding)
                << "K rises by " << rise_per_m << " 1/m; path " << path_m << " m";
        }
    }
}

// A loss without colour is a factor, even exp(-3000), which is zero to a double: what the grid is
// right for without it, it is right for with it.
TEST(ReferenceGrid, HoldsItsErrorWhereLightIsTooLittleForADouble) {
    constexpr double kError = 1e-8;
    const Water coloured{.absorption_per_m = line(0.0, 4.0)};
    for (const double loss_per_m : {100.0, 300.0, 1000.0, 1e4}) {
        Water black = coloured;
        black.uniform_loss_per_m = loss_per_m;
        const auto family = family_of({{flat(1.0)}}, black, 1.0, 3.0);
        const auto grid = reference_grid(flat_sensor(), family, kRange, kError);
        for (const double path_m : {1.0, 1.3, 3.0}) {
            const double x = 4.0 * path_m;
            const double T_nm = kWidth_nm * (1.0 - std::exp(-x)) / x;
            EXPECT_NEAR(
                applied(grid, {flat(1.0)}, coloured, path_m, 0) / T_nm, 1.0, kError + kRounding)
                << "beside " << loss_per_m << " 1/m; path " << path_m << " m";
        }
    }
}

// From nothing, and to a hundred times the shortest.
TEST(ReferenceGrid, HoldsItsErrorOverALongRangeOfPaths) {
    constexpr double kError = 1e-8;
    const Water water{.absorption_per_m = line(0.0, 1.0)};
    for (const double shortest_m : {0.0, 0.5}) {
        const auto family = family_of({{flat(1.0)}}, water, shortest_m, 50.0);
        const auto grid = reference_grid(flat_sensor(), family, kRange, kError);
        for (const double path_m : {0.5, 2.0, 7.0, 20.0, 50.0}) {
            const double T_nm = kWidth_nm * (1.0 - std::exp(-path_m)) / path_m;
            EXPECT_NEAR(
                applied(grid, {flat(1.0)}, water, path_m, 0) / T_nm, 1.0, kError + kRounding)
                << "path " << path_m << " m of " << shortest_m << " to 50 m";
        }
    }
}

// int_0^1 t^k dt = 1 / (k + 1): lamp t, reflectance t, response t.
TEST(ReferenceGrid, IntegratesTheProductOfThreeLinesExactly) {
    const Sensor sensor({line(0.0, 1.0), flat(1.0), line(1.0, 0.0)}, ResponseKind::Energy);
    const std::vector<Spectrum> source{line(0.0, 1.0), line(0.0, 1.0)};
    const auto family = family_of({source}, clear_water(), 1.0, 2.0);
    const auto grid = reference_grid(sensor, family, kRange, 1e-12);
    EXPECT_NEAR(applied(grid, source, clear_water(), 1.0, 0), kWidth_nm / 4.0, kRounding * 75.0);
    EXPECT_NEAR(applied(grid, source, clear_water(), 1.0, 1), kWidth_nm / 3.0, kRounding * 100.0);
    EXPECT_NEAR(applied(grid, source, clear_water(), 1.0, 2), kWidth_nm / 12.0, kRounding * 25.0);
}

// A line of 0.2 nm with an area of 0.1 nm, which no grid finds that does not know the table's
// knots; once in every table that a family has.
TEST(ReferenceGrid, KnowsTheKnotsOfEveryTable) {
    const Spectrum peak("peak", {300.0, 549.9, 550.0, 550.1, 800.0}, {0.0, 0.0, 1.0, 0.0, 0.0});
    constexpr double kArea_nm = 0.1;
    const auto energy_of = [](const Sensor& sensor, const std::vector<Spectrum>& source) {
        const auto family = family_of({source}, clear_water(), 1.0, 2.0);
        const auto grid = reference_grid(sensor, family, kRange, 1e-9);
        return applied(grid, source, clear_water(), 1.0, 0);
    };
    EXPECT_NEAR(energy_of(flat_sensor(), {peak}), kArea_nm, 1e-9 * kArea_nm);
    EXPECT_NEAR(energy_of(flat_sensor(), {flat(1.0), peak}), kArea_nm, 1e-9 * kArea_nm);
    const Sensor narrow({peak, flat(1.0), flat(1.0)}, ResponseKind::Energy);
    EXPECT_NEAR(energy_of(narrow, {flat(1.0)}), kArea_nm, 1e-9 * kArea_nm);

    // In the water it takes light away: 1 - exp(-t) has the mean 1/e over t from 0 to 1, and so
    // over both its flanks.
    const Water water{.absorption_per_m = peak};
    const auto family = family_of({{flat(1.0)}}, water, 1.0, 1.0);
    const auto grid = reference_grid(flat_sensor(), family, kRange, 1e-9);
    const double lost_nm = 0.2 * std::exp(-1.0);
    EXPECT_NEAR(kWidth_nm - applied(grid, {flat(1.0)}, water, 1.0, 0), lost_nm, 1e-9 * kWidth_nm);
}

// Behind a port a member's light takes in exp(t tilt), t from -1 to 1: for a straight tilt from 0
// to h that is W (exp(t h) - 1) / (t h), and a peak in it is found as in any other table.
TEST(ReferenceGrid, IntegratesTheTiltOfEitherSign) {
    const auto lit =
        [](const std::vector<WeightedWavelength>& grid, const Spectrum& tilt, double t) {
            double sum = 0.0;
            for (const WeightedWavelength& w : grid) {
                sum += w.weight[0] * std::exp(t * tilt.at(w.lambda_nm));
            }
            return sum;
        };
    auto family = family_of({{flat(1.0)}}, clear_water(), 1.0, 2.0);
    for (const double h : {0.03, 0.1, 0.3, 1.0, -1.0, 3.0, -3.0}) {
        family.tilt = line(0.0, h);
        for (const double error : {1e-3, 1e-6, 1e-9}) {
            const auto grid = reference_grid(flat_sensor(), family, kRange, error);
            for (const double t : {-1.0, -0.4, 0.5, 1.0}) {
                const double right = kWidth_nm * (std::exp(t * h) - 1.0) / (t * h);
                EXPECT_NEAR(lit(grid, *family.tilt, t) / right, 1.0, error + kRounding)
                    << "tilt up to " << h << ", " << t << " of it, " << grid.size() << " points";
            }
        }
    }
    constexpr double kError = 1e-9;
    // Over a flank of a triangle exp(t s), s from 0 to 1: (exp(t) - 1) / t of its width.
    family.tilt = Spectrum("peak", {300.0, 549.9, 550.0, 550.1, 800.0}, {0.0, 0.0, 1.0, 0.0, 0.0});
    const auto grid = reference_grid(flat_sensor(), family, kRange, kError);
    for (const double t : {-1.0, 1.0}) {
        const double right = kWidth_nm - 0.2 + 0.2 * (std::exp(t) - 1.0) / t;
        EXPECT_NEAR(lit(grid, *family.tilt, t) / right, 1.0, kError + kRounding) << t;
    }
}

TEST(ReferenceGrid, CoversARangeThatEndsBetweenKnots) {
    const Sensor sensor({line(0.0, 3.0), flat(1.0), flat(1.0)}, ResponseKind::Energy);
    const WavelengthRange range{433.0, 611.0};
    const auto family = family_of({{flat(1.0)}}, clear_water(), 1.0, 2.0);
    const auto grid = reference_grid(sensor, family, range, 1e-10);
    // int of (lambda - 400) / 100 from 433 to 611.
    EXPECT_NEAR(total_weight(grid, 0), (211.0 * 211.0 - 33.0 * 33.0) / 200.0, kRounding * 300.0);
    EXPECT_NEAR(total_weight(grid, 1), 178.0, kRounding * 178.0);
    for (const WeightedWavelength& w : grid) EXPECT_TRUE(range.contains(w.lambda_nm));
}

TEST(ReferenceGrid, GoesUpInWavelengthWithoutRepeats) {
    const auto family =
        family_of({load_curves("xenon-flash", CurveRole::LampSpectrum, {})},
                  {.absorption_per_m = load_curve("pope-fry-1997", CurveRole::WaterAbsorption, {})},
                  1.0,
                  10.0);
    const auto grid = reference_grid(builtin_sensor("nikon-d5100"), family, kRange, 1e-8);
    for (std::size_t j = 1; j < grid.size(); ++j) {
        EXPECT_LT(grid[j - 1].lambda_nm, grid[j].lambda_nm);
    }
}

TEST(ReferenceGrid, DoesNotReadTheWaterOfMultipleZero) {
    const Water water{.absorption_per_m = Spectrum("short", {500.0, 510.0}, {1.0, 1.0}),
                      .multiple = 0.0,
                      .uniform_loss_per_m = 0.25};
    const auto family = family_of({{flat(1.0)}}, water, 1.0, 2.0);
    const auto grid = reference_grid(flat_sensor(), family, kRange, 1e-9);
    EXPECT_EQ(grid.size(), 1U);
    EXPECT_NEAR(total_weight(grid, 0), kWidth_nm, kRounding * kWidth_nm);
}

// 1 photon per joule and nanometre of wavelength is 1e-9 / (h c) = 5.03411657e15: CODATA 2018,
// of which h and c are exact. int lambda dlambda from 400 to 700 nm is 165 000 nm^2.
TEST(ReferenceGrid, CountsPhotonsForAQuantumResponse) {
    constexpr double kPhotons_per_j_nm = 5.03411657e15;
    constexpr double kDigits = 2e-9;  // of that number
    const auto family = family_of({{flat(1.0)}}, clear_water(), 1.0, 2.0);
    const auto grid = reference_grid(flat_sensor(ResponseKind::Quantum), family, kRange, 1e-10);
    EXPECT_NEAR(total_weight(grid, 0) / (165000.0 * kPhotons_per_j_nm), 1.0, kDigits);
    EXPECT_NEAR(total_weight(grid, 2) / total_weight(grid, 0), 3.0, kRounding);
}

TEST(ReferenceGrid, BearsAChannelAndALampThatSeeNothing) {
    const Sensor sensor({flat(0.0), flat(1.0), line(0.0, 1.0)}, ResponseKind::Energy);
    const auto family = family_of({{flat(0.0)}, {flat(1.0)}}, clear_water(), 1.0, 2.0);
    const auto grid = reference_grid(sensor, family, kRange, 1e-9);
    EXPECT_EQ(total_weight(grid, 0), 0.0);
    EXPECT_NEAR(total_weight(grid, 1), kWidth_nm, kRounding * kWidth_nm);
    EXPECT_NEAR(total_weight(grid, 2), 0.5 * kWidth_nm, kRounding * kWidth_nm);
}

TEST(ReferenceGrid, BearsAFamilyWithoutSources) {
    const auto grid =
        reference_grid(flat_sensor(), family_of({}, clear_water(), 0.0, 0.0), kRange, 1e-9);
    EXPECT_NEAR(total_weight(grid, 0), kWidth_nm, kRounding * kWidth_nm);
}

// --- The reference grid against brute force ------------------------------------------------

class Dice : public aphotic::Dice {
  public:
    using aphotic::Dice::Dice;
    Spectrum table(double most) {
        std::vector<double> lambda_nm{400.0 - between(0.0, 5.0)};
        std::vector<double> value{between(0.0, most)};
        const double spacing_nm = between(8.0, 80.0);
        while (lambda_nm.back() < 700.0) {
            lambda_nm.push_back(lambda_nm.back() + between(0.1, 2.0) * spacing_nm);
            value.push_back(between(0.0, most));
        }
        return {"random", lambda_nm, value};
    }
};

TEST(ReferenceGrid, HoldsItsErrorForRandomFamilies) {
    constexpr double kError = 1e-8;
    // Simpson errs by x^4 / (2880 n^4) of an interval over which the exponent runs through x;
    // here x reaches some 120, in intervals that give little to the whole.
    constexpr int kPanels = 512;
    constexpr double kSimpsonError = 2e-9;
    Dice dice(1);
    for (int trial = 0; trial < 12; ++trial) {
        const bool is_quantum = trial % 2 == 1;
        const Sensor sensor({dice.table(1.0), dice.table(1.0), dice.table(1.0)},
                            is_quantum ? ResponseKind::Quantum : ResponseKind::Energy);
        LightFamily family = family_of({},
                                       {.absorption_per_m = dice.table(0.7),
                                        .multiple = trial == 0 ? 0.0 : dice.between(0.0, 20.0),
                                        .uniform_loss_per_m = 0.1},
                                       dice.between(0.2, 3.0),
                                       0.0);
        family.longest_path_m = family.shortest_path_m * dice.between(1.0, 6.0);
        std::vector<const Spectrum*> curves = sensor.curves();
        curves.push_back(&family.water.absorption_per_m);
        for (int s = 0; s <= trial % 3; ++s) {
            family.sources.push_back({dice.table(5.0), dice.table(0.5)});
            family.sources.push_back({family.sources.back().front()});
        }
        for (const auto& source : family.sources) {
            for (const Spectrum& curve : source) curves.push_back(&curve);
        }
        const auto nodes = simpson_nodes(knots_within(kRange, curves), kPanels);
        const auto grid = reference_grid(sensor, family, kRange, kError);
        const double path_m = dice.between(family.shortest_path_m, family.longest_path_m);
        for (std::size_t s = 0; s < family.sources.size(); ++s) {
            for (const double l_m : {family.shortest_path_m, path_m, family.longest_path_m}) {
                const std::size_t c = s % kChannels;
                double right = 0.0;
                for (const auto& [nm, weight_nm] : nodes) {
                    double f = weight_nm * sensor.response(static_cast<int>(c), nm);
                    for (const Spectrum& curve : family.sources[s]) f *= curve.at(nm);
                    right += f * std::exp(-family.water.attenuation_per_m(nm) * l_m);
                }
                const double found = applied(grid, family.sources[s], family.water, l_m, c);
                EXPECT_NEAR(found / right, 1.0, kError + kSimpsonError)
                    << "family " << trial << ", source " << s << ", path " << l_m << " m, "
                    << grid.size() << " points";
            }
        }
    }
}

}  // namespace
}  // namespace aphotic::light_family_test
