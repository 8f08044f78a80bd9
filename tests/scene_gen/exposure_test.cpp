// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/exposure.h"

#include "rig/geometry.h"

#include "rig/rig_reader.h"
#include "spectral/manifest.h"
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

Spectrum flat(double value) {
    return {"flat", {300.0, 800.0}, {value, value}};
}

// Random rigs, as strange as the reader lets them be; everything seeded.
class RandomRigs {
  public:
    Rig next(bool has_port) {
        Rig rig{
            .title = "",
            .sled = {.altitude_m = between(0.5, 6.0),
                     .pitch_rad = between(-0.3, 0.3),
                     .roll_rad = between(-0.3, 0.3)},
            .camera = {.width_px = 200 + static_cast<int>(between(0.0, 1000.0)),
                       .height_px = 200 + static_cast<int>(between(0.0, 1000.0)),
                       .pixel_pitch_m = 6.45e-6,
                       .focal_length_m = between(0.005, 0.03),
                       .range = {400.0, 700.0},
                       .sensor = Sensor({flat(1.0), flat(1.0), flat(1.0)}, ResponseKind::Energy),
                       .port = std::nullopt},
            .water = {.absorption_per_m = flat(between(0.0, 1.0))},
            .seafloor = {.reflectance = flat(between(0.05, 1.0))},
            .strobes = {},
            .digest = ""};
        if (between(0.0, 1.0) < 0.3) rig.seafloor.phong = between(0.0, 1.0);
        if (has_port) {
            rig.camera.port = PortWindow{.distance_m = between(0.01, 0.1),
                                         .thickness_m = between(0.002, 0.02),
                                         .glass = builtin_glass("bk7")};
        }
        const int strobes = 1 + static_cast<int>(between(0.0, 4.0));
        for (int s = 0; s < strobes; ++s) add_strobe(rig);
        return rig;
    }

    double between(double least, double most) {
        return std::uniform_real_distribution<double>(least, most)(random_);
    }

  private:
    void add_strobe(Rig& rig) {
        // Every other one is close to the floor, where the image's peak is small and high.
        const double below_m = between(0.0, 1.0) < 0.5 ? std::pow(10.0, between(-2.0, -0.5))
                                                       : between(0.05, rig.sled.altitude_m);
        const double x = between(-1.5, 1.5);
        const double y = between(-1.5, 1.5);
        const closed_form::Vector down = closed_form::world_down(rig.sled);
        const double floor_z = rig.sled.altitude_m - (x * down[0] + y * down[1]) / down[2];
        const Eigen::Vector3d position(x, y, floor_z - below_m);
        Beam beam{.name = "b", .weights = ConeWeights::Flux, .cones = {}};
        const int cones = 1 + static_cast<int>(between(0.0, 3.0));
        for (int c = 0; c < cones; ++c) {
            beam.cones.push_back(
                {.part = "", .half_angle_rad = between(0.02, 1.57), .weight = between(0.0, 1.0)});
        }
        rig.strobes.push_back(
            {.name = "s",
             .position_m = position,
             .axis = Eigen::Vector3d(between(-1.0, 1.0), between(-1.0, 1.0), between(-0.2, 1.0))
                         .normalized(),
             .beam = std::move(beam),
             .spectrum = flat(between(0.1, 10.0)),
             .power = between(0.1, 10.0),
             .emitter = std::nullopt});
    }

    std::mt19937_64 random_{kSeed};
};

struct Pixel {
    int column, row;
};

// Where the image is brightest by far when a strobe is close to the floor: around its foot. The
// pinhole's pixel, with the water's index in place of the port: near enough.
Pixel pixel_near_foot(const Rig& rig, const Strobe& strobe, RandomRigs& random) {
    const double magnified =
        (rig.camera.port ? 1.34 : 1.0) * rig.camera.focal_length_m / rig.camera.pixel_pitch_m;
    const closed_form::Vector down = closed_form::world_down(rig.sled);
    const closed_form::Vector place{
        strobe.position_m.x(), strobe.position_m.y(), strobe.position_m.z()};
    const double height_m =
        closed_form::dot({-place[0], -place[1], rig.sled.altitude_m - place[2]}, down);
    const closed_form::Vector foot = closed_form::plus(place, height_m, down);
    const double x = (foot[0] + random.between(-2.0, 2.0) * height_m) / foot[2];
    const double y = (foot[1] + random.between(-2.0, 2.0) * height_m) / foot[2];
    return {static_cast<int>(std::floor(0.5 * rig.camera.width_px + magnified * y)),
            static_cast<int>(std::floor(0.5 * rig.camera.height_px - magnified * x))};
}

