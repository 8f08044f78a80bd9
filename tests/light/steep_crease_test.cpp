// SPDX-License-Identifier: BSD-3-Clause
#include "light/steep_crease.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace aphotic::steep_crease_test {
namespace {

using std::numbers::pi;

constexpr double kDegree = pi / 180.0;

Beam cone(double half_angle_rad, double exponent) {
    return {.name = "cone",
            .cones = {{.part = "all",
                       .half_angle_rad = half_angle_rad,
                       .weight = 1.0,
                       .exponent = exponent}}};
}

TEST(BeamWidth, OfAConeIsItsLobesOrItsEdges) {
    EXPECT_EQ(narrowest_rad(cone(0.1, 1.0)), 0.2);
    EXPECT_DOUBLE_EQ(narrowest_rad(cone(0.5 * pi, 400.0)), 0.1);
    EXPECT_EQ(narrowest_rad(cone(0.5 * pi, 0.0)), pi);
}

// cos^n falls by exp(-1/2) at 1 / sqrt(n) off the axis.
TEST(BeamWidth, OfALobeIsWhereItIsBright) {
    constexpr double kExponent = 1000.0;
    const double width_rad = narrowest_rad(cone(0.5 * pi, kExponent));
    EXPECT_NEAR(std::pow(std::cos(0.5 * width_rad), kExponent), std::exp(-0.5), 1e-3);
}

// Half of the light on the axis.
TEST(BeamWidth, OfASoftConeIsWhereItIsHalfAsBright) {
    Beam soft = cone(0.3, 0.0);
    soft.cones[0].edge_rad = 0.2;
    const BeamFrame frame = frame_about(Eigen::Vector3d::UnitZ());
    const double off_rad = 0.5 * narrowest_rad(soft);
    const Eigen::Vector3d beside(std::sin(off_rad), 0.0, std::cos(off_rad));
    EXPECT_NEAR(intensity_towards(soft, frame, beside),
                0.5 * intensity_towards(soft, frame, Eigen::Vector3d::UnitZ()),
                1e-12);
}

Beam round_table(const std::vector<double>& intensity) {
    BeamTable table{.vertical_rad = {}, .horizontal_rad = {0.0}, .intensity = intensity};
    for (std::size_t i = 0; i < intensity.size(); ++i)
        table.vertical_rad.push_back(static_cast<double>(i) * kDegree);
    return {.name = "table", .cones = {}, .pattern = table};
}

TEST(BeamWidth, OfATableIsTwoStepsWhereItIsSteep) {
    EXPECT_NEAR(narrowest_rad(round_table({1.0, 1.0, 0.2, 0.2, 0.2})), 2.0 * kDegree, 1e-12);
    std::vector<double> smooth;
    for (int i = 0; i <= 90; ++i) smooth.push_back(std::cos(i * kDegree));
    EXPECT_EQ(narrowest_rad(round_table(smooth)), pi);
}

TEST(BeamWidth, OfAnImageIsThatOfItsShorterSide) {
    const Beam image{.name = "image",
                     .cones = {},
                     .pattern = BeamOptics{.along_m = 0.04,
                                           .across_m = 0.02,
                                           .focal_length_m = 0.1,
                                           .distance_m = 0.1,
                                           .aperture_m = 0.05}};
    EXPECT_NEAR(std::tan(0.5 * narrowest_rad(image)), 0.1, 1e-15);
}

}  // namespace
}  // namespace aphotic::steep_crease_test
