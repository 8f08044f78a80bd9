// SPDX-License-Identifier: BSD-3-Clause
//
// The veil against closed forms, and against adaptive quadrature along the ray itself, which knows
// of no angle, foot point or crease.
#include "light/veil.h"

#include "support/random_beam.h"
#include "support/veil_rig.h"

#include <gtest/gtest.h>
#include <boost/math/quadrature/gauss_kronrod.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

namespace aphotic::veil_test {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kDegree_rad = pi / 180.0;
constexpr double kNm = 500.0;
constexpr double kRoundingOfSums = 1e-13;
constexpr double kOfQuadrature = 1e-10;  // what is asked of closed forms
const WaterRay kDown{Vector3d::Zero(), Vector3d::UnitZ()};

PhaseFunction isotropic() {
    return {.name = "isotropic", .kind = HenyeyGreenstein{.g = 0.0}};
}

double sum_of_weights(const Rig& rig, const WaterRay& ray, double length_m) {
    VeilNodes nodes;
    Veil(rig).nodes(0, ray, length_m, nodes);
    return std::accumulate(nodes.weight[0].begin(), nodes.weight[0].end(), 0.0);
}

// The definition, term by term, over t.
double by_definition(const Rig& rig, const WaterRay& ray, double length_m) {
    using Kronrod = boost::math::quadrature::gauss_kronrod<double, 31>;
    const double loss_per_m = rig.water.attenuation_per_m(kNm);
    double sum = 0.0;
    for (const Strobe& strobe : rig.strobes) {
        const BeamFrame frame = frame_about(strobe.axis);
        for (std::size_t i = 0; i < rig.water.scatterers.size(); ++i) {
            const auto light = [&](double t) {
                const Vector3d out = ray.origin_m + t * ray.direction - strobe.position_m;
                const double d = out.norm();
                const double psi = std::acos(std::clamp(-out.dot(ray.direction) / d, -1.0, 1.0));
                if (psi < kVeilCut) return 0.0;
                return rig.water.scatterers[i].phase.at(psi) *
                       intensity_towards(strobe.beam, frame, out) *
                       std::exp(-loss_per_m * (t + d)) / (d * d);
            };
            constexpr int kParts = 64;
            constexpr unsigned kDepth = 12;
            constexpr double kClose = 1e-9;
            for (int part = 0; part < kParts; ++part) {
                sum += strobe.power * strobe.spectrum.at(kNm) * rig.water.scattering_per_m(i, kNm) *
                       Kronrod::integrate(light,
                                          length_m * part / kParts,
                                          length_m * (part + 1) / kParts,
                                          kDepth,
                                          kClose);
            }
        }
    }
    return sum;
}

}  // namespace

TEST(Veil, OfAnEvenLampAndEvenScatteringIsAnAngle) {
    const double h = 0.5;
    for (const double t_0 : {-0.4, 0.0, 0.7}) {
        const Rig rig = one_lamp({h, 0.0, t_0}, -Vector3d::UnitX(), even_beam(), isotropic());
        for (const double length_m : {0.2, 1.0, 2.0, 30.0}) {
            const double angle = std::atan((length_m - t_0) / h) - std::atan(-t_0 / h);
            EXPECT_NEAR(sum_of_weights(rig, kDown, length_m) / (angle / (4.0 * pi * h)),
                        1.0,
                        kRoundingOfSums)
                << t_0 << ", " << length_m;
        }
    }
}

