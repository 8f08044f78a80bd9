// SPDX-License-Identifier: BSD-3-Clause
#include "rig/beam/beam_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace aphotic::beam_table_test {
namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;
constexpr double kRounding = 1e-12;

constexpr TableAngles kA = TableAngles::TypeA;
constexpr TableAngles kB = TableAngles::TypeB;
constexpr TableAngles kC = TableAngles::TypeC;

const Vector3d kAlong = Vector3d::UnitX();
const Vector3d kAcross = Vector3d::UnitY();
const Vector3d kAxis = Vector3d::UnitZ();

std::vector<double> even(double from_deg, double to_deg, int steps) {
    std::vector<double> angles;
    for (int i = 0; i <= steps; ++i)
        angles.push_back((from_deg + (to_deg - from_deg) * i / steps) * kDegree);
    return angles;
}

// f(V, H) at the nodes.
template <typename Function>
BeamTable table_of(TableAngles type,
                   std::vector<double> vertical_rad,
                   std::vector<double> horizontal_rad,
                   Function f) {
    BeamTable table{.angles = type,
                    .vertical_rad = vertical_rad,
                    .horizontal_rad = horizontal_rad,
                    .intensity = {}};
    for (const double H : horizontal_rad)
        for (const double V : vertical_rad) table.intensity.push_back(f(V, H));
    return table;
}

// Random values over uneven angles; the planes at both ends of the turn are the same.
BeamTable random_table(TableAngles type, std::mt19937& random) {
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const auto angles = [&](double from, double to, int steps) {
        std::vector<double> nodes{from};
        for (int i = 1; i < steps; ++i)
            nodes.push_back(from + (to - from) * (i + 0.8 * unit(random)) / steps);
        nodes.push_back(to);
        return nodes;
    };
    const bool is_c = type == kC;
    const auto vertical = is_c ? angles(0.0, 1.9, 7) : angles(-1.1, 0.9, 6);
    const auto horizontal = is_c ? angles(0.0, 2.0 * kPi, 9) : angles(-0.7, 1.3, 5);
    BeamTable table = table_of(type, vertical, horizontal, [&](double, double) {
        return unit(random) < 0.3 ? 0.0 : unit(random);
    });
    if (is_c)
        std::copy_n(table.intensity.begin(),
                    vertical.size(),
                    table.intensity.end() - std::ptrdiff_t(vertical.size()));
    return table;
}

Vector3d random_direction(std::mt19937& random) {
    std::normal_distribution<double> normal;
    return {normal(random), normal(random), normal(random)};
}

// Solid angle for each unit of V and H: how far the direction moves with each, by differences.
double solid_angle_rate(TableAngles type, double V, double H) {
    constexpr double kStep = 1e-4;
    const auto moved = [&](double dV, double dH) {
        const Vector3d there = direction_at(type, {V + dV, H + dH});
        const Vector3d back = direction_at(type, {V - dV, H - dH});
        return Vector3d((there - back) / (2.0 * kStep));
    };
    return moved(kStep, 0.0).cross(moved(0.0, kStep)).norm();
}

// Gauss-Legendre with four points in each angle of each cell.
double flux_by_quadrature(const BeamTable& table) {
    constexpr std::array kPoints{
        -0.8611363115940526, -0.3399810435848563, 0.3399810435848563, 0.8611363115940526};
    constexpr std::array kWeights{
        0.3478548451374538, 0.6521451548625461, 0.6521451548625461, 0.3478548451374538};
    double sum = 0.0;
    for (std::size_t v = 1; v < table.vertical_rad.size(); ++v) {
        for (std::size_t h = 1; h < table.horizontal_rad.size(); ++h) {
            const double half_v = 0.5 * (table.vertical_rad[v] - table.vertical_rad[v - 1]);
            const double half_h = 0.5 * (table.horizontal_rad[h] - table.horizontal_rad[h - 1]);
            for (std::size_t i = 0; i < 16; ++i) {
                const double V = table.vertical_rad[v] - half_v + half_v * kPoints[i / 4];
                const double H = table.horizontal_rad[h] - half_h + half_h * kPoints[i % 4];
                sum += kWeights[i / 4] * kWeights[i % 4] * half_v * half_h *
                       solid_angle_rate(table.angles, V, H) *
                       table_intensity(table, direction_at(table.angles, {V, H}));
            }
        }
    }
    return sum;
}

