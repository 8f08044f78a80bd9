// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/light_paths.h"

#include "rig/geometry.h"
#include "spectral/curve_loader.h"
#include "support/dice.h"
#include "support/flat.h"
#include "support/scene_rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <vector>

namespace aphotic::light_paths_test {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr unsigned kSeed = 20240611;
// Some ten operations on numbers of the order of 1.
constexpr double kRounding = 1e-13;
// What the search for the shortest path may leave undone: a millionth of the image's side, at
// the least of a smooth function.
constexpr double kSearch = 1e-7;
// Up to here the promise of a render holds (render_plan.h).
constexpr double kBlack = 1e-8;

// The camera of HabCam with fewer and larger pixels, 2 m above a level floor; no strobes.
Rig camera_rig() {
    return {.title = "",
            .sled = {.altitude_m = 2.0, .pitch_rad = 0.0, .roll_rad = 0.0},
            .camera = {.width_px = 34,
                       .height_px = 26,
                       .pixel_pitch_m = 258e-6,
                       .focal_length_m = 0.012,
                       .range = {400.0, 700.0},
                       .sensor = Sensor({flat(1.0), flat(1.0), flat(1.0)}, ResponseKind::Energy),
                       .port = std::nullopt},
            .water = {.absorption_per_m = flat(0.1)},
            .seafloor = {.reflectance = flat(0.5)},
            .strobes = {},
            .materials = {},
            .digest = ""};
}

PortWindow flat_port() {
    return {.distance_m = 0.05, .thickness_m = 0.012, .glass = builtin_glass("bk7")};
}

// Shines straight down, as cos(theta) over the whole half space.
Strobe strobe_at(const Vector3d& position_m) {
    return {.name = "s",
            .position_m = position_m,
            .axis = Vector3d::UnitZ(),
            .beam = {.name = "wide",
                     .weights = ConeWeights::Flux,
                     .cones = {{.part = "all", .half_angle_rad = 90.0 * kDegree, .weight = 1.0}}},
            .spectrum = flat(1.0),
            .power = 1.0,
            .emitter = std::nullopt};
}

// This far above the floor, over its point at (x, y).
Vector3d above_floor(const Sled& sled, double x_m, double y_m, double height_m) {
    const Plane floor = floor_plane(sled);
    const Vector3d& n = floor.normal;
    const double z_m = (n.dot(floor.point_m) - n.x() * x_m - n.y() * y_m) / n.z();
    return Vector3d(x_m, y_m, z_m) + height_m * n;
}

// --- Brute force ----------------------------------------------------------------------- --------

// Floor point and leg of the point (column, row) at a wavelength, if it sees the floor.
struct Seen {
    Vector3d point_m;
    Vector3d direction;
    double leg_m;
};

std::optional<Seen> seen_at(const Rig& rig, double column, double row, double lambda_nm) {
    const WaterRay ray = pixel_ray(rig, column, row, lambda_nm);
    const Plane floor = floor_plane(rig.sled);
    const double approach = -floor.normal.dot(ray.direction);
    if (approach <= 0.0) return std::nullopt;
    const double leg_m = floor.normal.dot(ray.origin_m - floor.point_m) / approach;
    return Seen{ray.origin_m + leg_m * ray.direction, ray.direction, leg_m};
}

struct Bounds {
    double shortest_m = std::numeric_limits<double>::infinity();
    double longest_m = 0.0;
    bool has_horizon = false;
};

std::vector<double> wavelengths_of(const Rig& rig) {
    if (!rig.camera.port) return {550.0};
    constexpr int kWavelengths = 13;
    std::vector<double> lambda_nm;
    for (int i = 0; i < kWavelengths; ++i) {
        lambda_nm.push_back(
            std::lerp(rig.camera.range.first_nm, rig.camera.range.last_nm, i / 12.0));
    }
    return lambda_nm;
}

// The path at a point of the image, taken into the bounds.
double take_in(const Rig& rig,
               const Vector3d& lamp_m,
               double column,
               double row,
               double lambda_nm,
               Bounds& bounds) {
    const auto seen = seen_at(rig, column, row, lambda_nm);
    if (!seen) {
        bounds.has_horizon = true;
        return std::numeric_limits<double>::infinity();
    }
    const double path_m = seen->leg_m + (seen->point_m - lamp_m).norm();
    bounds.shortest_m = std::min(bounds.shortest_m, path_m);
    bounds.longest_m = std::max(bounds.longest_m, path_m);
    return path_m;
}

// Every corner, edge's middle and centre of every pixel; then closer and closer around that with
// the shortest path.
void look_at_image(const Rig& rig, const Vector3d& lamp_m, double lambda_nm, Bounds& bounds) {
    double shortest_m = std::numeric_limits<double>::infinity();
    double best_column = 0.0;
    double best_row = 0.0;
    const double width = rig.camera.width_px;
    const double height = rig.camera.height_px;
    const auto look = [&](double column, double row) {
        if (column < 0.0 || column > width || row < 0.0 || row > height) return;
        const double path_m = take_in(rig, lamp_m, column, row, lambda_nm, bounds);
        if (!(path_m < shortest_m)) return;
        shortest_m = path_m;
        best_column = column;
        best_row = row;
    };
    for (double row = 0.0; row <= height; row += 0.5) {
        for (double column = 0.0; column <= width; column += 0.5) look(column, row);
    }
    for (double step = 0.5; step > 1e-6; step *= 0.5) {
        const double column = best_column;
        const double row = best_row;
        for (const double down : {-step, 0.0, step}) {
            for (const double right : {-step, 0.0, step}) look(column + right, row + down);
        }
    }
}

Bounds brute_force(const Rig& rig) {
    Bounds bounds;
    for (const Strobe& strobe : rig.strobes) {
        // Of an emitter its middle, and cells so small that they are its edges and corners.
        constexpr LampGrid kCells{.across = 201, .along = 201};
        std::vector<Vector3d> lamps_m{strobe.position_m};
        if (strobe.emitter) {
            const auto all_m = lamp_positions_m(strobe, kCells);
            for (const std::size_t i : {0U, 100U, 200U}) {
                for (const std::size_t j : {0U, 100U, 200U}) lamps_m.push_back(all_m[i * 201 + j]);
            }
        }
        for (const Vector3d& lamp_m : lamps_m) {
            for (const double nm : wavelengths_of(rig)) look_at_image(rig, lamp_m, nm, bounds);
        }
    }
    return bounds;
}

double largest_half_diagonal_m(const Rig& rig) {
    double largest_m = 0.0;
    for (const Strobe& s : rig.strobes) {
        if (!s.emitter) continue;
        largest_m = std::max(largest_m, 0.5 * std::hypot(s.emitter->across_m, s.emitter->along_m));
    }
    return largest_m;
}

// Takes in all paths, and no more beyond them than the stated rooms: kPathRoom, and half the
// diagonal of an emitter.
void expect_range_of(const Rig& rig, const std::string& what) {
    const PathRange paths = path_range(rig);
    const Bounds all = brute_force(rig);
    const double half_m = largest_half_diagonal_m(rig);
    EXPECT_EQ(paths.has_horizon, all.has_horizon) << what;
    EXPECT_LE(paths.shortest_m, all.shortest_m) << what;
    EXPECT_GE(paths.shortest_m, (all.shortest_m - half_m) / kPathRoom * (1.0 - kSearch)) << what;
    if (all.has_horizon || paths.has_horizon) return;
    // Short of the longest path only where the light has ended before it.
    const double K_per_m = rig.water.attenuation_per_m(550.0);
    const double left = std::exp(-K_per_m * (paths.longest_m - paths.shortest_m)) *
                        std::pow(paths.shortest_m / paths.longest_m, 3);
    if (paths.longest_m < all.longest_m) {
        EXPECT_LE(left, kDarkShare) << what;
    }
    EXPECT_LE(paths.longest_m, (all.longest_m + half_m) * kPathRoom * (1.0 + kRounding)) << what;
}

// HabCam sees some 1.1 m by 1.4 m of floor.
TEST(PathRange, FindsTheShortestPathBelowAStrobeCloseToTheFloor) {
    for (const double pitch_deg : {0.0, 5.0, -20.0}) {
        for (const Vector3d& place : {Vector3d(0.0, 0.0, 0.05),
                                      Vector3d(0.31, -0.22, 0.05),
                                      Vector3d(-0.4, 0.6, 0.05),
                                      Vector3d(0.5, 0.05, 0.001)}) {
            Rig rig = camera_rig();
            rig.sled.pitch_rad = pitch_deg * kDegree;
            rig.strobes = {strobe_at(above_floor(rig.sled, place.x(), place.y(), place.z()))};
            const std::string what = "pitch " + std::to_string(pitch_deg) + ", over " +
                                     std::to_string(place.x()) + ", " + std::to_string(place.y());
            expect_range_of(rig, what);
            rig.camera.port = flat_port();
            expect_range_of(rig, what + ", behind a port");
        }
    }
}

TEST(PathRange, TakesInAllOfAnEmitter) {
    for (const Vector3d& axis : {Vector3d(0.0, 0.0, 1.0), Vector3d(-0.5, 0.3, 0.8)}) {
        Rig rig = camera_rig();
        rig.sled.pitch_rad = 5.0 * kDegree;
        rig.strobes = {strobe_at({0.5, 0.2, 0.1})};
        rig.strobes[0].axis = axis.normalized();
        rig.strobes[0].emitter = Emitter{.across_m = 0.3, .along_m = 0.2};
        expect_range_of(rig, "an emitter of 0.3 m by 0.2 m");
    }
}

TEST(PathRange, TakesInEveryPathOfRandomRigs) {
    constexpr int kRigs = 60;
    Dice dice(kSeed);
    int without_horizon = 0;
    for (int n = 0; n < kRigs; ++n) {
        Rig rig = camera_rig();
        rig.sled = {.altitude_m = dice.between(0.5, 6.0),
                    .pitch_rad = dice.between(-0.6, 0.6),
                    .roll_rad = dice.between(-0.6, 0.6)};
        rig.camera.width_px = static_cast<int>(dice.between(1.0, 40.0));
        rig.camera.height_px = static_cast<int>(dice.between(1.0, 40.0));
        rig.camera.focal_length_m = dice.between(0.006, 0.03);
        if (n % 3 == 0) rig.camera.port = flat_port();
        const int strobes = 1 + n % 2;
        for (int s = 0; s < strobes; ++s) {
            const double height_m = std::pow(10.0, dice.between(-2.0, 0.3));
            rig.strobes.push_back(strobe_at(
                above_floor(rig.sled, dice.between(-1.5, 1.5), dice.between(-1.5, 1.5), height_m)));
            if (n % 4 == 1) {
                rig.strobes.back().emitter = Emitter{.across_m = dice.between(0.0, 0.01),
                                                     .along_m = dice.between(0.0, 0.01)};
            }
        }
        expect_range_of(rig, "rig " + std::to_string(n) + " of seed " + std::to_string(kSeed));
        without_horizon += path_range(rig).has_horizon ? 0 : 1;
    }
    EXPECT_GT(without_horizon, kRigs / 2) << "most rigs must have ends for this to mean anything";
}

// --- Closed forms ---------------------------------------------------------------------- --------

// Out and back along one line: twice the height on the axis, twice the slant at the corners.
TEST(PathRange, OfAStrobeAtThePupilIsThereAndBack) {
    for (const double height_m : {0.3, 2.0, 17.0}) {
        Rig rig = camera_rig();
        rig.sled.altitude_m = height_m;
        rig.strobes = {strobe_at(Vector3d::Zero())};
        const PathRange paths = path_range(rig);
        const double half_diagonal_m = 0.5 * 258e-6 * std::hypot(34.0, 26.0);
        const double slant = std::hypot(1.0, half_diagonal_m / 0.012);
        EXPECT_NEAR(paths.shortest_m / (2.0 * height_m / kPathRoom), 1.0, kSearch) << height_m;
        EXPECT_NEAR(paths.longest_m / (2.0 * height_m * slant * kPathRoom), 1.0, kRounding)
            << height_m;
        EXPECT_FALSE(paths.has_horizon);
    }
}

// The shortest way from the lamp to the floor and on to the pupil is the straight line from the
// lamp's mirror image under the floor, if the image sees where it crosses.
TEST(PathRange, IsShortestByWayOfTheMirrorPoint) {
    Rig rig = camera_rig();
    rig.strobes = {strobe_at({0.4, -0.3, 0.5})};
    // Pupil 2 m, lamp 1.5 m up, 0.5 m apart: sqrt(0.5^2 + 3.5^2).
    EXPECT_NEAR(path_range(rig).shortest_m * kPathRoom / std::hypot(0.5, 3.5), 1.0, kSearch);
}

TEST(PathRange, IsZeroWhereTheImageSeesNoFloor) {
    Rig rig = camera_rig();
    rig.strobes = {strobe_at({0.5, 0.0, 0.0})};
    // The camera's axis is 120 degrees from straight down, and no ray more than 25 from it.
    rig.sled.roll_rad = 120.0 * kDegree;
    const PathRange paths = path_range(rig);
    EXPECT_EQ(paths.shortest_m, 0.0);
    EXPECT_EQ(paths.longest_m, 0.0);
    EXPECT_FALSE(paths.has_horizon);
}

// --- The horizon ----------------------------------------------------------------------- --------

// Where exp(-K l) / l^3 is this share of what it is at the shortest path, by bisection.
double dark_path_m(double K_per_m, double shortest_m, double share) {
    double low_m = shortest_m;
    double high_m = 1e6 * shortest_m;
    for (int i = 0; i < 200; ++i) {
        const double l_m = 0.5 * (low_m + high_m);
        const double left =
            std::exp(-K_per_m * (l_m - shortest_m)) * std::pow(shortest_m / l_m, 3.0);
        (left > share ? low_m : high_m) = l_m;
    }
    return low_m;
}

TEST(PathRange, EndsInTheDarkWithTheHorizonInView) {
    constexpr double kStep = 1.02;  // the steps in which the end is looked for
    for (const double K_per_m : {0.0, 0.004, 0.1, 3.0}) {
        Rig rig = camera_rig();
        rig.water.multiple = 0.5;
        rig.water.absorption_per_m = flat(K_per_m);
        rig.water.uniform_loss_per_m = 0.5 * K_per_m;
        rig.sled.pitch_rad = 75.0 * kDegree;
        rig.strobes = {strobe_at({0.5, 0.0, 0.0})};
        const PathRange paths = path_range(rig);
        EXPECT_TRUE(paths.has_horizon);
        const double end_m = dark_path_m(K_per_m, paths.shortest_m, kDarkShare);
        EXPECT_GE(paths.longest_m, end_m * (1.0 - kRounding)) << K_per_m << " 1/m";
        EXPECT_LE(paths.longest_m, end_m * kStep) << K_per_m << " 1/m";
    }
    // In air that is the cube root: (1e11)^(1/3) = 4641.59 times the shortest.
    EXPECT_NEAR(dark_path_m(0.0, 1.0, kDarkShare), 4641.588834, 1e-6);
}

// The water that takes least light: 0.02 1/m at 500 nm.
TEST(PathRange, EndsWhereTheClearestWavelengthDoes) {
    constexpr double kStep = 1.02;
    Rig rig = camera_rig();
    rig.water.absorption_per_m = Spectrum("water", {400.0, 500.0, 700.0}, {0.2, 0.02, 0.6});
    rig.sled.pitch_rad = 75.0 * kDegree;
    rig.strobes = {strobe_at({0.5, 0.0, 0.0})};
    const PathRange paths = path_range(rig);
    const double end_m = dark_path_m(0.02, paths.shortest_m, kDarkShare);
    EXPECT_GE(paths.longest_m, end_m * (1.0 - kRounding));
    EXPECT_LE(paths.longest_m, end_m * kStep);
}

// Light of one strobe on one floor point, by docs/background/physics.md but for spectrum and
// reflectance.
double light_of(const Rig& rig, const Strobe& strobe, const Seen& seen, double K_per_m) {
    const Vector3d towards = seen.point_m - strobe.position_m;
    const double d_m = towards.norm();
    const double cos_theta = strobe.axis.dot(towards) / d_m;
    const double cos_i = -floor_plane(rig.sled).normal.dot(towards) / d_m;
    if (cos_theta <= 0.0 || cos_i <= 0.0) return 0.0;
    double light = 0.0;
    for (const Cone& cone : strobe.beam.cones) {
        if (std::acos(std::min(1.0, cos_theta)) > cone.half_angle_rad) continue;
        const double lobe = std::numbers::pi * std::pow(std::sin(cone.half_angle_rad), 2);
        const bool is_flux = strobe.beam.weights == ConeWeights::Flux;
        light += cone.weight / (is_flux ? lobe : 1.0) * cos_theta;
    }
    return strobe.power * light * cos_i / (d_m * d_m) * std::exp(-K_per_m * (d_m + seen.leg_m));
}

// The brightest pixel, and the brightest by paths longer than the longest.
struct Brightest {
    double all = 0.0;
    double beyond = 0.0;
};

Brightest brightest_of(const Rig& rig, double longest_m) {
    Brightest brightest;
    for (double row = 0.5; row < rig.camera.height_px; row += 0.02) {
        for (double column = 0.5; column < rig.camera.width_px; column += 1.0) {
            const auto seen = seen_at(rig, column, row, 550.0);
            if (!seen) continue;
            double all = 0.0;
            double beyond = 0.0;
            for (const Strobe& strobe : rig.strobes) {
                const double light =
                    light_of(rig, strobe, *seen, rig.water.attenuation_per_m(550.0));
                const double path_m = seen->leg_m + (seen->point_m - strobe.position_m).norm();
                all += light;
                beyond += path_m > longest_m ? light : 0.0;
            }
            brightest.all = std::max(brightest.all, all);
            brightest.beyond = std::max(brightest.beyond, beyond);
        }
    }
    return brightest;
}

TEST(PathRange, LeavesOutNothingThatIsNotBlackAgainstTheRest) {
    for (const double K_per_m : {0.0, 0.05, 0.5}) {
        for (const Vector3d& place :
             {Vector3d(0.5, 0.0, 0.0), Vector3d(-3.0, 0.0, -5.0), Vector3d(0.0, 2.0, 1.0)}) {
            Rig rig = camera_rig();
            rig.water.absorption_per_m = flat(K_per_m);
            rig.sled.pitch_rad = 75.0 * kDegree;
            rig.strobes = {strobe_at(place)};
            const Brightest brightest = brightest_of(rig, path_range(rig).longest_m);
            EXPECT_LE(brightest.beyond, kBlack * brightest.all)
                << K_per_m << " 1/m, strobe at " << place.transpose();
        }
    }
}

// Two degrees wide and towards the horizon: it lights nothing near by, and so all that it lights
// is far away.
TEST(PathRange, LeavesOutNothingThatANarrowBeamLightsFarAway) {
    for (const double K_per_m : {0.05, 0.3}) {
        Rig rig = camera_rig();
        rig.water.absorption_per_m = flat(K_per_m);
        rig.sled.pitch_rad = 75.0 * kDegree;
        rig.strobes = {strobe_at({0.5, 0.0, 0.0})};
        const Vector3d down = -floor_plane(rig.sled).normal;
        const Vector3d ahead = (Vector3d::UnitX() - down.x() * down).normalized();
        // 1.5 degrees under the horizon: from 0.5 to 2.5.
        rig.strobes[0].axis = std::cos(1.5 * kDegree) * ahead + std::sin(1.5 * kDegree) * down;
        rig.strobes[0].beam.cones = {
            {.part = "narrow", .half_angle_rad = 1.0 * kDegree, .weight = 1.0}};
        const PathRange paths = path_range(rig);
        const Brightest brightest = brightest_of(rig, paths.longest_m);
        EXPECT_LE(brightest.beyond, kBlack * brightest.all)
            << K_per_m << " 1/m, paths " << paths.shortest_m << " to " << paths.longest_m << " m";
        EXPECT_GT(brightest.all, 0.0);
    }
}

// Behind a port the rays of an edge's middle reach nearer to the horizon than those of its
// corners. With x and y the ray's slopes in air, fore and across, and s = 1 + x^2 + y^2, it does
// not come down where
//
//   x tan(pitch) / n >= sqrt(s - (s - 1) / n^2)
//
// At the fore edge x = 13 * 258 um / 12 mm = 0.2795, in its corners y = 17 * 258 um / 12 mm =
// 0.3655, and n = 1.342 at 550 nm: the middle sees the horizon from 78.4 degrees on, the corners
// from 78.7 on, red and blue a tenth of a degree sooner and later.
TEST(PathRange, FindsTheHorizonInTheMiddleOfAnEdgeBehindAPort) {
    for (const double pitch_deg : {78.0, 78.3, 78.5, 78.6, 78.7, 78.8, 79.5}) {
        Rig rig = camera_rig();
        rig.camera.port = flat_port();
        rig.sled.pitch_rad = pitch_deg * kDegree;
        rig.strobes = {strobe_at({0.5, 0.0, 0.0})};
        expect_range_of(rig, "pitch " + std::to_string(pitch_deg) + " degrees");
    }
}

// --- The family ------------------------------------------------------------------------ --------

std::vector<std::string> names_of(const std::vector<Spectrum>& curves) {
    std::vector<std::string> names;
    for (const Spectrum& curve : curves) names.push_back(curve.name());
    return names;
}

const std::string kFlash = "lamp spectrum 'xenon-flash'";
const std::string kArc = "lamp spectrum 'xenon-arc'";
const std::string kSand = "reflectance 'sand'";
const std::string kAlgae = "reflectance 'red-algae'";

Spectrum arc() {
    return load_curve("xenon-arc", CurveRole::LampSpectrum, {});
}

Spectrum algae() {
    return load_curve("red-algae", CurveRole::Reflectance, {});
}

TEST(LightFamilyOfARig, HasEveryLampOnEveryMaterial) {
    Rig rig = scene_rig("habcam.toml");
    rig.strobes[2].spectrum = arc();
    rig.materials = {algae(), rig.seafloor.reflectance, algae()};
    const LightFamily family = light_family(rig);
    ASSERT_EQ(family.sources.size(), 4U) << "equal materials are one";
    EXPECT_EQ(names_of(family.sources[0]), (std::vector{kFlash, kSand}));
    EXPECT_EQ(names_of(family.sources[1]), (std::vector{kFlash, kAlgae}));
    EXPECT_EQ(names_of(family.sources[2]), (std::vector{kArc, kSand}));
    EXPECT_EQ(names_of(family.sources[3]), (std::vector{kArc, kAlgae}));
}

// What makes curves equal is what they say, not what they are called.
TEST(LightFamilyOfARig, TellsCurvesByTheirValues) {
    Rig rig = camera_rig();
    rig.strobes = {strobe_at({0.5, 0.0, 0.0}), strobe_at({-0.5, 0.0, 0.0})};
    rig.strobes[1].spectrum = Spectrum("another name", {300.0, 1100.0}, {1.0, 1.0});
    EXPECT_EQ(light_family(rig).sources.size(), 1U);
    rig.strobes[1].spectrum = Spectrum("flat", {300.0, 1100.0}, {1.0, 1.01});
    EXPECT_EQ(light_family(rig).sources.size(), 2U);
    rig.strobes[1].spectrum = Spectrum("flat", {300.0, 1101.0}, {1.0, 1.0});
    EXPECT_EQ(light_family(rig).sources.size(), 2U);
}

// --- The port's tilt ------------------------------------------------------------------- --------

// ln of the radiance's change from the middle wavelength's floor point to this one's, on a pixel,
// at this one's loss and reflectance: one cone that fills the half space has no edge in view.
double change_of_light(const Rig& rig, double column, double row, double lambda_nm) {
    const double K_per_m = rig.water.attenuation_per_m(lambda_nm);
    const double rho = rig.seafloor.reflectance.at(lambda_nm);
    const double middle_nm = 0.5 * (rig.camera.range.first_nm + rig.camera.range.last_nm);
    const auto from = seen_at(rig, column, row, middle_nm);
    const auto to = seen_at(rig, column, row, lambda_nm);
    double before = 0.0;
    double after = 0.0;
    for (const Strobe& strobe : rig.strobes) {
        before += rho * light_of(rig, strobe, *from, K_per_m);
        after += rho * light_of(rig, strobe, *to, K_per_m);
    }
    return std::log(after / before);
}

// How far over the tilt the change goes at a pixel, at either end of the range and at a random
// wavelength.
double share_of_tilt(const Rig& rig, const Spectrum& tilt, double column, double row, Dice& dice) {
    const WavelengthRange range = rig.camera.range;
    double worst = 0.0;
    for (const double nm :
         {range.first_nm, range.last_nm, dice.between(range.first_nm, range.last_nm)}) {
        const double change = change_of_light(rig, column, row, nm);
        worst = std::max(worst, std::abs(change) / std::abs(tilt.at(nm)));
    }
    return worst;
}

double worst_share_of_tilt(const Rig& rig, int pixels, Dice& dice) {
    const Spectrum tilt = *light_family(rig).tilt;
    double worst = 0.0;
    for (int i = 0; i < pixels; ++i) {
        const double column = dice.between(0.0, rig.camera.width_px);
        const double row = dice.between(0.0, rig.camera.height_px);
        worst = std::max(worst, share_of_tilt(rig, tilt, column, row, dice));
    }
    return worst;
}

// The tilt is a straight line between 17 wavelengths. Just beyond the middle, where the indices
// level off with an f''/f' of some -1/180 nm, a line of h = 20 nm falls short by h f''/(4 f') = 3
// %; as much again for what lies between the 17 by 17 points of the image that it looks at.
constexpr double kTiltRoom = 0.06;

TEST(PortTilt, BoundsTheChangeOfLightOfSingleLamps) {
    Dice dice(kSeed);
    for (int n = 0; n < 12; ++n) {
        Rig rig = scene_rig("port.toml");
        rig.sled = {.altitude_m = dice.between(0.7, 4.0),
                    .pitch_rad = dice.between(-0.4, 0.4),
                    .roll_rad = dice.between(-0.4, 0.4)};
        rig.strobes = {strobe_at(above_floor(
            rig.sled, dice.between(-1.0, 1.0), dice.between(-1.0, 1.0), dice.between(0.6, 2.0)))};
        rig.strobes[0].axis = -floor_plane(rig.sled).normal;
        const double worst = worst_share_of_tilt(rig, 1000, dice);
        EXPECT_LE(worst, 1.0 + kTiltRoom) << "rig " << n << " of seed " << kSeed << ", strobe at "
                                          << rig.strobes[0].position_m.transpose();
        EXPECT_GT(worst, 0.3) << "the tilt is far over any change; rig " << n;
    }
}

// --- Objects --------------------------------------------------------------------------- --------

Object ball_of(const Vector3d& centre_m, double radius_m, double phong = 0.0) {
    return {.name = "ball",
            .shape = Sphere{.centre_m = centre_m, .radius_m = radius_m},
            .reflectance = flat(0.25),
            .phong = phong};
}

// Points of a ball's surface, and the ways by them: none is outside of the range, which without
// the ball is the floor's.
TEST(LightPathsOfObjects, HoldEveryPathByThem) {
    Rig rig = camera_rig();
    rig.strobes = {strobe_at({0.4, 0.1, 0.0}), strobe_at({-0.3, -0.2, 0.1})};
    const PathRange floor = path_range(rig);
    const Vector3d centre_m(0.1, 0.1, 1.3);
    rig.objects = {ball_of(centre_m, 0.3)};
    const PathRange all = path_range(rig);
    EXPECT_LE(all.shortest_m, floor.shortest_m);
    EXPECT_GE(all.longest_m, floor.longest_m);
    std::mt19937 random(kSeed);
    std::normal_distribution<double> any;
    double shortest_m = floor.shortest_m;
    for (int i = 0; i < 20000; ++i) {
        const Vector3d point_m =
            centre_m + 0.3 * Vector3d(any(random), any(random), any(random)).normalized();
        for (const Strobe& strobe : rig.strobes) {
            const double path_m = point_m.norm() + (point_m - strobe.position_m).norm();
            EXPECT_GE(path_m, all.shortest_m);
            EXPECT_LE(path_m, all.longest_m);
            shortest_m = std::min(shortest_m, path_m);
        }
    }
    // The box about the ball reaches nearer than the ball, but not by more than its corners do.
    EXPECT_GT(all.shortest_m, shortest_m - 2.0 * 0.3 * (std::sqrt(3.0) - 1.0));
}

TEST(LightPathsOfObjects, AreTheFloorsWhenTheyAreOutOfView) {
    Rig rig = camera_rig();
    rig.strobes = {strobe_at({0.4, 0.1, 0.0})};
    const PathRange floor = path_range(rig);
    rig.objects = {ball_of({0.0, 0.0, -1.0}, 0.2)};
    EXPECT_EQ(path_range(rig).shortest_m, floor.shortest_m);
    EXPECT_EQ(path_range(rig).longest_m, floor.longest_m);
}

TEST(LightPathsOfObjects, BringTheirMaterialsAndTheirHighlight) {
    Rig rig = camera_rig();
    rig.strobes = {strobe_at({0.4, 0.1, 0.0})};
    EXPECT_EQ(light_family(rig).sources.size(), 1U);
    rig.objects = {ball_of({0.0, 0.0, 1.5}, 0.2)};
    EXPECT_EQ(light_family(rig).sources.size(), 2U);
    EXPECT_EQ(light_family_by_strobe(rig).sources.size(), 2U);
    rig.objects = {ball_of({0.0, 0.0, 1.5}, 0.2, 0.1)};
    EXPECT_EQ(light_family(rig).sources.size(), 3U) << "and the bare lamp";
}

}  // namespace
}  // namespace aphotic::light_paths_test
