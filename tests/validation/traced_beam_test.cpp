// SPDX-License-Identifier: BSD-3-Clause
//
// The reference's beams against closed forms, their flux by a quadrature of the tests' own, and
// against rig/beam, which computes the same by other means.
#include "validation/traced_beam.h"

#include "rig/beam.h"
#include "rig/beam_optics.h"
#include "support/random_beam.h"
#include "support/random_rig.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <boost/math/quadrature/gauss.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

namespace aphotic::traced_beam_test {
namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr double kRounding = 1e-13;

const Vector3d kAxis = Vector3d(0.3, -0.5, 0.8).normalized();

// The sled's forward direction and its right, as the plane across the axis sees them.
struct Sides {
    Vector3d along;
    Vector3d across;
};
Sides sides_of(const Vector3d& axis) {
    const Vector3d along = (Vector3d::UnitX() - axis.x() * axis).normalized();
    return {.along = along, .across = axis.cross(along)};
}

// From along, across and the axis to the sled's frame.
Vector3d in_sled(const Vector3d& axis, const Vector3d& lamp) {
    const Sides sides = sides_of(axis);
    return lamp.x() * sides.along + lamp.y() * sides.across + lamp.z() * axis;
}

Vector3d off_axis(double theta_rad, double phi_rad = 0.0) {
    return in_sled(kAxis,
                   {std::sin(theta_rad) * std::cos(phi_rad),
                    std::sin(theta_rad) * std::sin(phi_rad),
                    std::cos(theta_rad)});
}

double at(const Beam& beam, double theta_rad, double phi_rad = 0.0) {
    return TracedBeam(beam, kAxis).intensity(off_axis(theta_rad, phi_rad));
}

Beam beam_of(const Cone& cone, ConeWeights weights = ConeWeights::Flux) {
    return {.name = "b", .weights = weights, .cones = {cone}};
}

Beam beam_of(BeamPattern pattern, double turn_rad = 0.0) {
    return {.name = "b", .cones = {}, .pattern = std::move(pattern), .turn_rad = turn_rad};
}

Cone lambert() {
    return {.part = "", .half_angle_rad = 0.5 * kPi, .weight = 1.0};
}

std::vector<double> degrees(std::vector<double> angles_deg) {
    for (double& angle : angles_deg) angle *= kDegree;
    return angles_deg;
}

// The same up to V = H = 60 degrees, in one quarter of directions.
BeamTable quarter_table(TableAngles angles) {
    return {.angles = angles,
            .vertical_rad = degrees({0.0, 60.0}),
            .horizontal_rad = degrees({0.0, 60.0}),
            .intensity = {1.0, 1.0, 1.0, 1.0}};
}

// The axis of light from a direction, by its name in the lamp's frame.
const Vector3d kAlong = Vector3d::UnitX();
const Vector3d kAcross = Vector3d::UnitY();

Vector3d random_direction(Dice& dice) {
    const double z = dice.between(-1.0, 1.0);
    const double phi = dice.between(0.0, 2.0 * kPi);
    const double r = std::sqrt(1.0 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

// ---- Cones

TEST(TracedCones, MeetLambertsLaw) {
    const Beam beam = beam_of(lambert());
    EXPECT_NEAR(at(beam, 0.0), 1.0 / kPi, kRounding);
    EXPECT_NEAR(at(beam, 1.0), std::cos(1.0) / kPi, kRounding);
    EXPECT_EQ(at(beam, 1.6), 0.0);
}

// n = ln(1/2) / ln(cos(FWHM/2)), and (n + 1) / (2 pi) on the axis.
TEST(TracedCones, FallToHalfAtHalfTheirFullWidth) {
    for (const double fwhm_deg : {10.0, 60.0, 100.0, 140.0}) {
        Cone cone = lambert();
        cone.exponent = std::log(0.5) / std::log(std::cos(0.5 * fwhm_deg * kDegree));
        const double on_axis = (cone.exponent + 1.0) / (2.0 * kPi);
        EXPECT_NEAR(at(beam_of(cone), 0.0), on_axis, kRounding * on_axis);
        EXPECT_NEAR(
            at(beam_of(cone), 0.5 * fwhm_deg * kDegree), 0.5 * on_axis, kRounding * on_axis);
    }
}

// From the axis to 60 degrees: t = 2 cos - 1, so 1/2 where the cosine is 3/4 and 5/32 where it is
// 5/8. The flux of cos S is 2 pi times the integral of u t^2 (3 - 2 t) over the cosine from 1/2 to
// 1, which is 17/80.
TEST(TracedCones, FallOverASoftEdgeAsPovRaysDo) {
    const Cone cone{.part = "",
                    .half_angle_rad = kPi / 3.0,
                    .weight = 1.0,
                    .exponent = 1.0,
                    .edge_rad = kPi / 3.0};
    const Beam literal = beam_of(cone, ConeWeights::Literal);
    EXPECT_NEAR(at(literal, std::acos(0.75)), 0.5 * 0.75, kRounding);
    EXPECT_NEAR(at(literal, std::acos(0.625)), 5.0 / 32.0 * 0.625, kRounding);
    EXPECT_EQ(at(literal, kPi / 3.0 + 1e-9), 0.0);
    EXPECT_NEAR(at(beam_of(cone), 0.0), 1.0 / (2.0 * kPi * 17.0 / 80.0), kRounding);
}

// ---- Tables

// I = 2 (1 - V / 90 degrees), whose flux is 2 pi (2 - 4/pi).
TEST(TracedTable, OfTypeCHasTheValuesWorkedByHand) {
    const Beam beam = beam_of(BeamTable{.angles = TableAngles::TypeC,
                                        .vertical_rad = degrees({0.0, 90.0}),
                                        .horizontal_rad = {0.0},
                                        .intensity = {2.0, 0.0}});
    const double flux = 4.0 * kPi - 8.0;
    for (const double phi_rad : {0.0, 1.0, -2.0}) {
        EXPECT_NEAR(at(beam, 30.0 * kDegree, phi_rad), 4.0 / 3.0 / flux, kRounding);
    }
    EXPECT_EQ(at(beam, 91.0 * kDegree), 0.0);
}

// Light about H = 90 degrees alone: to port, which is against across; a quarter of a turn from
// along to across takes it to along.
TEST(TracedTable, OfTypeCRunsToPortAndTurnsFromAlongToAcross) {
    const BeamTable table{
        .angles = TableAngles::TypeC,
        .vertical_rad = degrees({0.0, 30.0, 60.0, 180.0}),
        .horizontal_rad = degrees({0.0, 90.0, 180.0, 270.0, 360.0}),
        .intensity = {0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}};
    const auto towards = [](const Vector3d& side) {
        return in_sled(kAxis, side + Vector3d::UnitZ());
    };
    const TracedBeam plain(beam_of(table), kAxis);
    EXPECT_GT(plain.intensity(towards(-kAcross)), 0.0);
    EXPECT_EQ(plain.intensity(towards(kAcross)), 0.0);
    EXPECT_LT(plain.intensity(towards(kAlong)), kRounding);
    const TracedBeam turned(beam_of(table, 0.5 * kPi), kAxis);
    EXPECT_GT(turned.intensity(towards(kAlong)), 0.0);
    EXPECT_EQ(turned.intensity(towards(-kAlong)), 0.0);
    EXPECT_TRUE(plain.shines_backwards());
}

// Light in the plane of H = 0 = 360 degrees, just beside which rounding may put it.
TEST(TracedTable, OfTypeCHasNoSeam) {
    BeamTable table{.angles = TableAngles::TypeC,
                    .vertical_rad = degrees({0.0, 90.0}),
                    .horizontal_rad = degrees({0.0, 180.0, 360.0}),
                    .intensity = {1.0, 1.0, 1.0, 1.0, 1.0, 1.0}};
    table.horizontal_rad.back() = std::nextafter(2.0 * kPi, 0.0);
    const TracedBeam beam(beam_of(table), Vector3d::UnitZ());
    for (const double aside : {-1e-17, 0.0, 1e-17}) {
        EXPECT_NEAR(beam.intensity({0.5, aside, 1.0}), 1.0 / (2.0 * kPi), kRounding);
    }
}

// w = (sin V cos H, sin H, cos V cos H), of the flux (60 degrees) sin(60 degrees).
TEST(TracedTable, OfTypeBHasPlanesThroughTheLineAcross) {
    const TracedBeam beam(beam_of(quarter_table(TableAngles::TypeB)), kAxis);
    const double value = 1.0 / (kPi / 3.0 * std::sin(kPi / 3.0));
    const auto towards = [](double v_deg, double h_deg) {
        const double v = v_deg * kDegree;
        const double h = h_deg * kDegree;
        return in_sled(kAxis, {std::sin(v) * std::cos(h), std::sin(h), std::cos(v) * std::cos(h)});
    };
    EXPECT_NEAR(beam.intensity(towards(59.0, 59.0)), value, kRounding);  // dark for type A
    for (const auto& [v, h] : {std::pair{61.0, 5.0}, {5.0, 61.0}, {-1.0, 5.0}, {5.0, -1.0}}) {
        EXPECT_EQ(beam.intensity(towards(v, h)), 0.0) << v << ", " << h;
    }
    EXPECT_FALSE(beam.shines_backwards());
}

// w = (sin V, cos V sin H, cos V cos H)
TEST(TracedTable, OfTypeAHasPlanesThroughTheLineAlong) {
    const TracedBeam beam(beam_of(quarter_table(TableAngles::TypeA)), kAxis);
    const double value = 1.0 / (kPi / 3.0 * std::sin(kPi / 3.0));
    const auto towards = [](double v_deg, double h_deg) {
        const double v = v_deg * kDegree;
        const double h = h_deg * kDegree;
        return in_sled(kAxis, {std::sin(v), std::cos(v) * std::sin(h), std::cos(v) * std::cos(h)});
    };
    EXPECT_NEAR(beam.intensity(towards(59.0, 59.0)), value, kRounding);  // dark for type B
    for (const auto& [v, h] : {std::pair{61.0, 5.0}, {5.0, 61.0}, {-1.0, 5.0}, {5.0, -1.0}}) {
        EXPECT_EQ(beam.intensity(towards(v, h)), 0.0) << v << ", " << h;
    }
}

// ---- Optics

// In focus all of the lens shines, in all directions of the image.
TEST(TracedOptics, InFocusAreALensThatShinesWithinTheImage) {
    const TracedBeam beam(beam_of(BeamOptics{.along_m = 0.06,
                                             .across_m = 0.03,
                                             .focal_length_m = 0.05,
                                             .distance_m = 0.05,
                                             .aperture_m = 0.04}),
                          kAxis);
    const double on_axis = beam.intensity(kAxis);
    const auto towards = [](double along, double across) {
        return in_sled(kAxis, {along, across, 1.0});
    };
    for (const auto& [along, across] : {std::pair{0.59, 0.29}, {-0.59, 0.0}, {0.2, -0.29}}) {
        EXPECT_NEAR(beam.intensity(towards(along, across)),
                    on_axis / std::sqrt(1.0 + along * along + across * across),
                    kRounding * on_axis);
    }
    EXPECT_EQ(beam.intensity(towards(0.61, 0.0)), 0.0);
    EXPECT_EQ(beam.intensity(towards(0.0, 0.31)), 0.0);
}

// Without power, the lens is a hole of radius R before a rectangle: pi R^2 cos(theta) as long as
// all of it looks at the rectangle.
TEST(TracedOptics, OfALongFocalLengthAreAHole) {
    const TracedBeam beam(beam_of(BeamOptics{.along_m = 0.2,
                                             .across_m = 0.2,
                                             .focal_length_m = 1e9,
                                             .distance_m = 0.1,
                                             .aperture_m = 0.02}),
                          kAxis);
    const double on_axis = beam.intensity(kAxis);
    EXPECT_NEAR(beam.intensity(off_axis(0.6)), on_axis * std::cos(0.6), 1e-9 * on_axis);
    // Half of the hole sees it.
    const double half_rad = std::atan(1.0);
    EXPECT_NEAR(
        beam.intensity(off_axis(half_rad)), 0.5 * on_axis * std::cos(half_rad), 1e-7 * on_axis);
}

// ---- Windows

// T = (1 - R)(1 - R') / (1 - R R') of the faces' 4 % and 0.32 %, and n^2 = 1.7956.
TEST(TracedWindow, BrightensTheAxis) {
    Beam beam = beam_of(lambert());
    beam.window = {.glass_index = 1.5, .water_index = 1.34};
    const double first = 0.04;
    const double second = std::pow(0.16 / 2.84, 2.0);
    const double through = (1.0 - first) * (1.0 - second) / (1.0 - first * second);
    EXPECT_NEAR(at(beam, 0.0), through * 1.34 * 1.34 / kPi, kRounding);
    EXPECT_EQ(at(beam, std::asin(1.0 / 1.34) + 1e-9), 0.0);
    EXPECT_GT(at(beam, std::asin(1.0 / 1.34) - 1e-6), 0.0);
}

TEST(TracedWindow, OfNothingChangesNothing) {
    Beam beam = beam_of(lambert());
    beam.window = {.glass_index = 1.0, .water_index = 1.0};
    EXPECT_NEAR(at(beam, 1.2), std::cos(1.2) / kPi, kRounding);
}

// Of diffuse light, a face of index 1.5 reflects 9.18 % (Judd 1942, table I).
TEST(TracedWindow, ReflectsOfDiffuseLightWhatJuddTabulates) {
    Beam beam = beam_of(lambert());
    beam.window = {.glass_index = 1.5, .water_index = 1.5};
    const TracedBeam traced(beam, kAxis);
    // sin(theta) = (1 - x^2) sin(end): smooth where the light ends.
    const double flux = boost::math::quadrature::gauss<double, 30>::integrate(
        [&](double x) {
            const double sine = (1.0 - x * x) / 1.5;
            const double theta = std::asin(sine);
            return traced.intensity(off_axis(theta)) * 2.0 * kPi * sine * 2.0 * x / 1.5 /
                   std::cos(theta);
        },
        0.0,
        1.0);
    EXPECT_NEAR(flux, 1.0 - 0.0918, 6e-5);
}

// ---- Flux

// Of the cells between cuts, all of which are integrated by Gauss's points.
double integral(const std::vector<double>& cuts, const std::function<double(double)>& f) {
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        sum += boost::math::quadrature::gauss<double, 10>::integrate(f, cuts[i], cuts[i + 1]);
    }
    return sum;
}

constexpr double kFluxError = 1e-6;

TEST(TracedFlux, OfConesIsOne) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        Dice dice(seed);
        for (Cone cone : random_cones(dice)) {
            cone.weight = 1.0;
            const TracedBeam beam(beam_of(cone), kAxis);
            std::vector<double> cuts;
            const double full_rad = cone.half_angle_rad - cone.edge_rad;
            for (int i = 0; i <= 20; ++i) cuts.push_back(full_rad * i / 20.0);
            for (int i = 1; i <= 20 && cone.edge_rad > 0.0; ++i) {
                cuts.push_back(full_rad + cone.edge_rad * i / 20.0);
            }
            const double flux = integral(cuts, [&](double theta) {
                return 2.0 * kPi * std::sin(theta) * beam.intensity(off_axis(theta));
            });
            EXPECT_NEAR(flux, 1.0, kFluxError) << seed;
        }
    }
}