// LM-63-2002, section 3: V = 90, H = 0 of B and C and, for A, V = 0, H = 0 with V = -90 straight
// down, are "photometric horizontal" and "photometric zero"; H runs counterclockwise for C.
TEST(GoniometerAngles, AreThoseOfTheStandard) {
    const auto at = [](TableAngles type, double V_deg, double H_deg) {
        return direction_at(type,
                            {.vertical_rad = V_deg * kDegree, .horizontal_rad = H_deg * kDegree});
    };
    const auto near = [](const Vector3d& a, const Vector3d& b) {
        return (a - b).norm() < kRounding;
    };
    for (const TableAngles type : {kA, kB, kC}) EXPECT_TRUE(near(at(type, 0.0, 0.0), kAxis));
    EXPECT_TRUE(near(at(kC, 90.0, 0.0), kAlong));
    EXPECT_TRUE(near(at(kC, 90.0, 90.0), -kAcross)) << "counterclockwise from above is to port";
    EXPECT_TRUE(near(at(kC, 180.0, 33.0), -kAxis));
    for (const TableAngles type : {kA, kB}) {
        EXPECT_TRUE(near(at(type, 90.0, 0.0), kAlong));
        EXPECT_TRUE(near(at(type, 0.0, 90.0), kAcross));
    }
    // Planes of one H share the line along (A), planes of one V the line across (B).
    EXPECT_TRUE(near(at(kA, 90.0, 50.0), kAlong));
    EXPECT_TRUE(near(at(kB, 50.0, 90.0), kAcross));
    // 45 and 45 degrees: A turns (0, 1, 1)/sqrt 2 up, B turns (1, 0, 1)/sqrt 2 aside.
    const double half = 0.5;
    const double root = std::sqrt(0.5);
    EXPECT_TRUE(near(at(kA, 45.0, 45.0), {root, half, half}));
    EXPECT_TRUE(near(at(kB, 45.0, 45.0), {half, root, half}));
    EXPECT_TRUE(near(at(kC, 45.0, 45.0), {half, -half, root}));
}

TEST(GoniometerAngles, GoThereAndBack) {
    std::mt19937 random(7);
    for (int i = 0; i < 1000; ++i) {
        const Vector3d direction = random_direction(random);
        for (const TableAngles type : {kA, kB, kC}) {
            const Vector3d back = direction_at(type, angles_of(type, direction));
            EXPECT_NEAR((back - direction.normalized()).norm(), 0.0, kRounding);
        }
    }
}

TEST(TableIntensity, IsBilinearInTheFilesAngles) {
    // 1 + 2 V + 3 H + 4 V H, which bilinear interpolation has exactly.
    const auto f = [](double V, double H) { return 10.0 + 2.0 * V + 3.0 * H + 4.0 * V * H; };
    for (const TableAngles type : {kA, kB}) {
        const BeamTable table = table_of(type, even(-60.0, 50.0, 7), even(-80.0, 70.0, 4), f);
        for (const double V : {-1.0, -0.3, 0.0, 0.7})
            for (const double H : {-1.2, -0.1, 0.0, 1.1})
                EXPECT_NEAR(
                    table_intensity(table, 3.0 * direction_at(type, {V, H})), f(V, H), 1e-11);
    }
    const auto g = [](double V, double H) { return 1.0 + V + V * std::abs(H - kPi); };
    const BeamTable table = table_of(kC, even(0.0, 120.0, 12), even(0.0, 360.0, 8), g);
    for (const double V : {0.1, 0.7, 2.0})
        for (const double H : {0.0, 0.4, 3.0, 4.5, 6.2})
            EXPECT_NEAR(table_intensity(table, direction_at(kC, {V, H})), g(V, H), kRounding);
}

TEST(TableIntensity, IsZeroBeyondTheTable) {
    const auto one = [](double, double) { return 1.0; };
    const BeamTable c = table_of(kC, even(0.0, 60.0, 6), {0.0}, one);
    EXPECT_EQ(table_intensity(c, direction_at(kC, {59.9 * kDegree, 2.0})), 1.0);
    EXPECT_EQ(table_intensity(c, direction_at(kC, {60.1 * kDegree, 2.0})), 0.0);
    EXPECT_EQ(table_intensity(c, -kAxis), 0.0);
    const BeamTable ring = table_of(kC, even(20.0, 60.0, 6), {0.0}, one);
    EXPECT_EQ(table_intensity(ring, kAxis), 0.0);
    for (const TableAngles type : {kA, kB}) {
        const BeamTable b = table_of(type, even(-20.0, 30.0, 5), even(-40.0, 50.0, 3), one);
        const auto at = [&](double V_deg, double H_deg) {
            return table_intensity(b, direction_at(type, {V_deg * kDegree, H_deg * kDegree}));
        };
        EXPECT_EQ(at(29.0, 49.0), 1.0);
        EXPECT_EQ(at(-19.0, -39.0), 1.0);
        EXPECT_EQ(at(31.0, 0.0), 0.0);
        EXPECT_EQ(at(-21.0, 0.0), 0.0);
        EXPECT_EQ(at(0.0, 51.0), 0.0);
        EXPECT_EQ(at(0.0, -41.0), 0.0);
        EXPECT_EQ(table_intensity(b, -kAxis), 0.0);
    }
}