// The brightest of so many pixels at random and near each strobe's foot, in units of the bound.
double worst_share(const Rig& rig, RandomRigs& random, int pixels) {
    const double bound = RadianceBound(rig).at(550.0);
    double brightest = 0.0;
    const auto look_at = [&](Pixel pixel) {
        if (pixel.column < 0 || pixel.column >= rig.camera.width_px || pixel.row < 0 ||
            pixel.row >= rig.camera.height_px) {
            return;
        }
        brightest = std::max(brightest,
                             closed_form::radiance(rig, pixel.column, pixel.row, 550.0).radiance);
    };
    for (int i = 0; i < pixels; ++i) {
        look_at({static_cast<int>(random.between(0.0, rig.camera.width_px)),
                 static_cast<int>(random.between(0.0, rig.camera.height_px))});
        for (const Strobe& strobe : rig.strobes) look_at(pixel_near_foot(rig, strobe, random));
    }
    if (brightest == 0.0) return 0.0;
    return bound > 0.0 ? brightest / bound : std::numeric_limits<double>::infinity();
}

void expect_bound_holds(bool has_port) {
    constexpr int kRigs = 150;
    constexpr int kPixels = 60;
    RandomRigs random;
    int lit = 0;
    double worst = 0.0;
    for (int n = 0; n < kRigs; ++n) {
        const Rig rig = random.next(has_port);
        const double share = worst_share(rig, random, kPixels);
        EXPECT_LE(share, 1.0) << "rig " << n << " of seed " << kSeed;
        worst = std::max(worst, share);
        lit += share > 0.0 ? 1 : 0;
    }
    EXPECT_GT(lit, kRigs / 2) << "most rigs must be lit for this to mean anything";
    EXPECT_GT(worst, 0.5) << "no rig comes near its bound";
}

TEST(RadianceBound, HoldsForRandomRigs) {
    expect_bound_holds(false);
}

TEST(RadianceBound, HoldsForRandomRigsBehindAPort) {
    expect_bound_holds(true);
}

Rig habcam() {
    return read_rig(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam.toml");
}

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

// The lamp's power is a factor of everything.
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

TEST(RadianceBound, GrowsWithThePower) {
    constexpr double kRounding = 1e-14;
    Rig rig = habcam();
    const double before = RadianceBound(rig).at(550.0);
    for (Strobe& strobe : rig.strobes) strobe.power = 8.0;
    EXPECT_NEAR(RadianceBound(rig).at(550.0) / before, 8.0, 8.0 * kRounding);
}

TEST(RadianceBound, IsZeroInTheDark) {
    Rig off = habcam();
    for (Strobe& strobe : off.strobes) strobe.power = 0.0;
    EXPECT_EQ(RadianceBound(off).at(550.0), 0.0);
    Rig black = habcam();
    black.seafloor.reflectance = flat(0.0);
    EXPECT_EQ(RadianceBound(black).at(550.0), 0.0);
}

// --- Exposure --------------------------------------------------------------------------------

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

TEST(ExposureLog2, OfPowersOfTwoIsExact) {
    EXPECT_EQ(exposure_log2(0x1p14, kBrightColour), 0);
    EXPECT_EQ(exposure_log2(1.0, kBrightColour), 14);
    EXPECT_EQ(exposure_log2(0x1p20, kBrightColour), -6);
    EXPECT_EQ(exposure_log2(0x1p-10, kBrightColour), 24);
    EXPECT_EQ(exposure_log2(0x1.8p0, kBrightColour), 13);
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
