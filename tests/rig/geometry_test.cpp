// SPDX-License-Identifier: BSD-3-Clause
#include "rig/geometry.h"
#include "support/flat.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace aphotic::geometry_test {
namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;
// Some ten operations on numbers of the order of 1.
constexpr double kRounding = 1e-14;

// HabCam's camera 2 m above a level floor; no strobes.
Rig camera_rig() {
    return {.title = "",
            .sled = {.altitude_m = 2.0, .pitch_rad = 0.0, .roll_rad = 0.0},
            .camera = {.width_px = 1360,
                       .height_px = 1024,
                       .pixel_pitch_m = 6.45e-6,
                       .focal_length_m = 0.012,
                       .range = {400.0, 700.0},
                       .sensor = Sensor({flat(1.0), flat(1.0), flat(1.0)}, ResponseKind::Energy),
                       .port = std::nullopt},
            .water = {.absorption_per_m = flat(0.1)},
            .seafloor = {.reflectance = flat(0.5)},
            .strobes = {},
            .digest = ""};
}

Rig port_rig() {
    Rig rig = camera_rig();
    rig.camera.port =
        PortWindow{.distance_m = 0.05, .thickness_m = 0.012, .glass = builtin_glass("bk7")};
    return rig;
}

Strobe strobe_with(const Vector3d& axis, std::optional<Emitter> emitter) {
    return {.name = "s",
            .position_m = {0.3, -0.4, 0.1},
            .axis = axis.normalized(),
            .beam = {.name = "",
                     .weights = ConeWeights::Flux,
                     .cones = {{.part = "", .half_angle_rad = 0.5 * kPi, .weight = 1.0}}},
            .spectrum = flat(1.0),
            .power = 1.0,
            .emitter = emitter};
}

void expect_near(const Vector3d& found, const Vector3d& wanted, double tolerance = kRounding) {
    EXPECT_LE((found - wanted).norm(), tolerance)
        << "found " << found.transpose() << "; wanted " << wanted.transpose();
}

// --- Floor ----------------------------------------------------------------------------- --------

// z of the floor at (x, y), by the plane's own equation.
double floor_z(const Plane& floor, double x_m, double y_m) {
    const Vector3d& n = floor.normal;
    const double c = n.dot(floor.point_m);
    return (c - n.x() * x_m - n.y() * y_m) / n.z();
}

TEST(FloorPlane, FallsAwayForwardWithTheBowUp) {
    const Plane floor =
        floor_plane({.altitude_m = 2.0, .pitch_rad = 5.0 * kDegree, .roll_rad = 0.0});
    for (const double x_m : {-1.0, 0.0, 2.0}) {
        EXPECT_NEAR(floor_z(floor, x_m, 0.7), 2.0 + x_m * std::tan(5.0 * kDegree), kRounding)
            << x_m;
    }
}

TEST(FloorPlane, RisesToStarboardWithStarboardDown) {
    const Plane floor =
        floor_plane({.altitude_m = 2.0, .pitch_rad = 0.0, .roll_rad = 10.0 * kDegree});
    for (const double y_m : {-1.0, 0.0, 2.0}) {
        EXPECT_NEAR(floor_z(floor, 0.7, y_m), 2.0 - y_m * std::tan(10.0 * kDegree), kRounding)
            << y_m;
    }
}

TEST(FloorPlane, PassesThroughThePointBelowThePupilAtAnyAttitude) {
    for (const double pitch : {-1.2, -0.1, 0.4}) {
        for (const double roll : {-0.7, 0.2, 1.1}) {
            const Plane floor =
                floor_plane({.altitude_m = 3.0, .pitch_rad = pitch, .roll_rad = roll});
            EXPECT_NEAR(floor.normal.norm(), 1.0, kRounding);
            EXPECT_NEAR(height_above(floor, {0.0, 0.0, 3.0}), 0.0, kRounding);
            EXPECT_GT(height_above(floor, {0.0, 0.0, 0.0}), 0.0) << "the normal points at us";
        }
    }
}

// The header's formula, by turning the sled: first pitch about starboard, then roll about the
// pitched bow, as the marine convention has it.
TEST(FloorPlane, IsPerpendicularToTheWorldsDown) {
    const double pitch = 0.2;
    const double roll = 0.3;
    const Eigen::Matrix3d sled_to_world =
        (Eigen::AngleAxisd(pitch, Vector3d::UnitY()) * Eigen::AngleAxisd(roll, Vector3d::UnitX()))
            .toRotationMatrix();
    const Vector3d down = sled_to_world.transpose() * Vector3d::UnitZ();
    const Plane floor = floor_plane({.altitude_m = 1.0, .pitch_rad = pitch, .roll_rad = roll});
    expect_near(floor.normal, -down);
}

