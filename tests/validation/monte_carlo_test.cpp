// SPDX-License-Identifier: BSD-3-Clause
//
// The Monte Carlo against closed forms of all orders of scattering, and against the reference's
// quadrature of the first.
#include "validation/monte_carlo.h"

#include "base/error.h"
#include "spectral/phase_loader.h"
#include "support/dice.h"
#include "support/effort.h"
#include "support/flat.h"
#include "support/veil_rig.h"
#include "validation/tracer.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/math/tools/roots.hpp>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace aphotic::monte_carlo_test {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kNm = 500.0;
constexpr double kFar = std::numeric_limits<double>::infinity();
// A mean is that far off once in 16,000 times; the seeds are fixed.
constexpr double kStandardErrors = 4.0;

// Two half spaces of even light make a lamp that shines alike everywhere, at intensity 1/(4 pi).
Rig even_lamp(double a, double b, PhaseFunction phase) {
    Rig rig = habcam();
    Beam beam{.name = "even", .weights = ConeWeights::Literal, .cones = {}};
    beam.cones = {
        {.part = "half", .half_angle_rad = 0.5 * pi, .weight = 0.25 / pi, .exponent = 0.0}};
    rig.strobes.erase(rig.strobes.begin() + 2, rig.strobes.end());
    for (Strobe& strobe : rig.strobes) {
        strobe.position_m = Vector3d::Zero();
        strobe.beam = beam;
        strobe.spectrum = flat(1.0);
        strobe.power = 1.0;
        strobe.emitter.reset();
    }
    rig.strobes[0].axis = Vector3d::UnitX();
    rig.strobes[1].axis = -Vector3d::UnitX();
    rig.sled = {.altitude_m = 1e6};
    rig.seafloor = {.reflectance = flat(0.0)};
    rig.water = {.absorption_per_m = flat(a), .scatterers = {{flat(b), std::move(phase)}}};
    return rig;
}

// A direction from which light comes, most of them from near the lamp, where most of it does; and
// the solid angle that it stands for.
struct Sight {
    Vector3d direction;
    double solid_angle;
};

Sight any_sight(const Vector3d& to_lamp, Dice& dice) {
    const double theta = pi * std::pow(dice.between(0.0, 1.0), 2.0);
    const double azimuth = dice.between(0.0, 2.0 * pi);
    const Vector3d side = to_lamp.unitOrthogonal();
    const Vector3d across =
        std::cos(azimuth) * side + std::sin(azimuth) * to_lamp.normalized().cross(side);
    const double density = 0.5 / std::sqrt(pi * theta) / (2.0 * pi * std::sin(theta));
    return {std::cos(theta) * to_lamp.normalized() + std::sin(theta) * across, 1.0 / density};
}

struct Mean {
    double sum = 0.0;
    double squares = 0.0;
    int count = 0;
    void add(double value) {
        sum += value;
        squares += value * value;
        ++count;
    }
    [[nodiscard]] double mean() const { return sum / count; }
    [[nodiscard]] double standard_error() const {
        return std::sqrt((squares / count - mean() * mean()) / (count - 1));
    }
};

// A mean that tells next to nothing is no test. Debug builds run few paths, for the sanitizers.
void expect_worth(const Mean& mean, double share) {
#ifdef NDEBUG
    EXPECT_LT(mean.standard_error(), share * mean.mean());
#else
    (void)mean;
    (void)share;
#endif
}

// The fluence of a lamp of flux 1 at the distance r, of all orders but the unscattered, in water
// that scatters evenly without end: Case, de Hoffmann and Placzek, Introduction to the Theory of
// Neutron Diffusion (1953), with lengths in 1/c and the albedo w.
double cases_fluence(double a, double b, double r_m) {
    const double c = a + b;
    const double w = b / c;
    const double r = c * r_m;
    const auto of_kappa = [&](double k) { return 0.5 * w / k * std::log((1 + k) / (1 - k)) - 1.0; };
    const boost::math::tools::eps_tolerance<double> digits(50);
    const auto bracket = boost::math::tools::bisect(of_kappa, 1e-9, 1.0 - 1e-15, digits);
    const double k2 = bracket.first * bracket.first;
    const double pole =
        2.0 * k2 * (1.0 - k2) / (w * (k2 - (1.0 - w))) * std::exp(-bracket.first * r);
    using Kronrod = boost::math::quadrature::gauss_kronrod<double, 61>;
    const double rest = Kronrod::integrate(
        [&](double mu) {
            const double one = 1.0 - w * mu * std::atanh(mu);
            const double other = 0.5 * pi * w * mu;
            return std::exp(-r / mu) / (mu * mu * (one * one + other * other));
        },
        0.0,
        1.0,
        15,
        1e-10);
    const double whole = c * c / (4.0 * pi * r) * (pole + rest);
    return whole - std::exp(-r) / (4.0 * pi * r_m * r_m);
}

}  // namespace