// By the angles' own directions and solid angles, cell by cell.
TEST(TracedFlux, OfTablesIsOne) {
    for (const TableAngles type : {TableAngles::TypeA, TableAngles::TypeB, TableAngles::TypeC}) {
        for (std::uint64_t seed = 1; seed <= 6; ++seed) {
            Dice dice(seed);
            BeamTable table = random_table(dice, type);
            const TracedBeam beam(beam_of(table), kAxis);
            std::vector<double> around = table.horizontal_rad;
            if (around.size() == 1) around = degrees({0.0, 360.0});
            const double flux = integral(table.vertical_rad, [&](double v) {
                return integral(around, [&](double h) {
                    const double sv = std::sin(v);
                    const double cv = std::cos(v);
                    const double sh = std::sin(h);
                    const double ch = std::cos(h);
                    switch (type) {
                        case TableAngles::TypeA:
                            return cv * beam.intensity(in_sled(kAxis, {sv, cv * sh, cv * ch}));
                        case TableAngles::TypeB:
                            return ch * beam.intensity(in_sled(kAxis, {sv * ch, sh, cv * ch}));
                        case TableAngles::TypeC:
                            break;
                    }
                    return sv * beam.intensity(in_sled(kAxis, {sv * ch, -sv * sh, cv}));
                });
            });
            EXPECT_NEAR(flux, 1.0, kFluxError) << static_cast<int>(type) << ", seed " << seed;
        }
    }
}