TEST(HeightAbove, IsMeasuredAlongTheNormal) {
    const Plane floor =
        floor_plane({.altitude_m = 2.0, .pitch_rad = 60.0 * kDegree, .roll_rad = 0.0});
    EXPECT_NEAR(height_above(floor, Vector3d::Zero()), 2.0 * std::cos(60.0 * kDegree), kRounding);
    EXPECT_LT(height_above(floor, {0.0, 0.0, 2.1}), 0.0);
}

// --- Rays ------------------------------------------------------------------------------ --------

// Forward is up in the image, starboard right; half a millimetre on the sensor each way from the
// centre of an asymmetric point.
TEST(PixelRay, HasItsTopRowForwardAndItsRightColumnStarboard) {
    const Rig rig = camera_rig();
    expect_near(pixel_ray(rig, 0.0, 0.0, 550.0).direction,
                Vector3d(512 * 6.45e-6, -680 * 6.45e-6, 0.012).normalized());
    expect_near(pixel_ray(rig, 1360.0, 256.0, 550.0).direction,
                Vector3d(256 * 6.45e-6, 680 * 6.45e-6, 0.012).normalized());
    const Rig behind_glass = port_rig();
    const WaterRay ray = pixel_ray(behind_glass, 1360.0, 256.0, 550.0);
    EXPECT_GT(ray.direction.x(), 0.0);
    EXPECT_GT(ray.direction.y(), 0.0);
    EXPECT_NEAR(ray.direction.y() / ray.direction.x(), 680.0 / 256.0, kRounding);
    EXPECT_NEAR(ray.origin_m.y() / ray.origin_m.x(), 680.0 / 256.0, kRounding);
}

// Snell's law in its vector form, for a unit ray through a face perpendicular to z.
Vector3d refracted(const Vector3d& ray, double n_from, double n_to) {
    const double ratio = n_from / n_to;
    const double cos_from = ray.z();
    const double cos_to = std::sqrt(1.0 - ratio * ratio * (1.0 - cos_from * cos_from));
    return ratio * ray + (cos_to - ratio * cos_from) * Vector3d::UnitZ();
}

TEST(PixelRay, ObeysSnellAtBothFacesOfAFlatPort) {
    const Rig rig = port_rig();
    for (const double lambda_nm : {400.0, 550.0, 700.0}) {
        const double n_glass = rig.camera.port->glass.index(lambda_nm);
        const double n_water = seawater_index(lambda_nm, 35.0, 10.0);
        for (const double column : {0.0, 200.5, 680.0, 1360.0}) {
            for (const double row : {0.0, 511.0, 900.0}) {
                const Vector3d air = pixel_ray(camera_rig(), column, row, lambda_nm).direction;
                const Vector3d glass = refracted(air, 1.0, n_glass);
                const Vector3d water = refracted(glass, n_glass, n_water);
                const Vector3d inner = air * (0.05 / air.z());
                const Vector3d outer = inner + glass * (0.012 / glass.z());
                const WaterRay ray = pixel_ray(rig, column, row, lambda_nm);
                expect_near(ray.direction, water);
                expect_near(ray.origin_m, outer);
                EXPECT_NEAR(ray.direction.norm(), 1.0, kRounding);
            }
        }
    }
}

// Column at which the rays of this wavelength run at this angle in the water, by bisection.
double column_of_angle(const Rig& rig, double angle_rad, double lambda_nm) {
    double low = 680.0;
    double high = 3000.0;
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (low + high);
        const Vector3d ray = pixel_ray(rig, middle, 512.0, lambda_nm).direction;
        (std::atan2(ray.y(), ray.z()) < angle_rad ? low : high) = middle;
    }
    return low;
}

