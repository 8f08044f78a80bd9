// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/exposure.h"

#include "rig/geometry.h"

#include "spectral/manifest.h"
#include "support/flat.h"
#include "support/scene_rig.h"
#include "tests/support/closed_form.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace aphotic::exposure_test {
namespace {

constexpr unsigned kSeed = 20240607;
constexpr double kBrightColour = 1.0;  // far from the limit of single precision

double brightest_of(const Rig& rig, double lambda_nm) {
    double brightest = 0.0;
    for (int row = 0; row < rig.camera.height_px; row += 16) {
        for (int column = 0; column < rig.camera.width_px; column += 16) {
            brightest =
                std::max(brightest, closed_form::radiance(rig, column, row, lambda_nm).radiance);
        }
    }
    return brightest;
}

// Low lamps side by side: between them the floor is brighter than below any. That is what the
// factor of four up to the largest half float is for.
TEST(RadianceBound, KeepsItsMarginBetweenLampsCloseToTheFloor) {
    constexpr double kMargin = 4.0;
    for (const double spacing : {0.5, 0.8, 1.2}) {
        constexpr double kHeightM = 0.02;
        Rig rig = habcam();
        rig.sled.pitch_rad = 0.0;
        const Strobe first = rig.strobes.front();
        rig.strobes.clear();
        for (const double x : {-0.5, 0.5}) {
            for (const double y : {-0.5, 0.5}) {
                Strobe strobe = first;
                strobe.position_m = {x * spacing * kHeightM + 0.011,
                                     y * spacing * kHeightM + 0.017,
                                     rig.sled.altitude_m - kHeightM};
                strobe.axis = Eigen::Vector3d::UnitZ();
                strobe.beam.cones = {{.part = "", .half_angle_rad = 1.57, .weight = 1.0}};
                rig.strobes.push_back(strobe);
            }
        }
        const double bound = RadianceBound(rig).at(550.0);
        double brightest = 0.0;
        for (int row = 412; row < 612; row += 3) {
            for (int column = 580; column < 780; column += 3) {
                brightest =
                    std::max(brightest, closed_form::radiance(rig, column, row, 550.0).radiance);
            }
        }
        EXPECT_LT(brightest, kMargin * bound) << spacing;
        EXPECT_GT(brightest, 0.5 * bound) << spacing;
    }
}

// A bound far too high would push the frame's dark parts under the normal half floats. What it
// may waste: below a strobe all of its cones count, though the bright one may point elsewhere.
TEST(RadianceBound, IsCloseForAnOrdinaryRig) {
    constexpr double kWaste = 4.0;  // two of the 30 octaves that normal half floats span
    for (const double altitude_m : {1.0, 2.0, 3.0}) {
        Rig rig = habcam();
        rig.sled.altitude_m = altitude_m;
        const RadianceBound bound(rig);
        for (const double lambda_nm : {450.0, 550.0, 650.0}) {
            const double brightest = brightest_of(rig, lambda_nm);
            EXPECT_GE(bound.at(lambda_nm), brightest) << altitude_m << " m, " << lambda_nm;
            EXPECT_LE(bound.at(lambda_nm), kWaste * brightest) << altitude_m << " m, " << lambda_nm;
        }
    }
}

// A lamp off to the side, its foot out of view: the bound is that of the nearest edge's points,
// whose angles are widened by a thirty-second of the image.
TEST(RadianceBound, IsTightWhereNoStrobeStandsOverTheView) {
    constexpr double kWaste = 1.2;
    Rig rig = habcam();
    rig.sled.pitch_rad = 0.0;
    rig.strobes.resize(1, rig.strobes.front());
    rig.strobes[0].position_m = {3.0, 0.0, 0.0};
    rig.strobes[0].axis = Eigen::Vector3d::UnitZ();
    rig.strobes[0].beam.cones = {{.part = "", .half_angle_rad = 1.57, .weight = 1.0}};
    const double brightest = brightest_of(rig, 550.0);
    EXPECT_GE(RadianceBound(rig).at(550.0), brightest);
    EXPECT_LE(RadianceBound(rig).at(550.0), kWaste * brightest);
}

// A ball in the light, near a lamp and far from it: its brightest point, straight below the lamp,
// is Phi P sum(A) rho / (pi d^2) at the most, and the bound wastes no more than two octaves on it.
TEST(RadianceBound, HoldsForAnObjectCloseToALamp) {
    for (const double away_m : {0.002, 0.05, 1.0}) {
        Rig rig = habcam();
        rig.water.multiple = 0.0;
        Strobe& strobe = rig.strobes.front();
        strobe.position_m = {0.1, 0.0, 0.3};
        strobe.axis = Eigen::Vector3d::UnitZ();
        strobe.beam.cones = {{.part = "", .half_angle_rad = 1.0, .weight = 1.0}};
        rig.strobes.erase(rig.strobes.begin() + 1, rig.strobes.end());
        const double floor = RadianceBound(rig).at(550.0);
        rig.objects = {{.name = "ball",
                        .shape = Sphere{.centre_m = {0.1, 0.0, 0.4 + away_m}, .radius_m = 0.1},
                        .reflectance = flat(0.8)}};
        const double brightest = strobe.spectrum.at(550.0) * strobe.power * 0.8 /
                                 std::pow(std::numbers::pi * std::sin(1.0) * away_m, 2);
        const double bound = RadianceBound(rig).at(550.0);
        EXPECT_GE(bound, brightest * (1.0 - 1e-12)) << away_m;
        EXPECT_LE(bound, std::max(floor, 4.0 * brightest)) << away_m;
    }
}

TEST(RadianceBound, IsZeroInTheDark) {
    Rig off = habcam();
    for (Strobe& strobe : off.strobes) strobe.power = 0.0;
    EXPECT_EQ(RadianceBound(off).at(550.0), 0.0);
    Rig black = habcam();
    black.seafloor.reflectance = flat(0.0);
    EXPECT_EQ(RadianceBound(black).at(550.0), 0.0);
}

// --- Exposure -------------------------------------------------------------------------- --------

TEST(ExposureLog2, BringsTheBoundIntoTheUpperOctave) {
    std::mt19937_64 random(kSeed);
    std::uniform_real_distribution<double> log10_bound(-20.0, 20.0);
    for (int n = 0; n < 1000; ++n) {
        const double bound = std::pow(10.0, log10_bound(random));
        const double exposed = std::ldexp(bound, exposure_log2(bound, kBrightColour));
        EXPECT_GT(exposed, 0x1p13) << bound;
        EXPECT_LE(exposed, 0x1p14) << bound;
    }
}

TEST(ExposureLog2, OfDarknessIsZero) {
    EXPECT_EQ(exposure_log2(0.0, kBrightColour), 0);
    EXPECT_EQ(exposure_log2(0.0, 0.0), 0);
}

// POV-Ray's colours are single precision: the largest power of two that they hold is 2^127.
// 2^14 / 1e-302 is 2^1017.
TEST(ExposureLog2, StaysWithinWhatAManifestHolds) {
    EXPECT_EQ(exposure_log2(1e-302, 1e-302), kMostExposureLog2);
    EXPECT_EQ(exposure_log2(1e307, 1e307), -kMostExposureLog2);
}

TEST(ExposureLog2, KeepsColoursInSinglePrecision) {
    for (const double colour : {1.0, 1e6, 1e30}) {
        for (const double bound : {1e-60, 1e-30, 1.0}) {
            const double exposed = std::ldexp(colour, exposure_log2(bound, colour));
            EXPECT_LT(exposed, 0x1p127) << colour << " for a bound of " << bound;
        }
    }
    EXPECT_EQ(exposure_log2(1.0, 0x1p100), 14) << "no limit where none is needed";
    EXPECT_LT(exposure_log2(1e-60, 0x1p100), 28);
}

}  // namespace
}  // namespace aphotic::exposure_test