// By the midpoint rule over slopes, all of which lie within (R |1 - s/f| + half a side) / s. The
// light ends smoothly, so that few steps do.
TEST(TracedFlux, OfBlurredOpticsIsOne) {
    for (const BeamOptics& optics : {BeamOptics{.along_m = 0.0635,
                                    .across_m = 0.0302,
                                    .focal_length_m = 0.065,
                                    .distance_m = 0.03,
                                    .aperture_m = 0.1},
                                     BeamOptics{.along_m = 0.02,
                                     .across_m = 0.05,
                                     .focal_length_m = 0.05,
                                     .distance_m = 0.08,
                                     .aperture_m = 0.03}}) {
        const TracedBeam beam(beam_of(optics), kAxis);
        const double blur_m =
            0.5 * optics.aperture_m * std::abs(1.0 - optics.distance_m / optics.focal_length_m);
        const double along = (blur_m + 0.5 * optics.along_m) / optics.distance_m;
        const double across = (blur_m + 0.5 * optics.across_m) / optics.distance_m;
        constexpr int kSteps = 300;
        double flux = 0.0;
        for (int i = 0; i < kSteps; ++i) {
            for (int j = 0; j < kSteps; ++j) {
                const Vector3d lamp(along * ((2 * i + 1.0) / kSteps - 1.0),
                                    across * ((2 * j + 1.0) / kSteps - 1.0),
                                    1.0);
                flux += beam.intensity(in_sled(kAxis, lamp)) / std::pow(lamp.norm(), 3.0) * 4.0 *
                        along * across / (kSteps * kSteps);
            }
        }
        EXPECT_NEAR(flux, 1.0, kFluxError);
    }
}

