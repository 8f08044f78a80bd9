// SPDX-License-Identifier: BSD-3-Clause
//
// Random tables by their cells against rig/beam/beam_table.h's own formula.
#include "rig/beam/table_cells.h"

#include "support/random_beam.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace aphotic::table_cells_test {
namespace {

using Eigen::Vector3d;

// Of I, wherever it exceeds so much of the peak: no random direction comes as near to where a cell
// falls to 0 as it takes for the angles' rounding to count.
constexpr double kOff = 1e-6;
constexpr double kDimmest = 1e-8;

double by_cells(const TableCells& cells, const Vector3d& w) {
    LaneVector lanes;
    Lanes length;
    for (std::size_t i = 0; i < 3; ++i) lanes[i].lane.fill(w(static_cast<Eigen::Index>(i)));
    length.lane.fill(w.norm());
    return cells.at(lanes, length)[0];
}

Vector3d random_direction(Dice& dice) {
    const double z = dice.between(-1.0, 1.0);
    const double turn_rad = dice.between(0.0, 2.0 * std::numbers::pi);
    const double sine = std::sqrt(1.0 - z * z);
    return dice.over_octaves(0.01, 100.0) *
           Vector3d(sine * std::cos(turn_rad), sine * std::sin(turn_rad), z);
}

BeamTable random_table(TableAngles angles, Dice& dice) {
    const auto nodes = [&](double first, double last) {
        std::vector<double> made{first};
        const int steps = dice.whole(1, 40);
        for (int k = 1; k < steps; ++k)
            made.push_back(first + (last - first) * (k + dice.between(-0.4, 0.4)) / steps);
        made.push_back(last);
        return made;
    };
    const bool is_c = angles == TableAngles::TypeC;
    const double quarter = 0.5 * std::numbers::pi;
    BeamTable table{.angles = angles, .vertical_rad = {}, .horizontal_rad = {}, .intensity = {}};
    table.vertical_rad = is_c ? nodes(dice.chance(0.5) ? 0.0 : 0.2, dice.between(0.3, 3.1))
                              : nodes(dice.between(-quarter, -0.1), dice.between(0.1, quarter));
    table.horizontal_rad = is_c ? nodes(0.0, 2.0 * std::numbers::pi)
                                : nodes(dice.between(-quarter, -0.1), dice.between(0.1, quarter));
    const std::size_t rows = table.vertical_rad.size();
    for (std::size_t k = 0; k < rows * table.horizontal_rad.size(); ++k)
        table.intensity.push_back(dice.chance(0.2) ? 0.0 : dice.over_octaves(1e-6, 1.0));
    if (is_c)
        std::copy_n(table.intensity.begin(),
                    rows,
                    table.intensity.end() - static_cast<std::ptrdiff_t>(rows));
    return table;
}

TEST(TableCells, AreTheTableInAnyDirection) {
    int lit = 0;
    for (const TableAngles angles : {TableAngles::TypeA, TableAngles::TypeB, TableAngles::TypeC}) {
        for (std::uint64_t seed = 1; seed <= 60; ++seed) {
            Dice dice(seed);
            const BeamTable table = random_table(angles, dice);
            const TableCells cells(table);
            const double peak = largest_intensity(table);
            for (int k = 0; k < 2000; ++k) {
                const Vector3d w = random_direction(dice);
                const double expected = table_intensity(table, w);
                const double found = by_cells(cells, w);
                if (expected <= kDimmest * peak) {
                    EXPECT_NEAR(found, expected, kDimmest * peak);
                    continue;
                }
                ++lit;
                EXPECT_NEAR(found, expected, kOff * expected) << "seed " << seed;
            }
        }
    }
    EXPECT_GT(lit, 50'000);
}

// Axes, poles and seams, where an angle is 0, a quarter turn or more in no fraction of rounding.
TEST(TableCells, AreTheTableAlongItsAxes) {
    for (const TableAngles angles : {TableAngles::TypeA, TableAngles::TypeB, TableAngles::TypeC}) {
        const bool is_c = angles == TableAngles::TypeC;
        const double quarter = 0.5 * std::numbers::pi;
        const std::vector<double> whole =
            is_c ? std::vector{0.0, quarter, 2.0 * quarter} : std::vector{-quarter, 0.0, quarter};
        const std::vector<double> turn =
            is_c ? std::vector{0.0, quarter, 2.0 * quarter, 3.0 * quarter, 4.0 * quarter} : whole;
        BeamTable table{
            .angles = angles, .vertical_rad = whole, .horizontal_rad = turn, .intensity = {}};
        for (std::size_t k = 0; k < whole.size() * turn.size(); ++k)
            table.intensity.push_back(1.0 + static_cast<double>(k % (is_c ? 12 : 100)));
        const TableCells cells(table);
        for (const double x : {-1.0, 0.0, 1.0}) {
            for (const double y : {-1.0, 0.0, 1.0}) {
                for (const double z : {-1.0, 0.0, 1.0}) {
                    const Vector3d w(x, y, z);
                    if (w.isZero()) continue;
                    EXPECT_NEAR(by_cells(cells, w), table_intensity(table, w), kOff)
                        << w.transpose();
                }
            }
        }
    }
}

// A table that is V or H itself, at angles that std::atan2 has.
TEST(TableCells, HaveTheAnglesOfADirection) {
    Dice dice(7);
    for (const TableAngles angles : {TableAngles::TypeA, TableAngles::TypeB, TableAngles::TypeC}) {
        const bool is_c = angles == TableAngles::TypeC;
        const double first = is_c ? 0.0 : -std::numbers::pi;
        const double last = is_c ? 2.0 * std::numbers::pi : std::numbers::pi;
        BeamTable table{.angles = angles,
                        .vertical_rad = {first, last},
                        .horizontal_rad = {first, last},
                        .intensity = {first, last, first, last}};
        const TableCells of_vertical(table);
        table.intensity = {first, first, last, last};
        const TableCells of_horizontal(table);
        for (int k = 0; k < 20'000; ++k) {
            const Vector3d w = random_direction(dice);
            const GoniometerAngles at = angles_of(angles, w);
            // Twice, for reading the angle off the cell rounds as much again.
            EXPECT_NEAR(by_cells(of_vertical, w), at.vertical_rad, 2.0 * kCellAngle_rad);
            EXPECT_NEAR(by_cells(of_horizontal, w), at.horizontal_rad, 2.0 * kCellAngle_rad);
        }
    }
}

}  // namespace
}  // namespace aphotic::table_cells_test