// How far blue (450 nm) lies outside red (650 nm) for a far object, f = 12 mm, 6.45 um pixels,
// S = 35, T = 10: worked out by hand from the indices of Quan and Fry (1995) before this was
// written.
TEST(PixelRay, HasTheLateralColourOfAFlatPort) {
    constexpr double kOneDecimal = 0.05;  // to which the expected values are given
    struct Shift {
        double angle_deg;
        double pixels;
    };
    for (const Shift& shift : {Shift{5.0, 1.4}, {10.0, 2.9}, {15.0, 4.8}, {20.0, 7.5}}) {
        const Rig rig = port_rig();
        const double blue = column_of_angle(rig, shift.angle_deg * kDegree, 450.0);
        const double red = column_of_angle(rig, shift.angle_deg * kDegree, 650.0);
        EXPECT_NEAR(blue - red, shift.pixels, kOneDecimal) << shift.angle_deg << " degrees";
    }
}

TEST(DistanceTo, IsMeasuredAlongTheRay) {
    const Plane floor = floor_plane({.altitude_m = 2.0, .pitch_rad = 0.0, .roll_rad = 0.0});
    const WaterRay slanted{.origin_m = {0.0, 0.0, 0.5},
                           .direction = Vector3d(0.0, 3.0, 4.0).normalized()};
    const auto distance_m = distance_to(floor, slanted);
    ASSERT_TRUE(distance_m.has_value());
    EXPECT_NEAR(*distance_m, 1.5 * 5.0 / 4.0, kRounding);
}

TEST(DistanceTo, IsNothingForRaysThatDoNotComeDown) {
    const Plane floor = floor_plane({.altitude_m = 2.0, .pitch_rad = 0.0, .roll_rad = 0.0});
    const Vector3d above(0.0, 0.0, 0.0);
    const Vector3d below(0.0, 0.0, 3.0);
    EXPECT_FALSE(distance_to(floor, {above, Vector3d(0.0, 1.0, 0.0)}).has_value()) << "level";
    EXPECT_FALSE(distance_to(floor, {above, Vector3d(0.0, 0.0, -1.0)}).has_value()) << "up";
    EXPECT_FALSE(distance_to(floor, {below, Vector3d(0.0, 0.0, 1.0)}).has_value()) << "under it";
    EXPECT_FALSE(distance_to(floor, {below, Vector3d(0.0, 0.0, -1.0)}).has_value())
        << "up through it";
}

// --- Emitters -------------------------------------------------------------------------- --------

TEST(LampPositions, OfAPointAreThePoint) {
    const Strobe strobe = strobe_with({0.1, 0.2, 1.0}, std::nullopt);
    const auto lamps_m = lamp_positions_m(strobe, {.across = 3, .along = 3});
    ASSERT_EQ(lamps_m.size(), 1U);
    expect_near(lamps_m[0], strobe.position_m, 0.0);
}

// Cells of a width w over n: their centres have the variance of a uniform w, less that of a cell.
TEST(LampPositions, HaveTheMeanAndVarianceOfAGrid) {
    const Emitter emitter{.across_m = 0.08, .along_m = 0.03};
    for (const Vector3d& axis : {Vector3d(0.0, 0.0, 1.0),
                                 Vector3d(-0.4, 0.3, 0.8),
                                 Vector3d(1.0, 0.0, 0.0),
                                 Vector3d(-1.0, 0.0, 0.0)}) {
        const Strobe strobe = strobe_with(axis, emitter);
        const auto lamps_m = lamp_positions_m(strobe, {.across = 5, .along = 2});
        ASSERT_EQ(lamps_m.size(), 10U);
        Vector3d mean = Vector3d::Zero();
        for (const Vector3d& lamp : lamps_m) mean += lamp / 10.0;
        expect_near(mean, strobe.position_m);

        // Forward as the emitter's plane sees it, or down for one that shines fore or aft.
        const bool is_level = std::abs(strobe.axis.x()) == 1.0;
        const Vector3d ahead = is_level ? Vector3d::UnitZ() : Vector3d::UnitX();
        const Vector3d along = (ahead - ahead.dot(strobe.axis) * strobe.axis).normalized();
        const Vector3d across = strobe.axis.cross(along);
        double across_m2 = 0.0;
        double along_m2 = 0.0;
        double covariance_m2 = 0.0;
        for (const Vector3d& lamp : lamps_m) {
            const Vector3d from_mean = lamp - strobe.position_m;
            EXPECT_NEAR(from_mean.dot(strobe.axis), 0.0, kRounding) << "off the emitter's plane";
            across_m2 += std::pow(from_mean.dot(across), 2.0) / 10.0;
            along_m2 += std::pow(from_mean.dot(along), 2.0) / 10.0;
            covariance_m2 += from_mean.dot(across) * from_mean.dot(along) / 10.0;
        }
        EXPECT_NEAR(across_m2, 0.08 * 0.08 / 12.0 * (1.0 - 1.0 / 25.0), kRounding);
        EXPECT_NEAR(along_m2, 0.03 * 0.03 / 12.0 * (1.0 - 1.0 / 4.0), kRounding);
        EXPECT_NEAR(covariance_m2, 0.0, kRounding);
    }
}