TEST(TracedFlux, OfFocusedOpticsIsOne) {
    const BeamOptics optics{.along_m = 0.06,
                            .across_m = 0.03,
                            .focal_length_m = 0.05,
                            .distance_m = 0.05,
                            .aperture_m = 0.04};
    const TracedBeam beam(beam_of(optics), kAxis);
    const double flux = integral({-0.6, 0.0, 0.6}, [&](double along) {
        return integral({-0.3, 0.3}, [&](double across) {
            const Vector3d lamp(along, across, 1.0);
            return beam.intensity(in_sled(kAxis, lamp)) / std::pow(lamp.norm(), 3.0);
        });
    });
    EXPECT_NEAR(flux, 1.0, kFluxError);
}

// ---- Against rig/beam

// Of the largest intensity: the quadratures of optics, and of fluxes.
constexpr double kAgreement = 1e-9;

TEST(TracedBeam, AgreesWithWhatTheRigSays) {
    for (const BeamKind kind : kBeamKinds) {
        for (const std::uint64_t seed : rig_seeds(1, 20)) {
            Dice dice(seed);
            const Beam beam = random_beam_of(kind, dice);
            const Vector3d axis = dice.chance(0.2) ? Vector3d::UnitX() : random_direction(dice);
            const TracedBeam traced(beam, axis);
            const BeamFrame frame = frame_about(axis);
            const double most = most_intensity(beam);
            double worst = 0.0;
            for (int i = 0; i < 2000; ++i) {
                const Vector3d towards = (random_direction(dice) + dice.between(0.0, 4.0) * axis);
                if (traced.is_on_edge({towards, towards}, 1e-9)) continue;
                worst = std::max(
                    worst,
                    std::abs(traced.intensity(towards) - intensity_towards(beam, frame, towards)));
            }
            EXPECT_LT(worst, kAgreement * most)
                << "kind " << static_cast<int>(kind) << ", seed " << seed;
        }
    }
}

