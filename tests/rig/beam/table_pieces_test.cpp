// SPDX-License-Identifier: BSD-3-Clause
#include "rig/beam/table_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace aphotic::table_pieces_test {
namespace {

constexpr double kDegree_rad = std::numbers::pi / 180.0;
constexpr double kRounding = 1e-12;

// A value each half degree, from the axis to 80 degrees.
template <typename F>
BeamTable in_half_degrees(const F& intensity) {
    BeamTable table;
    table.horizontal_rad = {0.0};
    for (int i = 0; i <= 160; ++i) {
        table.vertical_rad.push_back(0.5 * i * kDegree_rad);
        table.intensity.push_back(intensity(table.vertical_rad.back()));
    }
    return table;
}

double lambert_and_a_beam(double V) {
    return 2.0 * std::pow(std::cos(V), 8.0) + std::cos(V);
}

// The most that pieces are off the table, a straight line from node to node.
double most_off(const std::vector<TablePiece>& pieces, const BeamTable& table) {
    double most = 0.0;
    for (const TablePiece& piece : pieces) {
        for (const double share : {0.01, 0.2, 0.5, 0.77, 0.99}) {
            const double V = piece.first_rad + share * (piece.last_rad - piece.first_rad);
            const auto above = std::ranges::upper_bound(table.vertical_rad, V);
            const auto k = static_cast<std::size_t>(above - table.vertical_rad.begin());
            const double along = (V - table.vertical_rad[k - 1]) / (*above - *(above - 1));
            const double line = (1.0 - along) * table.intensity[k - 1] + along * table.intensity[k];
            most = std::max(most, std::abs(piece.at(V) - line));
        }
    }
    return most;
}

TEST(TablePieces, AreTheTableItselfWhereTheyMayNotBeOff) {
    const BeamTable table = in_half_degrees(lambert_and_a_beam);
    const std::vector<TablePiece> pieces = pieces_of(table, 0.0);
    EXPECT_EQ(pieces.size(), table.vertical_rad.size() - 1);
    EXPECT_LT(most_off(pieces, table), kRounding);
}

TEST(TablePieces, AreFewOfASmoothBeam) {
    constexpr double kOff = 1e-4;
    const BeamTable table = in_half_degrees(lambert_and_a_beam);
    const std::vector<TablePiece> pieces = pieces_of(table, kOff);
    EXPECT_LT(pieces.size(), 8U);
    EXPECT_EQ(pieces.front().first_rad, table.vertical_rad.front());
    EXPECT_EQ(pieces.back().last_rad, table.vertical_rad.back());
    for (std::size_t k = 1; k < pieces.size(); ++k)
        EXPECT_EQ(pieces[k].first_rad, pieces[k - 1].last_rad);
    // Between the places that are looked at a cubic hardly leaves a line.
    constexpr double kBetween = 1.1;
    const double most = most_off(pieces, table);
    EXPECT_LT(most, kBetween * kOff * largest_intensity(table));
    EXPECT_GT(most, 0.0);
}

TEST(TablePieces, EndWhereABeamHasAKink) {
    const BeamTable table =
        in_half_degrees([](double V) { return std::clamp(40.0 - V / kDegree_rad, 0.0, 20.0); });
    const std::vector<TablePiece> pieces = pieces_of(table, 1e-4);
    ASSERT_EQ(pieces.size(), 3U);
    EXPECT_NEAR(pieces[0].last_rad, 20.0 * kDegree_rad, kRounding);
    EXPECT_NEAR(pieces[1].last_rad, 40.0 * kDegree_rad, kRounding);
}

}  // namespace
}  // namespace aphotic::table_pieces_test