// Within a millionth of a radian of fore or aft, along is down; beyond it, forward as the plane
// sees it: away from where the axis leans, up or aside.
TEST(LampPositions, TurnToDownWithinAMillionthOfARadianOfForeAndAft) {
    for (const double end : {1.0, -1.0}) {
        for (const double off_rad : {0.0, 0.5e-6, 2e-6, 3e-5, 1e-3}) {
            const Strobe strobe =
                strobe_with({end, off_rad, 0.0}, Emitter{.across_m = 0.08, .along_m = 0.02});
            const auto pair = lamp_positions_m(strobe, {.across = 1, .along = 2});
            const Vector3d wanted =
                off_rad < 1e-6 ? Vector3d(0.0, 0.0, 0.01) : Vector3d(0.01 * off_rad, 0.01, 0.0);
            // Of a sideways lean, all but its square is in the direction.
            const double tolerance = off_rad * off_rad + 1e-9;
            expect_near((pair[1] - pair[0]).cwiseAbs(), wanted, tolerance);
        }
    }
}

TEST(LampGrid, OfAPointIsOneLamp) {
    const LampGrid grid = lamp_grid(camera_rig(), strobe_with({0.0, 0.0, 1.0}, std::nullopt), 1.0);
    EXPECT_EQ(grid.across, 1);
    EXPECT_EQ(grid.along, 1);
}

// The strobe stands 1.9 m above the floor: lamps closer than 0.011 x 1.9 m = 20.9 mm.
TEST(LampGrid, IsTheCoarsestThatKeepsTheSpacing) {
    const double spacing_m = kLampSpacing * 1.9;
    const auto lamps = [](double across_m, double along_m) {
        return lamp_grid(
            camera_rig(),
            strobe_with({0.0, 0.0, 1.0}, Emitter{.across_m = across_m, .along_m = along_m}),
            0.0);
    };
    for (const double size_m : {0.001, 0.0205, 0.0212, 0.0635, 0.2, 1.0}) {
        const LampGrid grid = lamps(size_m, 0.0);
        EXPECT_EQ(grid.along, 1);
        EXPECT_LE(size_m / grid.across, spacing_m) << size_m << " m, " << grid.across << " lamps";
        if (grid.across > 1) {
            EXPECT_GT(size_m / (grid.across - 1), spacing_m)
                << size_m << " m, " << grid.across << " lamps";
        }
    }
    EXPECT_EQ(lamps(0.0635, 0.0302).across, 4);  // 63.5 mm over 20.9 mm is 3.04
    EXPECT_EQ(lamps(0.0635, 0.0302).along, 2);
}

// Irradiance of a floor point by equal lamps that shine as cos^n(theta), through water of K.
double irradiance(const std::vector<Vector3d>& lamps_m,
                  const Strobe& strobe,
                  const Vector3d& at,
                  double K_per_m) {
    const double n = strobe.beam.cones.front().exponent;
    double sum = 0.0;
    for (const Vector3d& lamp : lamps_m) {
        const Vector3d path = at - lamp;
        const double d = path.norm();
        sum += std::pow(std::max(0.0, strobe.axis.dot(path) / d), n) * (path.z() / d) / (d * d) *
               std::exp(-K_per_m * d);
    }
    return sum / static_cast<double>(lamps_m.size());
}