// Read as the other type, a table is another beam: at 45 degrees of both angles, A's direction has
// V = 54.7 degrees in B's angles.
TEST(TableIntensity, TellsTypeAFromTypeB) {
    const auto f = [](double V, double) { return 2.0 + V; };
    BeamTable table = table_of(kA, even(-90.0, 90.0, 18), even(-90.0, 90.0, 18), f);
    const Vector3d direction = direction_at(kA, {45.0 * kDegree, 45.0 * kDegree});
    EXPECT_NEAR(table_intensity(table, direction), 2.0 + 0.25 * kPi, kRounding);
    table.angles = kB;
    EXPECT_NEAR(table_intensity(table, direction), 2.0 + std::atan(std::sqrt(2.0)), kRounding);
}

// 1 over the sphere has 4 pi; over a cone, 2 pi (1 - cos); over V and H from -a to a of A and B,
// 4 a sin a. Linear in theta from 1 on the axis to 0 at g: 2 pi (1 - sin g / g).
TEST(TableFlux, MeetsClosedForms) {
    const auto one = [](double, double) { return 1.0; };
    EXPECT_NEAR(table_flux(table_of(kC, even(0.0, 180.0, 18), {0.0}, one)), 4.0 * kPi, kRounding);
    EXPECT_NEAR(table_flux(table_of(kC, even(0.0, 180.0, 3), even(0.0, 360.0, 5), one)),
                4.0 * kPi,
                kRounding);
    EXPECT_NEAR(table_flux(table_of(kC, even(0.0, 60.0, 4), {0.0}, one)), kPi, kRounding);
    for (const TableAngles type : {kA, kB}) {
        EXPECT_NEAR(table_flux(table_of(type, even(-90.0, 90.0, 9), even(-90.0, 90.0, 7), one)),
                    2.0 * kPi,
                    kRounding);
        const double a = 40.0 * kDegree;
        EXPECT_NEAR(table_flux(table_of(type, even(-40.0, 40.0, 3), even(-40.0, 40.0, 8), one)),
                    4.0 * a * std::sin(a),
                    kRounding);
    }
    const double g = 50.0 * kDegree;
    const auto fall = [g](double V, double) { return 1.0 - V / g; };
    for (const int steps : {1, 5, 100})
        EXPECT_NEAR(table_flux(table_of(kC, even(0.0, 50.0, steps), {0.0}, fall)),
                    2.0 * kPi * (1.0 - std::sin(g) / g),
                    kRounding);
}

TEST(TableFlux, IsTheIntegralOfTheIntensity) {
    constexpr double kQuadrature = 1e-7;  // of the differences
    std::mt19937 random(3);
    for (const TableAngles type : {kA, kB, kC}) {
        const BeamTable table = random_table(type, random);
        const double expected = flux_by_quadrature(table);
        EXPECT_NEAR(table_flux(table), expected, kQuadrature * expected);
    }
}

TEST(MostTableIntensity, IsNeverExceeded) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (const TableAngles type : {kA, kB, kC}) {
        for (int i = 0; i < 400; ++i) {
            const BeamTable table = random_table(type, random);
            const Vector3d about = random_direction(random).normalized();
            const double within_rad = std::pow(unit(random), 3.0) * kPi;
            const double most = most_table_intensity(table, about, within_rad);
            EXPECT_LE(table_intensity(table, about), most);
            EXPECT_LE(most, largest_intensity(table) * (1.0 + kRounding));
            for (int k = 0; k < 100; ++k) {
                const Vector3d aside = about.cross(random_direction(random)).normalized();
                const double turn_rad = within_rad * (k < 50 ? 1.0 : unit(random));
                const Vector3d direction = std::cos(turn_rad) * about + std::sin(turn_rad) * aside;
                ASSERT_LE(table_intensity(table, direction), most)
                    << "type " << static_cast<int>(type) << ", within " << within_rad;
            }
        }
    }
}