// Sun, Ramamoorthi, Narasimhan and Nayar (2005): F(u, v) = int_0^v exp(-u tan xi) dxi.
TEST(Veil, OfAnEvenLampInLossyWaterIsSunsFunction) {
    using Kronrod = boost::math::quadrature::gauss_kronrod<double, 61>;
    const auto F = [](double u, double v) {
        return Kronrod::integrate(
            [u](double xi) { return std::exp(-u * std::tan(xi)); }, 0.0, v, 15, 1e-14);
    };
    for (const double h : {0.02, 0.5, 3.0}) {
        for (const double t_0 : {-0.3, 0.0, 0.1}) {
            Rig rig = one_lamp({0.0, h, t_0}, -Vector3d::UnitY(), even_beam(), isotropic());
            const double loss_per_m = rig.water.attenuation_per_m(kNm);
            const double length_m = 2.5;
            const double from = std::max(std::atan(-t_0 / h), kVeilCut - 0.5 * pi);
            const double to = std::atan((length_m - t_0) / h);
            const double expected = 0.3 * std::exp(-loss_per_m * t_0) / (4.0 * pi * h) * 2.0 *
                                    (F(loss_per_m * h, 0.25 * pi + 0.5 * to) -
                                     F(loss_per_m * h, 0.25 * pi + 0.5 * from));
            EXPECT_NEAR(Veil(rig).radiance(kDown, length_m, kNm) / expected, 1.0, kOfQuadrature)
                << h << ", " << t_0;
        }
    }
}

TEST(Veil, IsNotOfLightThatIsTurnedByLessThanTheCut) {
    const double h = 0.05;
    const double t_0 = 1.0;
    const Rig rig = one_lamp({h, 0.0, t_0}, -Vector3d::UnitX(), even_beam(), isotropic());
    const double angle = std::atan((3.0 - t_0) / h) - (kVeilCut - 0.5 * pi);
    EXPECT_NEAR(sum_of_weights(rig, kDown, 3.0) / (angle / (4.0 * pi * h)), 1.0, kRoundingOfSums);
    // Up to where the turn is the cut, there is none.
    EXPECT_EQ(sum_of_weights(rig, kDown, t_0 - h / std::tan(kVeilCut) - 1e-9), 0.0);
}

// A cone of one intensity: the angle between its edges, which a search along the ray finds.
TEST(Veil, IsCutAtTheEdgesOfCones) {
    const Vector3d axis(-0.6, 0.1, 1.0);
    const Vector3d lamp_m(0.5, 0.05, 0.0);
    const double gamma = 12.0 * kDegree_rad;
    const Rig rig = one_lamp(lamp_m, axis, even_beam(gamma), isotropic());
    const auto off_edge = [&](double t) {
        return angle_between(t * Vector3d::UnitZ() - lamp_m, axis) - gamma;
    };
    const auto crossing = [&](double out, double in) {
        for (int i = 0; i < 100; ++i) {
            const double t = 0.5 * (out + in);
            (off_edge(t) > 0.0 ? out : in) = t;
        }
        return in;
    };
    const double middle = 0.85;
    ASSERT_LT(off_edge(middle), 0.0);
    const double h = lamp_m.head<2>().norm();
    const double angle =
        std::atan(crossing(5.0, middle) / h) - std::atan(crossing(0.0, middle) / h);
    EXPECT_NEAR(sum_of_weights(rig, kDown, 5.0) / (angle / (4.0 * pi * h)), 1.0, 1e-12);
}

// Lengths times s, losses over s: light falls as 1/s^2.
TEST(Veil, ScalesWithTheWater) {
    constexpr double kScale = 3.0;
    const Rig rig = one_lamp({0.4, 0.2, -0.1},
                             {-0.3, 0.0, 1.0},
                             even_beam(0.6),
                             {.name = "hg", .kind = HenyeyGreenstein{.g = 0.9}});
    Rig larger = rig;
    larger.strobes[0].position_m *= kScale;
    larger.water.multiple /= kScale;
    const double expected = Veil(rig).radiance(kDown, 2.0, kNm) / (kScale * kScale);
    ASSERT_GT(expected, 0.0);
    EXPECT_NEAR(
        Veil(larger).radiance(kDown, 2.0 * kScale, kNm) / expected, 1.0, 10.0 * kRoundingOfSums);
}

