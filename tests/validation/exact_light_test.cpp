// SPDX-License-Identifier: BSD-3-Clause
//
// The answer itself: against formulas that need no program, and in fifty digits, to tell what long
// double is worth where doubles end.
#include "support/exact_light.h"

#include "base/error.h"
#include "support/closed_form.h"
#include "support/refusal.h"
#include "support/scene_rig.h"
#include "support/veil_rig.h"

#include <gtest/gtest.h>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>

#include <cmath>
#include <numbers>
#include <string>

namespace aphotic::exact_light_test {
namespace {

using Fifty = boost::multiprecision::cpp_bin_float_50;

// Of the wavelengths at which the sensor's response is asked for, which are doubles: 1e-16, and a
// few of these in a sum. An exponent of depth d in long double costs d 5e-20, which is less.
constexpr long double kLongRounding = 1e-15L;
// The same in doubles, which the closed form of the tests uses.
constexpr double kRounding = 1e-13;

// The largest relative difference of long double from fifty digits, over pixels and channels.
long double worst_of_long_double(const Rig& rig, double lambda_nm) {
    const ExactLight<long double> light(rig);
    const ExactLight<Fifty> fifty(rig);
    long double worst = 0.0L;
    const auto compare = [&](long double found, const Fifty& exact) {
        if (exact == 0) {
            EXPECT_EQ(found, 0.0L);
            return;
        }
        const Fifty e = abs((Fifty(found) - exact) / exact);
        worst = std::max(worst, static_cast<long double>(e));
    };
    for (const auto& [column, row] : {std::pair{0.5, 0.5}, std::pair{2.5, 1.5}}) {
        compare(light.radiance(column, row, lambda_nm), fifty.radiance(column, row, lambda_nm));
        const auto found = light.signals(column, row);
        const auto exact = fifty.signals(column, row);
        for (std::size_t c = 0; c < kChannels; ++c) compare(found[c], exact[c]);
    }
    return worst;
}

TEST(ExactLight, OnTheAxisIsTheInverseSquareAndTwoLegsOfWater) {
    Rig rig = habcam(5, 4);
    rig.sled = {.altitude_m = 3.0, .pitch_rad = 0.0, .roll_rad = 0.0};
    rig.strobes.erase(rig.strobes.begin() + 1, rig.strobes.end());
    rig.strobes[0].position_m.setZero();
    rig.strobes[0].axis = Eigen::Vector3d::UnitZ();
    rig.strobes[0].beam.cones = {{.part = "", .half_angle_rad = 0.5, .weight = 0.25}};
    const double K = rig.water.attenuation_per_m(550.0);
    const double axial = 0.25 / (std::numbers::pi * std::sin(0.5) * std::sin(0.5));
    const double expected = rig.strobes[0].spectrum.at(550.0) * axial *
                            rig.seafloor.reflectance.at(550.0) / (std::numbers::pi * 9.0) *
                            std::exp(-6.0 * K);
    const auto found = static_cast<double>(ExactLight<long double>(rig).radiance(2.5, 2.0, 550.0));
    EXPECT_NEAR(found, expected, kRounding * expected);
}

// Everything else at once, against the formula as the tests write it.
TEST(ExactLight, AgreesWithTheClosedFormOffTheAxisAndBehindAPort) {
    Rig rig = habcam(5, 4);
    rig.sled.roll_rad = -0.2;
    rig.seafloor.phong = 0.4;
    rig.strobes[1].beam.cones[0].exponent = 7.5;
    rig.strobes[2].beam.cones[2].exponent = 0.5;
    for (const bool has_port : {false, true}) {
        if (has_port) {
            rig.camera.port = {
                .distance_m = 0.05, .thickness_m = 0.012, .glass = builtin_glass("bk7")};
        }
        const ExactLight<long double> light(rig);
        for (int row = 0; row < rig.camera.height_px; ++row) {
            for (int column = 0; column < rig.camera.width_px; ++column) {
                const double expected =
                    closed_form::radiance(rig, column, row, 480.0, 1, 1).radiance;
                const auto found =
                    static_cast<double>(light.radiance(column + 0.5, row + 0.5, 480.0));
                EXPECT_NEAR(found, expected, kRounding * expected) << column << ", " << row;
            }
        }
    }
}

// With a straight absorption K = a + b (lambda - 500) and all else flat
//   int exp(-K l) dlambda = (exp(-K_1 l) - exp(-K_2 l)) / (b l)
TEST(ExactLight, IntegratesAStraightAbsorptionInClosedForm) {
    const auto flat = [](double value) { return Spectrum("flat", {500.0, 600.0}, {value, value}); };
    Rig rig = habcam(5, 4);
    rig.sled = {.altitude_m = 2.0, .pitch_rad = 0.0, .roll_rad = 0.0};
    rig.strobes.erase(rig.strobes.begin() + 1, rig.strobes.end());
    rig.strobes[0].position_m.setZero();
    rig.strobes[0].axis = Eigen::Vector3d::UnitZ();
    rig.strobes[0].spectrum = flat(1.0);
    rig.seafloor.reflectance = flat(1.0);
    rig.camera.range = {.first_nm = 500.0, .last_nm = 600.0};
    rig.camera.sensor = Sensor({flat(1.0), flat(0.5), flat(0.0)}, ResponseKind::Energy);
    for (const double steep_per_m : {1e-6, 0.1, 40.0}) {
        rig.water.absorption_per_m =
            Spectrum("straight", {500.0, 600.0}, {0.01, 0.01 + steep_per_m});
        const ExactLight<long double> light(rig);
        const long double axial = light.radiance(2.5, 2.0, 500.0) * std::exp(4.0L * 0.01L);
        const long double depth = 4.0L * static_cast<long double>(0.01 + steep_per_m) - 0.04L;
        const long double expected =
            axial * std::exp(-4.0L * 0.01L) * -std::expm1(-depth) / (depth / 100.0L);
        const auto found = light.signals(2.5, 2.0);
        // The two ends of the table stand in doubles.
        EXPECT_NEAR(static_cast<double>(found[0] / expected), 1.0, kRounding) << steep_per_m;
        EXPECT_EQ(found[1], found[0] / 2);
        EXPECT_EQ(found[2], 0.0L);
    }
}

TEST(ExactLight, LongDoubleIsGoodForFifteenDigitsOfHabCam) {
    EXPECT_LT(worst_of_long_double(habcam(5, 4), 550.0), kLongRounding);
}

TEST(ExactLight, LongDoubleIsGoodForFifteenDigitsOfSoftEdges) {
    Rig rig = habcam(5, 4);
    for (Strobe& strobe : rig.strobes) {
        for (Cone& cone : strobe.beam.cones) {
            cone.edge_rad = 0.7 * cone.half_angle_rad;
            cone.exponent = 3.5;
        }
    }
    EXPECT_LT(worst_of_long_double(rig, 550.0), kLongRounding);
}

TEST(ExactLight, LongDoubleHoldsWhereDoublesEnd) {
    Rig rig = habcam(5, 4);
    for (const double K_per_m : {175.0, 1e3}) {  // optical depths of 700 and 4000
        rig.water.uniform_loss_per_m = K_per_m;
        EXPECT_LT(worst_of_long_double(rig, 550.0), kLongRounding) << K_per_m;
    }
}

TEST(ExactLight, LongDoubleHoldsTowardsTheHorizonAndForGrazingLight) {
    Rig rig = habcam(5, 4);
    rig.sled = {.altitude_m = 1.0, .pitch_rad = 89.9 * std::numbers::pi / 180.0, .roll_rad = 0.0};
    rig.strobes.erase(rig.strobes.begin() + 1, rig.strobes.end());
    rig.strobes[0].position_m = {0.0, 1000.0, 0.0};
    rig.strobes[0].axis = {0.0, -1.0, 0.0};
    rig.water.multiple = 0.0;
    EXPECT_LT(worst_of_long_double(rig, 550.0), kLongRounding);
}

// Of a black floor: nothing but the veil along the camera's axis.
Rig in_scattering_water(const Eigen::Vector3d& lamp_m, double half_angle_rad, double b_per_m) {
    Rig rig = habcam(5, 4);
    rig.sled = {.altitude_m = 2.5, .pitch_rad = 0.0, .roll_rad = 0.0};
    rig.seafloor.reflectance = flat(0.0);
    rig.water.absorption_per_m = flat(0.0);
    rig.water.scatterers = {{flat(b_per_m), {.name = "even", .kind = HenyeyGreenstein{.g = 0.0}}}};
    rig.strobes.erase(rig.strobes.begin() + 1, rig.strobes.end());
    rig.strobes[0].position_m = lamp_m;
    rig.strobes[0].axis = Eigen::Vector3d(-lamp_m.x(), -lamp_m.y(), 0.0).normalized();
    rig.strobes[0].spectrum = flat(1.0);
    rig.strobes[0].beam = even_beam(half_angle_rad);
    return rig;
}

double veil_on_the_axis(const Rig& rig) {
    return static_cast<double>(ExactLight<long double>(rig).radiance(2.5, 2.0, 550.0));
}

// b I / (4 pi h) times the angle under which the lamp lights the ray; what is lost is b's own.
TEST(ExactLight, TheVeilOfAnEvenLampIsAnAngle) {
    const double b = 1e-15;
    for (const double h : {0.01, 0.5, 3.0}) {
        for (const double along_m : {-0.2, 0.0, 0.7}) {
            Rig rig = in_scattering_water({h, 0.0, along_m}, 0.5 * std::numbers::pi, b);
            const double begin = std::max(std::atan(-along_m / h), -80.0 * std::numbers::pi / 180);
            const double angle = std::atan((2.5 - along_m) / h) - begin;
            EXPECT_NEAR(
                veil_on_the_axis(rig) / (b * angle / (4.0 * std::numbers::pi * h)), 1.0, kRounding)
                << h << ", " << along_m;
        }
    }
    const double half_angle = 0.3;
    const Rig rig = in_scattering_water({0.7, 0.0, 1.0}, half_angle, b);
    EXPECT_NEAR(veil_on_the_axis(rig) / (b * 2.0 * half_angle / (4.0 * std::numbers::pi * 0.7)),
                1.0,
                kRounding);
}

// Sun, Ramamoorthi, Narasimhan and Nayar (2005): F(u, v) = int_0^v exp(-u tan(xi)) dxi.
TEST(ExactLight, TheVeilInLossyWaterIsSunsFunction) {
    using Kronrod = boost::math::quadrature::gauss_kronrod<double, 61>;
    const auto F = [](double u, double v) {
        return Kronrod::integrate(
            [u](double xi) { return std::exp(-u * std::tan(xi)); }, 0.0, v, 15, 1e-15);
    };
    const double b = 0.3;
    const double loss_per_m = b * 0.5 * (1.0 + std::cos(45.0 * std::numbers::pi / 180.0));
    for (const double h : {0.02, 0.5, 3.0}) {
        const Rig rig = in_scattering_water({0.0, h, 0.1}, 0.5 * std::numbers::pi, b);
        const double from = std::max(std::atan(-0.1 / h), -80.0 * std::numbers::pi / 180.0);
        const double to = std::atan(2.4 / h);
        const double expected = b * std::exp(-loss_per_m * 0.1) / (2.0 * std::numbers::pi * h) *
                                (F(loss_per_m * h, 0.25 * std::numbers::pi + 0.5 * to) -
                                 F(loss_per_m * h, 0.25 * std::numbers::pi + 0.5 * from));
        constexpr double kOfQuadrature = 1e-11;  // of the expected, whose integrand is steep
        EXPECT_NEAR(veil_on_the_axis(rig) / expected, 1.0, kOfQuadrature) << h;
    }
}

// A phase function is a double's, of an angle that is one.
TEST(ExactLight, LongDoubleIsGoodForThirteenDigitsOfTheVeil) {
    constexpr long double kOfPhase = 1e-13L;
    Rig rig = habcam(5, 4);
    rig.camera.range = {.first_nm = 549.0, .last_nm = 551.0};
    const Spectrum b("b", {300.0, 900.0}, {0.4, 0.2});
    rig.water.scatterers = {{b, {.name = "forward", .kind = HenyeyGreenstein{.g = 0.924}}},
                            {b, {.name = "sea", .kind = MolecularScattering{}}}};
    EXPECT_LT(worst_of_long_double(rig, 550.0), kOfPhase);
}

// It would take a dome and a tilted port for a flat one, and a lens for a pinhole.
TEST(ExactLight, RefusesWhatItDoesNotKnow) {
    const auto error_of = [](const Rig& rig) {
        return refusal_of([&] { return ExactLight<long double>(rig); });
    };
    const auto expect_refused = [&](const std::string& what, const auto& change) {
        Rig rig = habcam(5, 4);
        EXPECT_EQ(error_of(rig), kAccepted);
        change(rig);
        EXPECT_TRUE(error_of(rig).starts_with("found " + what + "; allowed in the exact light"))
            << error_of(rig);
    };
    const PortWindow flat{.distance_m = 0.05, .thickness_m = 0.01, .glass = builtin_glass("bk7")};
    Rig behind_a_port = habcam(5, 4);
    behind_a_port.camera.port = flat;
    EXPECT_EQ(error_of(behind_a_port), kAccepted);
    expect_refused("a dome", [&](Rig& rig) {
        rig.camera.port = flat;
        rig.camera.port->dome = Dome{.radius_m = 0.08};
    });
    expect_refused("a tilted port", [&](Rig& rig) {
        rig.camera.port = flat;
        rig.camera.port->normal = Eigen::Vector3d(0.1, 0.0, 1.0).normalized();
    });
    expect_refused("a calibrated lens", [](Rig& rig) { rig.camera.lens = LensModel{}; });
    expect_refused("vignetting", [](Rig& rig) { rig.camera.vignetting = NaturalVignetting{}; });
    expect_refused("an emitter of a size",
                   [](Rig& rig) { rig.strobes[1].emitter = {.across_m = 0.05, .along_m = 0.02}; });
    expect_refused("objects", [](Rig& rig) { rig.scene = "reef.pov"; });
    const Spectrum b("b", {300.0, 900.0}, {0.4, 0.2});
    expect_refused("a beam that is no sum of cones in water that scatters", [&](Rig& rig) {
        rig.water.scatterers = {{b, {.name = "sea", .kind = MolecularScattering{}}}};
        rig.strobes[2].beam.window = BeamWindow{};
    });
}

}  // namespace
}  // namespace aphotic::exact_light_test