// As the quadratures of both meet for the steepest lenses that a rig may have: on the way to a
// step.
constexpr double kSteepAgreement = 1e-4;

TEST(TracedBeam, OfTheSteepestLensesAgrees) {
    const BeamOptics lamp{.along_m = 0.0635,
                          .across_m = 0.0302,
                          .focal_length_m = 0.065,
                          .distance_m = 0.05,
                          .aperture_m = 0.065};
    BeamOptics short_lens = lamp;
    short_lens.focal_length_m = 5e-5;
    BeamOptics near_lens = lamp;
    near_lens.distance_m = 5e-5;
    for (const BeamOptics& optics : {short_lens, near_lens}) {
        const Beam beam = beam_of(optics);
        const double on_axis = optics_intensity(optics, Vector3d::UnitZ()) / optics_flux(optics);
        EXPECT_NEAR(TracedBeam(beam, kAxis).intensity(kAxis) / on_axis, 1.0, kSteepAgreement);
    }
}

// ---- Edges

constexpr double kNear = 1e-6;

bool is_on_edge(const Beam& beam, const Vector3d& towards) {
    return TracedBeam(beam, kAxis).is_on_edge({towards, towards}, kNear);
}

TEST(TracedEdges, AreOfSharpConesAlone) {
    Cone cone{.part = "", .half_angle_rad = 0.5, .weight = 1.0};
    EXPECT_TRUE(is_on_edge(beam_of(cone), off_axis(0.5 + 0.9 * kNear)));
    EXPECT_FALSE(is_on_edge(beam_of(cone), off_axis(0.5 + 1.1 * kNear)));
    cone.edge_rad = 0.1;
    EXPECT_FALSE(is_on_edge(beam_of(cone), off_axis(0.5)));
    EXPECT_FALSE(is_on_edge(beam_of(lambert()), off_axis(0.5 * kPi)));
}