TEST(Veil, EndsAtTheFloor) {
    const Vector3d lamp_m(0.5, 0.0, 0.2);
    const Rig rig = one_lamp(lamp_m, {-0.3, 0.0, 1.0}, even_beam(1.2), isotropic());
    VeilNodes nodes;
    Veil(rig).nodes(0, kDown, 2.0, nodes);
    ASSERT_FALSE(nodes.path_m.empty());
    const double longest_m = 2.0 + (Vector3d(0.0, 0.0, 2.0) - lamp_m).norm();
    EXPECT_LT(std::ranges::max(nodes.path_m), longest_m);
    EXPECT_GE(std::ranges::min(nodes.path_m), lamp_m.norm());
    EXPECT_EQ(Veil(rig).radiance(kDown, 0.0, kNm), 0.0);
    EXPECT_LT(Veil(rig).radiance(kDown, 2.0, kNm), Veil(rig).radiance(kDown, 2.1, kNm));
}

TEST(Veil, HasAnEndWithoutAFloor) {
    const Rig rig = one_lamp({0.5, 0.0, 0.0}, -Vector3d::UnitX(), even_beam(), isotropic());
    const double far = Veil(rig).radiance(kDown, 1e3, kNm);
    const double endless = Veil(rig).radiance(kDown, std::numeric_limits<double>::infinity(), kNm);
    EXPECT_NEAR(endless / far, 1.0, kOfQuadrature);
}

TEST(Veil, IsFiniteWithTheLampOnTheRayAndBehindTheCamera) {
    for (const double t_0 : {-0.5, 0.0, 0.5}) {
        const Rig rig = one_lamp({0.0, 0.0, t_0}, Vector3d::UnitZ(), even_beam(1.0), isotropic());
        EXPECT_TRUE(std::isfinite(Veil(rig).radiance(kDown, 2.0, kNm)));
    }
    // A micrometre aside is as good as on the ray, where the lamp is behind the camera: there
    // p I b / d^2 is integrated, d = t + 0.5.
    const Rig rig = one_lamp({0.0, 0.0, -0.5}, Vector3d::UnitZ(), even_beam(1.0), isotropic());
    constexpr double kMicrometre = 1e-5;  // relative to what it is beside
    EXPECT_NEAR(sum_of_weights(rig, kDown, 2.0), (1.0 / 0.5 - 1.0 / 2.5) / (4.0 * pi), kMicrometre);
}

// Every beam there is, through windows too, with every phase function.
TEST(Veil, IsTheIntegralAlongTheRay) {
    // Adaptive quadrature's own, at steps that it is not told of; and close to the last direction
    // that a window lets out, where tables in air have an infinite slope.
    constexpr double kOfEdges = 1e-5;
    constexpr double kOfWindows = 1e-4;
    Dice dice(11);
    std::vector<double> angles{0.0};
    std::vector<double> values{50.0};
    for (double degrees = 1.0; degrees < 180.0; degrees *= 1.4) {
        angles.push_back(degrees * kDegree_rad);
        values.push_back(std::pow(degrees, -1.5) * dice.between(0.7, 1.0) + 0.001);
    }
    angles.push_back(pi);
    values.push_back(0.003);
    const std::vector<PhaseFunction> phases{{.name = "hg", .kind = HenyeyGreenstein{.g = 0.924}},
                                            fournier_forand(0.0183),
                                            {.name = "sea", .kind = MolecularScattering{}},
                                            phase_table("table", angles, values)};
    int lit = 0;
    for (int k = 0; k < 60; ++k) {
        Rig rig = one_lamp(
            {dice.between(-0.6, 0.6), dice.between(-0.6, 0.6), dice.between(-0.3, 0.3)},
            {dice.between(-0.6, 0.6), dice.between(-0.6, 0.6), 1.0},
            random_beam_of(kBeamKinds[static_cast<std::size_t>(k) % kBeamKinds.size()], dice),
            phases[static_cast<std::size_t>(k) % phases.size()]);
        const WaterRay ray{
            {0.01, 0.02, 0.05},
            Vector3d(dice.between(-0.4, 0.4), dice.between(-0.4, 0.4), 1.0).normalized()};
        const double found = Veil(rig).radiance(ray, 2.5, kNm);
        const double expected = by_definition(rig, ray, 2.5);
        constexpr double kDark = 1e-9;  // cos^60 close to its end
        if (expected < kDark) {
            EXPECT_LT(found, kDark) << k;
            continue;
        }
        ++lit;
        const bool has_window = rig.strobes[0].beam.window.has_value();
        EXPECT_NEAR(found / expected, 1.0, has_window ? kOfWindows : kOfEdges)
            << k << ": " << expected;
        const double finer = Veil(rig, 2 * kVeilPoints).radiance(ray, 2.5, kNm);
        constexpr double kConverged = 1e-6;
        EXPECT_NEAR(found / finer, 1.0, has_window ? kOfWindows : kConverged) << k;
    }
    EXPECT_GT(lit, 30);
}

