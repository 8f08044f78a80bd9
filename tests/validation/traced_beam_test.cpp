// SPDX-License-Identifier: BSD-3-Clause
//
// The reference's beams against rig/beam, which computes the same by other means, and whose tests
// hold it to closed forms; and their edges and steepness.
#include "validation/traced_beam.h"

#include "rig/beam/beam.h"
#include "rig/beam/beam_optics.h"
#include "support/random_beam.h"
#include "support/random_rig.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
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

Vector3d random_direction(Dice& dice) {
    const double z = dice.between(-1.0, 1.0);
    const double phi = dice.between(0.0, 2.0 * kPi);
    const double r = std::sqrt(1.0 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
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
