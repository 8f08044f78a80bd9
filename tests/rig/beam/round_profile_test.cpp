// SPDX-License-Identifier: BSD-3-Clause
//
// Profiles of round beams against rig/beam/beam.h's formulas, at angles that no piece was made of.
#include "rig/beam/round_profile.h"

#include "support/random_beam.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace aphotic::round_profile_test {
namespace {

constexpr std::uint64_t kSeed = 42'000;
const BeamFrame kFrame{
    Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()};
// Of the largest I in a piece, and where a piece is not looked at it may be off as much again; a
// cosine's own rounding is 1e-16 of it, which a beam that ends in a root near 90 degrees enlarges.
constexpr double kOff = 1e-8;

Eigen::Vector3d towards(double theta_rad) {
    return {std::sin(theta_rad), 0.0, std::cos(theta_rad)};
}

double at(const RoundProfile& profile, double theta_rad) {
    Lanes cosine;
    cosine.lane.fill(std::cos(theta_rad));
    return profile.at(cosine)[0];
}

double continued(const RoundProfile& profile, double to_rad, double from_rad) {
    Lanes cosine;
    Lanes cosine_from;
    cosine.lane.fill(std::cos(to_rad));
    cosine_from.lane.fill(std::cos(from_rad));
    return profile.continued(cosine, cosine_from)[0];
}

std::vector<Beam> round_beams() {
    std::vector<Beam> beams;
    for (int i = 0; i < 60; ++i) {
        Dice dice(kSeed + static_cast<std::uint64_t>(i));
        Beam beam = random_beam_of(i % 2 == 0 ? BeamKind::Cones : BeamKind::TableC, dice);
        beam.window.reset();
        if (auto* table = std::get_if<BeamTable>(&beam.pattern)) {
            table->horizontal_rad = {0.0};
            table->intensity.resize(table->vertical_rad.size());
        }
        if (i % 3 == 0) beam.window = BeamWindow{.glass_index = 1.49, .water_index = 1.34};
        beams.push_back(beam);
    }
    return beams;
}

TEST(RoundProfile, IsTheBeamAtAnyAngle) {
    for (const Beam& beam : round_beams()) {
        ASSERT_TRUE(is_round(beam));
        const RoundProfile profile(beam);
        const double largest = most_intensity(beam);
        for (double theta_rad = 1e-4; theta_rad < 3.14; theta_rad += 1.7e-3) {
            const double expected = intensity_towards(beam, kFrame, towards(theta_rad));
            EXPECT_NEAR(at(profile, theta_rad), expected, kOff * largest) << theta_rad;
        }
    }
}

// Lanes of different pieces do not mix.
TEST(RoundProfile, IsEachLanesOwn) {
    for (const Beam& beam : round_beams()) {
        const RoundProfile profile(beam);
        for (double first_rad = 0.0; first_rad < 1.5; first_rad += 0.1) {
            const auto theta_rad = [&](std::size_t k) {
                return first_rad + 0.2 * static_cast<double>(k);
            };
            Lanes cosines;
            for (std::size_t k = 0; k < kLanes; ++k) cosines[k] = std::cos(theta_rad(k));
            const Lanes found = profile.at(cosines);
            for (std::size_t k = 0; k < kLanes; ++k) ASSERT_EQ(found[k], at(profile, theta_rad(k)));
        }
    }
}

// A lamp's light may be as dim beside its axis as cos^60: the digits of what there is count.
TEST(RoundProfile, HasTheDigitsOfDimLight) {
    Beam beam{
        .name = "narrow",
        .cones = {
            {.part = "narrow", .half_angle_rad = 90.0 * kDegree, .weight = 1.0, .exponent = 60.0}}};
    const RoundProfile profile(beam);
    for (double theta_deg = 0.5; theta_deg < 60.0; theta_deg += 0.5) {
        const double expected = intensity_towards(beam, kFrame, towards(theta_deg * kDegree));
        EXPECT_NEAR(at(profile, theta_deg * kDegree), expected, kOff * expected) << theta_deg;
    }
}

// A small turn across an edge, in and out.
TEST(RoundProfile, GoesOnAsThoughNoEdgeWereThere) {
    constexpr double kTurn_rad = 1e-3;
    int edges = 0;
    for (const Beam& beam : round_beams()) {
        if (!std::holds_alternative<std::monostate>(beam.pattern)) continue;
        const RoundProfile profile(beam);
        for (const double edge_rad : edges_rad(beam)) {
            for (const double side : {-1.0, 1.0}) {
                const double from_rad = edge_rad - side * kTurn_rad;
                const double to_rad = edge_rad + side * kTurn_rad;
                // Two edges closer than that are not crossed one by one.
                const auto others = edges_rad(beam);
                const bool is_alone = std::ranges::none_of(others, [&](double other_rad) {
                    return other_rad != edge_rad && std::abs(other_rad - edge_rad) < 0.1;
                });
                if (!is_alone || to_rad > 1.5) continue;
                ++edges;
                EXPECT_NEAR(continued(profile, to_rad, from_rad),
                            continued_intensity(beam, kFrame, towards(to_rad), towards(from_rad)),
                            1e-6 * most_intensity(beam))
                    << edge_rad;
            }
        }
    }
    EXPECT_GT(edges, 10);
}

TEST(RoundProfile, IsOfRoundBeamsAlone) {
    Dice dice(kSeed);
    EXPECT_FALSE(is_round(random_beam_of(BeamKind::Optics, dice)));
    EXPECT_FALSE(is_round(random_beam_of(BeamKind::TableA, dice)));
    Beam round{.name = "round",
               .cones = {},
               .pattern = BeamTable{
                   .vertical_rad = {0.0, 1.0}, .horizontal_rad = {0.0}, .intensity = {1.0, 0.0}}};
    EXPECT_TRUE(is_round(round));
}

}  // namespace
}  // namespace aphotic::round_profile_test