TEST(MonteCarlo, OfAllOrdersIsCasesClosedForm) {
    for (const auto& [a, b] : {std::pair{0.1, 0.4}, std::pair{0.4, 0.1}}) {
        for (const double r_m : {0.3, 2.0, 6.0}) {
            const MonteCarlo light(even_lamp(a, b, henyey_greenstein(0.0)),
                                   kNm,
                                   {.paths = 8, .seed = 5, .least_turn_rad = 1e-4});
            Dice dice(3);
            Mean fluence;
            for (int k = 0; k < cases(3000); ++k) {
                const Sight sight = any_sight(-Vector3d::UnitY(), dice);
                const VeilRay ray{Vector3d(0.0, r_m, 0.0), sight.direction, kFar};
                fluence.add(sight.solid_angle *
                            light.radiance(ray, static_cast<std::uint64_t>(k)).veil.mean);
            }
            EXPECT_NEAR(fluence.mean(),
                        cases_fluence(a, b, r_m),
                        kStandardErrors * fluence.standard_error())
                << a << ", " << b << ", " << r_m;
            expect_worth(fluence, 0.03);
        }
    }
}

// Random flights' second moment, of any phase function of the mean cosine g: light of a lamp of
// flux 1 without end that has been turned n times holds
//
//   int r^2 fluence_n dV = 2 b^n / c^(n + 3) sum over 0 <= i <= j <= n of g^(j - i)
//
// for the n + 1 flights' squares are 2/c^2 in the mean, and flights j - i apart lie along each
// other by g^(j - i).
TEST(MonteCarlo, SpreadsLightAsFarAsTheMeanCosineSays) {
    const double a = 0.5;
    const double b = 1.0;
    constexpr int kTurns = 3;
    for (const double g : {-0.5, 0.7, 0.9}) {
        const MonteCarlo light(
            even_lamp(a, b, henyey_greenstein(g)),
            kNm,
            {.paths = 4, .seed = 11, .most_turns = kTurns, .least_turn_rad = 1e-3});
        Dice dice(7);
        Mean moment;
        for (int k = 0; k < cases(8000); ++k) {
            // r by the density f^3 r^2 exp(-f r) / 2, wider than the light's own tail.
            const double f = 0.7;
            double r_m = 0.0;
            for (int i = 0; i < 3; ++i) r_m -= std::log1p(-dice.between(0.0, 1.0)) / f;
            const Sight sight = any_sight(-Vector3d::UnitZ(), dice);
            const VeilRay ray{Vector3d(0.0, 0.0, r_m), sight.direction, kFar};
            const double fluence =
                sight.solid_angle * light.radiance(ray, static_cast<std::uint64_t>(k)).veil.mean;
            const double drawn = 0.5 * f * f * f * r_m * r_m * std::exp(-f * r_m);
            moment.add(fluence * r_m * r_m * 4.0 * pi * r_m * r_m / drawn);
        }
        double expected = 0.0;
        for (int n = 1; n <= kTurns; ++n) {
            double sum = 0.0;
            for (int i = 0; i <= n; ++i) {
                for (int j = i; j <= n; ++j) sum += std::pow(g, j - i);
            }
            expected += 2.0 * std::pow(b, n) / std::pow(a + b, n + 3) * sum;
        }
        EXPECT_NEAR(moment.mean(), expected, kStandardErrors * moment.standard_error()) << g;
        expect_worth(moment, 0.05);
    }
}

// Of one turn at most, without loss by it: the reference's quadrature takes K for c.
TEST(MonteCarlo, OfTheFirstOrderIsTheQuadratures) {
    Rig rig = habcam();
    constexpr double kThin = 1e-6;  // [1/m], beside which the loss by turning is nothing
    rig.water = {.absorption_per_m = flat(0.2),
                 .scatterers = {{flat(kThin), builtin_phase("petzold")}}};
    const Tracer tracer(rig, {.signals = false, .planes_nm = {kNm}});
    const MonteCarlo light(rig, kNm, {.paths = 20000, .seed = 2, .most_turns = 1});
    const TracedVeil veil(rig, TracedWater(rig.water));
    for (const std::size_t pixel : {std::size_t{0}, std::size_t{1360 * 512 + 680}}) {
        const auto ray = tracer.ray(
            static_cast<double>(pixel % 1360) + 0.5, static_cast<double>(pixel / 1360) + 0.5, kNm);
        ASSERT_TRUE(ray);
        const LightOfAllOrders found = light.radiance(*ray, pixel);
        const double expected = veil.radiance(*ray, kNm);
        EXPECT_NEAR(found.veil.mean, expected, kStandardErrors * found.veil.standard_error);
        constexpr double kWorthIt = 0.02;
        EXPECT_LT(found.veil.standard_error, kWorthIt * expected);
        // And the floor is the direct light's, with a turn on the way of next to none.
        const double all = tracer.pixels({&pixel, 1}).front();
        EXPECT_NEAR(found.floor.mean / (all - expected), 1.0, 1e-5);
    }
}