TEST(TracedEdges, AreWhereATableEndsOnAStep) {
    BeamTable table{.angles = TableAngles::TypeC,
                    .vertical_rad = degrees({0.0, 30.0, 60.0}),
                    .horizontal_rad = {0.0},
                    .intensity = {2.0, 1.0, 1.0}};
    EXPECT_TRUE(is_on_edge(beam_of(table), off_axis(60.0 * kDegree)));
    EXPECT_FALSE(is_on_edge(beam_of(table), off_axis(30.0 * kDegree)));
    table.intensity.back() = 0.0;
    EXPECT_FALSE(is_on_edge(beam_of(table), off_axis(60.0 * kDegree)));

    // Of the quarter's four sides, as far as they go.
    const Beam quarter = beam_of(quarter_table(TableAngles::TypeB));
    const auto towards = [](double v_deg, double h_deg) {
        const double v = v_deg * kDegree;
        const double h = h_deg * kDegree;
        return in_sled(kAxis, {std::sin(v) * std::cos(h), std::sin(h), std::cos(v) * std::cos(h)});
    };
    for (const auto& [v, h] : {std::pair{60.0, 20.0}, {20.0, 60.0}, {0.0, 30.0}, {30.0, 0.0}}) {
        EXPECT_TRUE(is_on_edge(quarter, towards(v, h))) << v << ", " << h;
    }
    for (const auto& [v, h] : {std::pair{60.0, 70.0}, {70.0, 60.0}, {0.0, -30.0}, {30.0, 30.0}}) {
        EXPECT_FALSE(is_on_edge(quarter, towards(v, h))) << v << ", " << h;
    }
}

TEST(TracedEdges, AreTheSharpImagesSides) {
    BeamOptics optics{.along_m = 0.06,
                      .across_m = 0.03,
                      .focal_length_m = 0.05,
                      .distance_m = 0.05,
                      .aperture_m = 0.04};
    const Vector3d side = in_sled(kAxis, {0.6, 0.1, 1.0});
    EXPECT_TRUE(is_on_edge(beam_of(optics), side));
    EXPECT_FALSE(is_on_edge(beam_of(optics), in_sled(kAxis, {0.6, 0.4, 1.0})));
    optics.distance_m = 0.049;
    EXPECT_FALSE(is_on_edge(beam_of(optics), side));
}