// A beam that is far narrower than a tabulated phase function's steps.
TEST(Veil, OfASteepBeamBetweenKinks) {
    constexpr double kOfDefinition = 1e-8;  // adaptive quadrature across kinks
    std::vector<double> angles;
    std::vector<double> values;
    for (int degrees = 0; degrees <= 180; degrees += 5) {
        angles.push_back(degrees * kDegree_rad);
        values.push_back(1.0 / (1.0 + 0.1 * degrees));
    }
    Beam steep = even_beam();
    steep.cones[0].exponent = 3000.0;
    for (const double tilt : {-0.1, 0.0, 0.2, 0.43}) {
        const Rig rig = one_lamp(
            {0.5, 0.0, 0.0}, {-1.0, 0.0, 1.0 + tilt}, steep, phase_table("table", angles, values));
        EXPECT_NEAR(Veil(rig).radiance(kDown, 2.0, kNm) / by_definition(rig, kDown, 2.0),
                    1.0,
                    kOfDefinition)
            << tilt;
    }
}

// A round table in half degrees, with so few points that it is taken as a few cubics; and where it
// has steps, too.
TEST(Veil, OfATableForMapsIsThatOfTheTable) {
    constexpr double kOfBeam = 0.2 * kVeilBeamOff;  // which it is off by here and there, both ways
    BeamTable table;
    table.horizontal_rad = {0.0};
    for (int i = 0; i <= 120; ++i) {
        table.vertical_rad.push_back(0.5 * i * kDegree_rad);
        table.intensity.push_back(std::pow(std::cos(table.vertical_rad.back()), 8.0) +
                                  (i < 30 ? 0.5 : 0.2));
    }
    Beam beam = even_beam();
    beam.cones.clear();
    beam.pattern = table;
    for (const double tilt : {-0.3, 0.0, 0.2, 0.6}) {
        Rig rig = one_lamp({0.5, 0.1, 0.0}, {-1.0 + tilt, 0.2, 1.5}, beam, fournier_forand(0.0183));
        const double expected = by_definition(rig, kDown, 2.0);
        EXPECT_NEAR(Veil(rig, kVeilMapPoints).radiance(kDown, 2.0, kNm) / expected, 1.0, kOfBeam)
            << tilt;
        VeilNodes few;
        VeilNodes all;
        Veil(rig, kVeilMapPoints).nodes(0, kDown, 2.0, few);
        Veil(rig).nodes(0, kDown, 2.0, all);
        EXPECT_LT(8 * few.path_m.size(), all.path_m.size());
    }
}

TEST(Veil, StatesItsError) {
    Rig rig = habcam();
    EXPECT_EQ(veil_error(rig), 0.0);
    rig.water.scatterers = {{flat(0.22), fournier_forand(0.0183)}};
    EXPECT_LT(veil_error(rig), 1e-9);
    EXPECT_GT(veil_error(rig, 2), 10.0 * veil_error(rig, 4));
}

}  // namespace aphotic::veil_test