// Up to K d = 20, of straight, tilted and level strobes; one of 0.3 m under whose lamps it is
// not so far.
TEST(LampGrid, KeepsTheErrorThatItsHeaderStates) {
    // The error falls with the square of the spacing: this grid's own is a sixteenth of that.
    constexpr int kFiner = 4;
    const Rig rig = camera_rig();
    for (const auto& [K_per_m, exponent] : std::vector<std::pair<double, double>>{{0.0, 1.0},
                                                                                  {0.5, 1.0},
                                                                                  {2.0, 1.0},
                                                                                  {5.0, 1.0},
                                                                                  {10.5, 1.0},
                                                                                  {0.0, 0.3},
                                                                                  {0.0, 3.0},
                                                                                  {0.5, 12.0}}) {
        double nearly = 0.0;
        for (const Vector3d& axis : {Vector3d(0.0, 0.0, 1.0),
                                     Vector3d(-0.44, 0.0, 0.9),
                                     Vector3d(0.3, 0.5, 0.6),
                                     Vector3d(1.0, 0.0, 0.1)}) {
            for (const Emitter& emitter : {Emitter{.across_m = 0.0635, .along_m = 0.0302},
                                           Emitter{.across_m = 0.3, .along_m = 0.3}}) {
                Strobe strobe = strobe_with(axis.normalized(), emitter);
                strobe.beam.cones.front().exponent = exponent;
                const LampGrid grid = lamp_grid(rig, strobe, K_per_m);
                const auto lamps_m = lamp_positions_m(strobe, grid);
                const auto fine_m = lamp_positions_m(
                    strobe, {.across = kFiner * grid.across, .along = kFiner * grid.along});
                double worst = 0.0;
                for (double x_m = -2.0; x_m <= 2.0; x_m += 0.25) {
                    for (double y_m = -2.0; y_m <= 2.0; y_m += 0.25) {
                        const Vector3d at(
                            strobe.position_m.x() + x_m, strobe.position_m.y() + y_m, 2.0);
                        // Near the emitter's own plane lamps on both sides of it are an edge.
                        const Vector3d path = at - strobe.position_m;
                        if (path.dot(strobe.axis) < 0.1 * path.norm()) continue;
                        const double exact = irradiance(fine_m, strobe, at, K_per_m);
                        worst = std::max(
                            worst,
                            std::abs(irradiance(lamps_m, strobe, at, K_per_m) / exact - 1.0));
                    }
                }
                EXPECT_LT(worst, kGridError)
                    << "emitter " << emitter.across_m << " m, axis " << axis.transpose() << ", K "
                    << K_per_m << "/m, exponent " << exponent;
                EXPECT_GT(worst, 0.0) << "the grids are the same";
                nearly = std::max(nearly, worst);
            }
        }
        EXPECT_GT(nearly, 0.1 * kGridError) << "more lamps than it takes at K " << K_per_m;
    }
}

// By the height of 1.9 m, sqrt(24e-4/((n + 2) (n + 3))) of it apart: for n = 10, 7.45 mm.
TEST(LampGrid, IsFinerForBeamsThatFallMoreSteeply) {
    Strobe strobe = strobe_with({0.0, 0.0, 1.0}, Emitter{.across_m = 0.3, .along_m = 0.1});
    strobe.beam.cones.front().exponent = 10.0;
    EXPECT_EQ(lamp_grid(camera_rig(), strobe, 0.0).across, 41);  // 300 mm over 7.45 mm is 40.3
    strobe.beam.cones.front().exponent = 0.0;
    EXPECT_EQ(lamp_grid(camera_rig(), strobe, 0.0).across, 15) << "kLampSpacing, 20.9 mm";
}

// The strobe stands 1.9 m above the floor.
TEST(LampGrid, IsFinerInWaterThatAttenuatesMore) {
    const Strobe strobe = strobe_with({0.0, 0.0, 1.0}, Emitter{.across_m = 0.3, .along_m = 0.1});
    const auto across = [&](double K_per_m) {
        return lamp_grid(camera_rig(), strobe, K_per_m).across;
    };
    EXPECT_EQ(across(0.0), across(1.1 / 1.9));
    EXPECT_LT(across(1.1 / 1.9), across(2.0));
    // h falls as 1 / K in the end: the bound is K^2 alone.
    EXPECT_NEAR(across(1e3) / static_cast<double>(across(1e2)), 10.0, 0.5);
}

// --- POV-Ray's frame ------------------------------------------------------------------- --------

TEST(ToPovray, MapsForwardToYStarboardToXAndDownToZ) {
    expect_near(to_povray({1.0, 0.0, 0.0}), {0.0, 1.0, 0.0}, 0.0);
    expect_near(to_povray({0.0, 1.0, 0.0}), {1.0, 0.0, 0.0}, 0.0);
    expect_near(to_povray({0.0, 0.0, 1.0}), {0.0, 0.0, 1.0}, 0.0);
}

}  // namespace
}  // namespace aphotic::geometry_test