TEST(TracedEdges, BehindAWindowAreWhereSnellTakesThem) {
    const double n = 1.34;
    Beam beam = beam_of(Cone{.part = "", .half_angle_rad = 1.0, .weight = 1.0});
    beam.window = {.glass_index = 1.5, .water_index = n};
    const double edge_rad = std::asin(std::sin(1.0) / n);
    EXPECT_TRUE(is_on_edge(beam, off_axis(edge_rad + 0.5 * kNear)));
    EXPECT_FALSE(is_on_edge(beam, off_axis(edge_rad + 3.0 * kNear)));
    EXPECT_FALSE(is_on_edge(beam, off_axis(std::asin(1.0 / n))));
    beam.cones = {lambert()};
    EXPECT_TRUE(is_on_edge(beam, off_axis(std::asin(1.0 / n) - 0.5 * kNear)));
    EXPECT_FALSE(is_on_edge(beam, off_axis(std::asin(1.0 / n) - 3.0 * kNear)));
}

// Between two directions of any beam, halved towards the larger difference until nothing is left of
// the way: what is left of the difference is a step.
TEST(TracedEdges, AreAllStepsThereAre) {
    constexpr double kApart = 1e-7;
    constexpr double kStep = 0.1;  // more than any falloff changes over kApart
    int steps = 0;
    for (const BeamKind kind : kBeamKinds) {
        for (const std::uint64_t seed : rig_seeds(1, 20)) {
            Dice dice(seed);
            const Beam beam = random_beam_of(kind, dice);
            const TracedBeam traced(beam, kAxis);
            const double most = most_intensity(beam);
            for (int i = 0; i < 200; ++i) {
                Vector3d a = (random_direction(dice) + 2.0 * kAxis).normalized();
                Vector3d b = random_direction(dice);
                if ((a + b).norm() < 0.1) continue;  // no one way from a to b
                double at_a = traced.intensity(a);
                double at_b = traced.intensity(b);
                while ((a - b).norm() > kApart) {
                    const Vector3d middle = (a + b).normalized();
                    const double at_middle = traced.intensity(middle);
                    const bool is_nearer_a =
                        std::abs(at_a - at_middle) > std::abs(at_b - at_middle);
                    (is_nearer_a ? b : a) = middle;
                    (is_nearer_a ? at_b : at_a) = at_middle;
                }
                if (std::abs(at_a - at_b) < kStep * most) continue;
                ++steps;
                EXPECT_TRUE(traced.is_on_edge({a, b}, 0.0) || traced.is_on_edge({a, b}, kApart))
                    << "kind " << static_cast<int>(kind) << ", seed " << seed;
            }
        }
    }
    EXPECT_GT(steps, 1000);
}

// ---- Steepness

TEST(TracedSteepness, OfSharpConesIsTheLargestExponent) {
    Beam beam = beam_of(lambert());
    beam.cones.push_back({.part = "", .half_angle_rad = 0.4, .weight = 1.0, .exponent = 20.0});
    EXPECT_EQ(TracedBeam(beam, kAxis).steepness(), 20.0);
}

// A table of cos^n, by straight lines over a degree each, is as steep as cos^n is where it has a
// tenth of its light, and no steeper.
TEST(TracedSteepness, OfATableOfCosinesIsTheirExponent) {
    for (const double n : {2.0, 10.0, 40.0}) {
        BeamTable table{.angles = TableAngles::TypeC,
                        .vertical_rad = {},
                        .horizontal_rad = {0.0},
                        .intensity = {}};
        for (int v = 0; v <= 90; ++v) {
            table.vertical_rad.push_back(v * kDegree);
            table.intensity.push_back(std::pow(std::max(0.0, std::cos(v * kDegree)), n));
        }
        const double found = TracedBeam(beam_of(table), kAxis).steepness();
        EXPECT_GT(found, 0.3 * n);
        EXPECT_LT(found, 1.1 * n);
    }
}

TEST(TracedSteepness, GrowsAsEdgesNarrow) {
    double before = 0.0;
    for (const double edge_rad : {0.4, 0.2, 0.1}) {
        const double found = TracedBeam(beam_of(Cone{.part = "",
                                                     .half_angle_rad = 0.5,
                                                     .weight = 1.0,
                                                     .exponent = 1.0,
                                                     .edge_rad = edge_rad}),
                                        kAxis)
                                 .steepness();
        EXPECT_GT(found, 1.3 * before);
        before = found;
    }
}

}  // namespace
}  // namespace aphotic::traced_beam_test