TEST(MostTableIntensity, IsTheValueItselfForNoAngle) {
    std::mt19937 random(11);
    for (const TableAngles type : {kA, kB, kC}) {
        const BeamTable table = random_table(type, random);
        for (int i = 0; i < 300; ++i) {
            const Vector3d direction = random_direction(random);
            EXPECT_NEAR(most_table_intensity(table, direction, 0.0),
                        table_intensity(table, direction),
                        1e-9);
        }
        EXPECT_NEAR(most_table_intensity(table, kAxis, kPi), largest_intensity(table), kRounding);
    }
}

// Over the seam of the turn, and over the axis, light is as near as elsewhere.
TEST(MostTableIntensity, SeesOverTheSeam) {
    const auto f = [](double, double H) {
        return H > 300.0 * kDegree && H < 355.0 * kDegree ? 1.0 : 0.0;
    };
    const BeamTable table = table_of(kC, even(0.0, 90.0, 9), even(0.0, 360.0, 72), f);
    const Vector3d direction = direction_at(kC, {80.0 * kDegree, 1.0 * kDegree});
    EXPECT_EQ(table_intensity(table, direction), 0.0);
    EXPECT_EQ(most_table_intensity(table, direction, 0.5 * kDegree), 0.0);
    // Back to asin(sin 9.5 / cos 10) = 9.648 degrees before 1: 351.352 degrees, 0.730 of the way
    // from 355, where it is dark, to 350, where it shines.
    EXPECT_NEAR(most_table_intensity(table, direction, 9.5 * kDegree), 0.7296, 1e-3);
    const Vector3d beyond = direction_at(kC, {2.0 * kDegree, 150.0 * kDegree});
    EXPECT_EQ(most_table_intensity(table, beyond, 1.0 * kDegree), 0.0);
    EXPECT_NEAR(most_table_intensity(table, beyond, 3.0 * kDegree), 1.0, kRounding);
}

TEST(TableEdges, AreWhereATableEndsOnAStep) {
    const auto one = [](double, double) { return 1.0; };
    using Edges = std::vector<TableEdge>;
    const auto at = [](TableAngle angle, double deg) { return TableEdge{angle, deg * kDegree}; };
    EXPECT_EQ(edges_of(table_of(kC, even(0.0, 180.0, 18), {0.0}, one)), Edges{});
    const BeamTable cone = table_of(kC, even(0.0, 60.0, 6), even(0.0, 360.0, 4), one);
    EXPECT_EQ(edges_of(cone), Edges{at(TableAngle::Vertical, 60.0)});
    const auto fall = [](double V, double) { return std::max(0.0, 50.0 * kDegree - V); };
    EXPECT_EQ(edges_of(table_of(kC, even(0.0, 60.0, 6), {0.0}, fall)), Edges{});
    EXPECT_EQ(edges_of(table_of(kC, even(90.0, 180.0, 6), {0.0}, one)),
              Edges{at(TableAngle::Vertical, 90.0)});

    const Edges sides{at(TableAngle::Vertical, -30.0),
                      at(TableAngle::Vertical, 20.0),
                      at(TableAngle::Horizontal, -45.0),
                      at(TableAngle::Horizontal, 40.0)};
    for (const TableAngles type : {kA, kB})
        EXPECT_EQ(edges_of(table_of(type, even(-30.0, 20.0, 5), even(-45.0, 40.0, 5), one)), sides);
    // The poles are no lines.
    const auto hemisphere = [&](TableAngles type) {
        return edges_of(table_of(type, even(-90.0, 90.0, 2), even(-90.0, 90.0, 2), one));
    };
    EXPECT_EQ(hemisphere(kA),
              (Edges{at(TableAngle::Horizontal, -90.0), at(TableAngle::Horizontal, 90.0)}));
    EXPECT_EQ(hemisphere(kB),
              (Edges{at(TableAngle::Vertical, -90.0), at(TableAngle::Vertical, 90.0)}));
    const auto rising = [](double V, double) { return V + 30.0 * kDegree; };
    EXPECT_EQ(edges_of(table_of(kB, even(-30.0, 20.0, 5), even(-90.0, 90.0, 5), rising)),
              Edges{at(TableAngle::Vertical, 20.0)});
}

}  // namespace
}  // namespace aphotic::beam_table_test
