// SPDX-License-Identifier: BSD-3-Clause
#include "rig/beam/beam_figures.h"

#include "base/degrees.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace aphotic::beam_figures_test {
namespace {

constexpr double kPi = std::numbers::pi;

Beam lambert() {
    return {.name = "b", .cones = {{.part = "a", .half_angle_rad = 0.5 * kPi, .weight = 1.0}}};
}

// Long along, short across: a triangle in the one plane, in the other half as wide.
BeamTable of_two_planes() {
    BeamTable table;
    table.vertical_rad = {0.0, 0.3, 0.6};
    table.horizontal_rad = {0.0, 0.5 * kPi, kPi, 1.5 * kPi, 2.0 * kPi};
    for (int plane = 0; plane < 5; ++plane) {
        const bool is_along = plane % 2 == 0;
        for (const double value : {4.0, is_along ? 2.0 : 0.0, 0.0})
            table.intensity.push_back(value);
    }
    return table;
}

TEST(BeamFigures, OfALambertianLamp) {
    const BeamFigures figures = figures_of(lambert());
    EXPECT_NEAR(figures.flux, 1.0, 1e-12);
    EXPECT_NEAR(figures.largest_per_sr, 1.0 / kPi, 1e-12);
    EXPECT_NEAR(figures.fwhm_along_rad, 2.0 * kPi / 3.0, 1e-8);
    EXPECT_NEAR(figures.fwhm_across_rad, 2.0 * kPi / 3.0, 1e-8);
    EXPECT_NEAR(figures.widest_rad, 0.5 * kPi, 0.11 * kRadiansPerDegree);
}

// 2 x 0.3 along; across 2 x 0.15, for the plane falls to 0 at 0.3.
TEST(BeamFigures, TellThePlanesApart) {
    const Beam beam = scaled_to_flux({.name = "b", .cones = {}, .pattern = of_two_planes()});
    const BeamFigures figures = figures_of(beam);
    EXPECT_NEAR(figures.fwhm_along_rad, 0.6, 1e-8);
    EXPECT_NEAR(figures.fwhm_across_rad, 0.3, 1e-8);
    EXPECT_NEAR(figures.widest_rad, 0.6, 0.11 * kRadiansPerDegree);
    Beam turned = beam;
    turned.turn_rad = 0.5 * kPi;
    EXPECT_NEAR(figures_of(turned).fwhm_across_rad, 0.6, 1e-8);
}

// What goes 50 degrees off the axis in air goes 35 in water, but there the window has gained by
// cos(35)/cos(50) on the axis: half the axis's intensity is farther out, where by hand
// T n^2 cos(theta_w)/cos(theta) cos^1.568(theta) is half of what it is at 0, at 39.8 degrees.
TEST(BeamFigures, BehindAWindow) {
    Beam beam = lambert();
    beam.cones[0].exponent = std::log(0.5) / std::log(std::cos(50.0 * kRadiansPerDegree));
    beam.window = BeamWindow{.glass_index = 1.49, .water_index = 1.3417};
    const BeamFigures figures = figures_of(beam);
    const double half_rad = 0.5 * figures.fwhm_along_rad;
    const double in_air_rad = std::asin(1.3417 * std::sin(half_rad));
    const auto through = [](double air_rad, double water_rad) {
        // Fresnel's of the step from 1 to 1.3417 alone: glass between changes it by under 1 %.
        const double s = std::sin(air_rad - water_rad) / std::sin(air_rad + water_rad);
        const double p = std::tan(air_rad - water_rad) / std::tan(air_rad + water_rad);
        return 1.0 - 0.5 * (s * s + p * p);
    };
    const double axis = 1.0 - std::pow(0.3417 / 2.3417, 2);
    const double there = through(in_air_rad, half_rad) * std::cos(half_rad) / std::cos(in_air_rad) *
                         std::pow(std::cos(in_air_rad), beam.cones[0].exponent);
    EXPECT_NEAR(there / axis, 0.5, 0.01);
    EXPECT_NEAR(figures.widest_rad * kDegreesPerRadian, 48.18, 0.11);
    EXPECT_LT(figures.flux, 0.96);
}

// A file read into a rig and handed on for a lamp of its own lumens has the same candela.
TEST(Exported, GivesATableBackAsItWas) {
    const BeamTable table = of_two_planes();
    const Beam beam = scaled_to_flux({.name = "b", .cones = {}, .pattern = table});
    const ExportedBeam exported_beam = exported(beam, table_flux(table));
    EXPECT_EQ(exported_beam.error, 0.0);
    EXPECT_EQ(exported_beam.file.table.vertical_rad, table.vertical_rad);
    const TempFolder folder;
    const auto file = folder.path() / "lamp.ies";
    write_photometric_file(exported_beam.file, file);
    const PhotometricFile read = read_photometric_file(file);
    ASSERT_EQ(read.table.intensity.size(), table.intensity.size());
    for (std::size_t i = 0; i < table.intensity.size(); ++i) {
        EXPECT_NEAR(read.table.intensity[i], table.intensity[i], 1e-14 * 4.0);
    }
}

// In water, sampled: what the table says in the middle of a cell is as near as it states.
TEST(Exported, SaysHowNearItsSamplesAre) {
    const Beam beam = lambert();
    const ExportedBeam sampled = exported(beam, 1.0);
    // cos between nodes a degree apart: an eighth of its bend, h^2/8.
    EXPECT_NEAR(sampled.error / (std::pow(kRadiansPerDegree, 2) / 8.0), 1.0, 0.01);
    EXPECT_NEAR(table_flux(sampled.file.table), 1.0, 1e-4);
}

}  // namespace
}  // namespace aphotic::beam_figures_test