TEST(MonteCarlo, IsTheSameToTheBitForASeed) {
    const Rig rig = even_lamp(0.2, 0.3, builtin_phase("petzold"));
    const VeilRay ray{Vector3d(0.4, 0.0, 0.0), Vector3d::UnitZ(), kFar};
    const auto veil = [&](std::uint64_t seed, std::uint64_t stream) {
        return MonteCarlo(rig, kNm, {.paths = 100, .seed = seed}).radiance(ray, stream).veil.mean;
    };
    EXPECT_EQ(veil(1, 2), veil(1, 2));
    EXPECT_NE(veil(1, 2), veil(1, 3));
    EXPECT_NE(veil(1, 2), veil(2, 2));
}

// Halving what is followed changes what is found by less than its error.
TEST(MonteCarlo, DoesNotHangOnTheLeastTurn) {
    Rig rig = scene_rig("habcam-led.toml");
    rig.water.scatterers = {{flat(0.2), builtin_phase("petzold-coast")}};
    const Tracer tracer(rig, {.signals = false, .planes_nm = {kNm}});
    const auto ray = tracer.ray(968.0, 608.0, kNm);
    ASSERT_TRUE(ray);
    const auto sum = [&](double least_rad) {
        return MonteCarlo(rig, kNm, {.paths = 4000, .seed = 3, .least_turn_rad = least_rad})
            .radiance(*ray, 0)
            .sum;
    };
    const Estimate coarse = sum(2.0 * kLeastTurn);
    const Estimate fine = sum(kLeastTurn);
    EXPECT_NEAR(coarse.mean,
                fine.mean,
                kStandardErrors * std::hypot(coarse.standard_error, fine.standard_error));
    constexpr double kWorthIt = 0.01;
    EXPECT_LT(fine.standard_error, kWorthIt * fine.mean);
}

// Paths that lose nothing on their way nor at the floor need not end. They bring what paths do that
// lose next to nothing: a ten thousandth on each mean free path.
TEST(MonteCarlo, EndsInWaterThatAbsorbsNothing) {
    constexpr double kScattering_per_m = 0.1;
    constexpr std::size_t kPaths = 400;
    constexpr double kNextToNothing = 0.02;  // of paths of 200 turns
    const auto light_in = [&](double a) {
        Rig rig = even_lamp(a, kScattering_per_m, henyey_greenstein(0.1));
        rig.sled.altitude_m = 3.0;
        rig.seafloor = {.reflectance = flat(1.0)};
        const VeilRay ray{
            .origin_m = {0.5, 0.0, 0.0}, .direction = Vector3d::UnitZ(), .length_m = 3.0};
        return MonteCarlo(rig, kNm, {.paths = kPaths}).radiance(ray, 0);
    };
    const LightOfAllOrders endless = light_in(1e-157);
    const LightOfAllOrders fading = light_in(1e-5);
    EXPECT_GT(endless.tail, 0.0);
    EXPECT_LT(endless.tail, kNextToNothing * endless.sum.mean);
    EXPECT_NEAR(
        endless.sum.mean,
        fading.sum.mean,
        kNextToNothing * endless.sum.mean +
            kStandardErrors * std::hypot(endless.sum.standard_error, fading.sum.standard_error));
}

TEST(MonteCarlo, IsOfBareFloors) {
    Rig rig = even_lamp(0.1, 0.1, henyey_greenstein(0.5));
    rig.seafloor.phong = 0.5;
    EXPECT_THROW(MonteCarlo(rig, kNm, {}), InputError);
    rig.seafloor.phong = 0.0;
    rig.objects.push_back({.name = "ball", .shape = Sphere{}, .reflectance = flat(0.1)});
    EXPECT_THROW(MonteCarlo(rig, kNm, {}), InputError);
}

}  // namespace aphotic::monte_carlo_test
