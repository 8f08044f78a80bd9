// SPDX-License-Identifier: BSD-3-Clause
//
// The reference on its own, against answers that are not code of ours: formulas derived in the
// comments, integrals that a conservation law fixes, symmetries, limits, and numbers from
// tables. Lamps, floors and waters are flat over wavelength unless a test says otherwise.
#include "validation/tracer.h"

#include "base/error.h"
#include "scene_gen/light_paths.h"
#include "spectral/curve_loader.h"
#include "support/cast_ray.h"
#include "support/closed_form.h"
#include "support/flat.h"
#include "support/random_rig.h"
#include "support/refusal.h"
#include "support/scene_rig.h"
#include "support/simpson.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace aphotic::tracer_test {
namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr double kDegree = kPi / 180.0;
constexpr double kLambda_nm = 550.0;
// Some hundred operations on doubles.
constexpr double kRounding = 1e-13;

Beam lambertian() {
    return {.name = "lambertian",
            .weights = ConeWeights::Flux,
            .cones = {{.part = "all", .half_angle_rad = 0.5 * kPi, .weight = 1.0}}};
}

Beam cone_of(double half_angle_rad, double weight, ConeWeights weights = ConeWeights::Flux) {
    return {.name = "cone",
            .weights = weights,
            .cones = {{.part = "only", .half_angle_rad = half_angle_rad, .weight = weight}}};
}

// Flux 1, straight down.
Strobe lamp_at(const Vector3d& position_m, Beam beam = lambertian()) {
    return {.name = "lamp",
            .position_m = position_m,
            .axis = Vector3d::UnitZ(),
            .beam = std::move(beam),
            .spectrum = flat(1.0),
            .power = 1.0,
            .emitter = std::nullopt};
}

// Level, 2 m above a floor that is all white, in clear water; one Lambertian lamp at the pupil.
// Neighbouring pixels differ by `slope` in the tangent.
Rig plain_rig(int width_px = 1, int height_px = 1, double slope = 0.1) {
    return {.title = "",
            .sled = {.altitude_m = 2.0, .pitch_rad = 0.0, .roll_rad = 0.0},
            .camera = {.width_px = width_px,
                       .height_px = height_px,
                       .pixel_pitch_m = slope,
                       .focal_length_m = 1.0,
                       .range = {400.0, 700.0},
                       .sensor = Sensor({flat(1.0), flat(1.0), flat(1.0)}, ResponseKind::Energy),
                       .port = std::nullopt},
            .water = {.absorption_per_m = flat(1.0), .multiple = 0.0},
            .seafloor = {.reflectance = flat(1.0)},
            .strobes = {lamp_at(Vector3d::Zero())},
            .digest = ""};
}

Object object_of(const Shape& shape, double reflectance = 1.0) {
    return {.name = "thing", .shape = shape, .reflectance = flat(reflectance)};
}

Rig with_loss(Rig rig, double K_per_m) {
    rig.water.uniform_loss_per_m = K_per_m;
    return rig;
}

std::vector<double> image_of(const Rig& rig, const TraceOptions& options) {
    return Tracer(rig, options).rows(0, rig.camera.height_px);
}

// The radiance of every pixel at one wavelength.
std::vector<double> plane_of(const Rig& rig, double lambda_nm = kLambda_nm) {
    return image_of(rig, {.signals = false, .planes_nm = {lambda_nm}});
}

std::vector<double> plane_with_lamps(const Rig& rig, int across, int along) {
    return image_of(rig,
                    {.signals = false,
                     .planes_nm = {kLambda_nm},
                     .lamps_across = across,
                     .lamps_along = along});
}

double only_pixel(const Rig& rig, double lambda_nm = kLambda_nm) {
    return plane_of(rig, lambda_nm).at(0);
}

// Tangents of a pixel's ray: forward, starboard.
struct Slope {
    double forward;
    double starboard;
};
Slope slope_of(const Rig& rig, std::size_t pixel) {
    const auto width = static_cast<std::size_t>(rig.camera.width_px);
    const double scale = rig.camera.pixel_pitch_m / rig.camera.focal_length_m;
    const std::size_t row = pixel / width;
    const std::size_t column = pixel % width;
    return {.forward = (0.5 * rig.camera.height_px - 0.5 - static_cast<double>(row)) * scale,
            .starboard = (static_cast<double>(column) + 0.5 - 0.5 * rig.camera.width_px) * scale};
}

void expect_ratio(double found, double wanted, double tolerance, const std::string& what = "") {
    EXPECT_NEAR(found / wanted, 1.0, tolerance)
        << what << " found " << found << "; wanted " << wanted;
}

// --- Closed forms ------------------------------------------------------------------------

// Pixels at 45 degrees ahead and astern of a sled with its bow up by p, lamp at the pupil. The
// floor falls away forward: z = h + x tan p. The ray x = z meets it at z = h / (1 - tan p), the
// ray x = -z at z = h / (1 + tan p). Lamp at the pupil: L = cos i cos t / (pi^2 d^2), d = z
// sqrt 2, cos t = 1 / sqrt 2, cos i = cos(45 deg + p) ahead and cos(45 deg - p) astern.
TEST(TracerClosedForm, TiltsTheFloorAwayForwardWithTheBowUp) {
    const double pitch = 20.0 * kDegree;
    Rig rig = plain_rig(1, 3, 1.0);
    rig.sled.pitch_rad = pitch;
    const auto plane = plane_of(rig);
    const double ahead_m = 2.0 / (1.0 - std::tan(pitch));
    const double astern_m = 2.0 / (1.0 + std::tan(pitch));
    const auto L = [](double cos_i, double z_m) {
        return cos_i * std::sqrt(0.5) / (kPi * kPi * 2.0 * z_m * z_m);
    };
    expect_ratio(plane[0], L(std::cos(0.25 * kPi + pitch), ahead_m), kRounding, "ahead");
    expect_ratio(plane[2], L(std::cos(0.25 * kPi - pitch), astern_m), kRounding, "astern");
}

// The same with roll, where starboard down brings the floor nearer to starboard.
TEST(TracerClosedForm, BringsTheFloorNearerToStarboardWithStarboardDown) {
    const double roll = 20.0 * kDegree;
    Rig rig = plain_rig(3, 1, 1.0);
    rig.sled.roll_rad = roll;
    const auto plane = plane_of(rig);
    const auto L = [](double cos_i, double z_m) {
        return cos_i * std::sqrt(0.5) / (kPi * kPi * 2.0 * z_m * z_m);
    };
    expect_ratio(
        plane[0], L(std::cos(0.25 * kPi + roll), 2.0 / (1.0 - std::tan(roll))), kRounding, "port");
    expect_ratio(plane[2],
                 L(std::cos(0.25 * kPi - roll), 2.0 / (1.0 + std::tan(roll))),
                 kRounding,
                 "starboard");
}

// From Pope and Fry's table: transmission over 2 m + 2 m on the axis.
TEST(TracerClosedForm, TransmitsWhatPopeAndFryMeasuredOverTwiceTwoMetres) {
    constexpr double kHalfDigit = 0.0005;  // three are given
    Rig air = plain_rig();
    Rig water = plain_rig();
    water.water.absorption_per_m = load_curve("pope-fry-1997", CurveRole::WaterAbsorption, {});
    water.water.multiple = 1.0;
    const std::array<std::pair<double, double>, 3> expected{
        {{450.0, 0.964}, {550.0, 0.798}, {650.0, 0.257}}};
    for (const auto& [lambda_nm, transmission] : expected) {
        const double found = only_pixel(water, lambda_nm) / only_pixel(air, lambda_nm);
        EXPECT_NEAR(found, transmission, kHalfDigit) << lambda_nm << " nm";
    }
}

// A bow so high that the horizon is in view, 10 degrees ahead of the camera's axis.
TEST(TracerClosedForm, IsBlackAboveTheHorizonAndLitBelow) {
    for (const double multiple : {0.0, 1.0}) {
        Rig rig = habcam(3, 201);
        rig.sled.pitch_rad = 80.0 * kDegree;
        rig.water.multiple = multiple;
        rig.camera.pixel_pitch_m *= 0.3;
        const auto image = image_of(rig, {.signals = true, .planes_nm = {450.0}});
        constexpr std::size_t kPixels = 3UL * 201UL;
        ASSERT_EQ(image.size(), 4 * kPixels);
        for (std::size_t i = 0; i < image.size(); ++i) {
            EXPECT_TRUE(std::isfinite(image[i])) << "sample " << i;
            const bool is_sky = slope_of(rig, i % kPixels).forward >= std::tan(10.0 * kDegree);
            EXPECT_EQ(image[i] > 0.0, !is_sky) << "sample " << i;
        }
    }
}

// --- Flux --------------------------------------------------------------------------------

// The flux that a white floor catches, from its image: E = pi L, times the floor that a pixel
// covers, dA = dOmega r^2 / cos v, with dOmega = slope^2 / |ray|^3 and v the ray's angle to the
// floor's normal.
double flux_on_floor(const Rig& rig) {
    const double pitch = rig.sled.pitch_rad;
    const double roll = rig.sled.roll_rad;
    const Vector3d down(
        -std::sin(pitch), std::cos(pitch) * std::sin(roll), std::cos(pitch) * std::cos(roll));
    const auto plane = plane_of(rig);
    double flux = 0.0;
    for (std::size_t i = 0; i < plane.size(); ++i) {
        const auto [forward, starboard] = slope_of(rig, i);
        const Vector3d ray(forward, starboard, 1.0);
        const double solid_angle = std::pow(rig.camera.pixel_pitch_m / ray.norm(), 2) / ray.norm();
        const double cos_v = ray.dot(down) / ray.norm();
        const double r_m = rig.sled.altitude_m * down.z() / cos_v;
        flux += kPi * plane[i] * solid_angle * r_m * r_m / cos_v;
    }
    return flux;
}

// A sum over pixels errs where the cone's edge cuts them: of the 2 pi R pixels on a circle of R
// pixels each is wrong by a third of itself or so, either way. R is 30 and more: 2e-3.
constexpr double kCutPixels = 4e-3;

// A tilted lamp over a tilted floor, and all of the cone within the image.
Rig lit_floor(const Beam& beam) {
    Rig rig = plain_rig(500, 500, 0.0056);
    rig.sled.pitch_rad = 10.0 * kDegree;
    rig.sled.roll_rad = -15.0 * kDegree;
    rig.strobes = {lamp_at({0.2, -0.3, -0.1}, beam)};
    rig.strobes[0].axis = Vector3d(-0.1, 0.2, 1.0).normalized();
    return rig;
}

TEST(TracerFlux, OfAConeOnTheFloorIsItsWeight) {
    for (const auto& [half_angle_deg, weight] : {std::pair{10.0, 0.165}, {26.565, 0.094}}) {
        const Rig rig = lit_floor(cone_of(half_angle_deg * kDegree, weight));
        expect_ratio(flux_on_floor(rig), weight, kCutPixels, std::to_string(half_angle_deg));
    }
}

// What a Lambertian source gives a point on a parallel plane at unit distance, per pi times its
// radiance, when it is the rectangle from the point's foot to (X, Y); odd in X and Y. And, the
// other way round, the share of a Lambertian point's flux that such a rectangle catches. (The
// configuration factor of J. R. Howell's catalogue for a plane element and a parallel rectangle
// with a corner on its normal.)
double rectangle_factor(double X, double Y) {
    const double A = std::sqrt(1.0 + X * X);
    const double B = std::sqrt(1.0 + Y * Y);
    return (X / A * std::atan(Y / A) + Y / B * std::atan(X / B)) / (2.0 * kPi);
}
double rectangle_factor(double x0, double x1, double y0, double y1) {
    return rectangle_factor(x1, y1) - rectangle_factor(x0, y1) - rectangle_factor(x1, y0) +
           rectangle_factor(x0, y0);
}

// The 90 degree cone lights a floor without end; the image's share of it is known.
TEST(TracerFlux, OfALambertianLampOnARectangleIsItsConfigurationFactor) {
    constexpr double kMidpoint = 1e-5;  // (pixel / height)^2 / 24 of a second derivative of 20
    Rig rig = plain_rig(400, 300, 0.01);
    rig.strobes = {lamp_at({0.4, -0.6, -0.5})};
    // The floor that is seen: 4 m forward and aft less the lamp's place, in heights of 2.5 m.
    const double share = rectangle_factor(-3.4 / 2.5, 2.6 / 2.5, -3.4 / 2.5, 4.6 / 2.5);
    expect_ratio(flux_on_floor(rig), share, kMidpoint);
}

// A horizontal emitter of a x b in clear water is a Lambertian rectangle of exitance Phi / (a b):
// E = Phi / (a b) F, and L = E / pi. `across` lies athwartships, `along` forward.
double below_rectangle(const Rig& rig, std::size_t pixel) {
    const Strobe& strobe = rig.strobes[0];
    const double h_m = rig.sled.altitude_m - strobe.position_m.z();
    const auto [forward, starboard] = slope_of(rig, pixel);
    const double x_m = strobe.position_m.x() - forward * rig.sled.altitude_m;
    const double y_m = strobe.position_m.y() - starboard * rig.sled.altitude_m;
    const double along_m = 0.5 * strobe.emitter->along_m;
    const double across_m = 0.5 * strobe.emitter->across_m;
    const double F = rectangle_factor((x_m - along_m) / h_m,
                                      (x_m + along_m) / h_m,
                                      (y_m - across_m) / h_m,
                                      (y_m + across_m) / h_m);
    return F / (4.0 * along_m * across_m) / kPi;
}

Rig emitter_rig(double across_m, double along_m) {
    Rig rig = plain_rig(9, 7, 0.25);
    rig.strobes = {lamp_at({0.3, -0.2, -0.4})};
    rig.strobes[0].emitter = Emitter{.across_m = across_m, .along_m = along_m};
    return rig;
}

TEST(TracerEmitter, HoldsItsStatedErrorAgainstTheConfigurationFactor) {
    for (const auto& [across_m, along_m] :
         {std::pair{0.0635, 0.0302}, {0.008, 0.008}, {2.0, 0.01}, {0.3, 1.2}}) {
        const Rig rig = emitter_rig(across_m, along_m);
        const auto plane = plane_of(rig);
        for (std::size_t i = 0; i < plane.size(); ++i) {
            expect_ratio(plane[i], below_rectangle(rig, i), kEmitterError);
        }
    }
}

TEST(TracerEmitter, OfNoSizeIsAPoint) {
    Rig rig = emitter_rig(0.0, 0.0);
    const auto without_size = plane_of(rig);
    rig.strobes[0].emitter.reset();
    EXPECT_EQ(without_size, plane_of(rig));
}

// A tilted sled and strobe, absorbing water and a highlight, which no rectangle's formula covers:
// against a finer grid. For the sharpest highlight that is 1.6 times as fine each way, and so
// itself wrong by two fifths of the error.
TEST(TracerEmitter, HoldsItsStatedErrorAgainstAFineGrid) {
    for (const auto& [phong, phong_size] : {std::pair{0.0, 40.0}, {0.5, 300.0}, {3.0, 2000.0}}) {
        Rig rig = scene_rig("habcam-emitters.toml", 7, 5);
        rig.strobes = {rig.strobes[3]};
        rig.strobes[0].beam = lambertian();
        rig.sled.roll_rad = 12.0 * kDegree;
        rig.seafloor.phong = phong;
        rig.seafloor.phong_size = phong_size;
        const auto plane = plane_of(rig);
        const auto fine = plane_with_lamps(rig, 150, 75);
        for (std::size_t i = 0; i < plane.size(); ++i) {
            expect_ratio(
                plane[i], fine[i], kEmitterError, "phong_size " + std::to_string(phong_size));
        }
    }
}

// Against four times as fine a grid, whose error is a sixteenth. One HabCam emitter, its 90 degree
// cone, 2 m over the floor, up to K d = 20; and 0.5 m over a box. The grid is no finer than it must
// be: a quarter of the error is reached.
TEST(TracerEmitter, HoldsItsStatedErrorInWaterOfAnyAttenuation) {
    constexpr double kFinerGrid = 1.0 / 16.0;
    for (const bool has_object : {false, true}) {
        for (const double K_per_m : {0.0, 2.0, 5.0, 10.0}) {
            Rig rig = with_loss(scene_rig("habcam-emitters.toml", 7, 5), K_per_m);
            rig.water.multiple = 0.0;
            rig.strobes = {rig.strobes[3]};
            rig.strobes[0].beam = lambertian();
            if (has_object) {
                rig.objects = {
                    object_of(Box{.least_m = {-0.2, -0.2, 0.9}, .most_m = {0.2, 0.4, 1.1}}, 0.5)};
            }
            const TraceOptions options{.signals = true, .planes_nm = {kLambda_nm}, .threads = 2};
            const Tracer tracer(rig, options);
            const auto found = tracer.rows(0, rig.camera.height_px);
            const auto marks = tracer.on_edges(rig.camera.range);
            const EmitterLamps lamps = tracer.lamps(0);
            TraceOptions finer = options;
            finer.lamps_across = 4 * lamps.across;
            finer.lamps_along = 4 * lamps.along;
            const auto fine = image_of(rig, finer);
            double worst = 0.0;
            for (std::size_t i = 0; i < found.size(); ++i) {
                if (has_object && marks[i % marks.size()] != 0) continue;
                if (fine[i] == 0.0 && found[i] == 0.0) continue;  // in the box's shadow
                const double error = std::abs(found[i] / fine[i] - 1.0);
                EXPECT_LT(error, kEmitterError * (1.0 - kFinerGrid))
                    << "K " << K_per_m << "/m, sample " << i << (has_object ? ", object" : "");
                worst = std::max(worst, error);
            }
            EXPECT_GT(worst, 0.1 * kEmitterError) << "K " << K_per_m << "/m";
        }
    }
}

// The signals are over all wavelengths to 720 nm, where water leaves little to be seen: these ask
// for no more lamps than what is seen.
TEST(TracerEmitter, CountsAWavelengthByItsShareOfTheSignal) {
    const auto lamps_for = [](bool signals, std::vector<double> planes_nm) {
        Rig rig = scene_rig("habcam-emitters.toml", 3, 3);
        rig.water.multiple = 20.0;
        const EmitterLamps lamps =
            Tracer(rig, {.signals = signals, .planes_nm = std::move(planes_nm)}).lamps(0);
        return lamps.across * lamps.along;
    };
    EXPECT_LT(lamps_for(true, {}), lamps_for(false, {650.0}));
    EXPECT_LT(lamps_for(false, {450.0}), lamps_for(false, {650.0}));
    EXPECT_EQ(lamps_for(true, {720.0}), lamps_for(false, {450.0, 720.0}));
}

// 10 m x 10 m, a millimetre above the floor: millions of lamps each way.
TEST(TracerEmitter, TooLargeForItsHeightIsRefusedByName) {
    Rig rig = emitter_rig(10.0, 10.0);
    rig.strobes[0].name = "fore";
    rig.strobes[0].position_m.z() = 1.999;
    const std::string said = refusal_of([&] { return plane_of(rig); });
    EXPECT_NE(said.find("'fore'"), std::string::npos) << said;
}

// --- The port ------------------------------------------------------------------------------

Rig port_rig(int width_px, int height_px, double pixel_um) {
    Rig rig = plain_rig(width_px, height_px);
    rig.camera.pixel_pitch_m = pixel_um * 1e-6;
    rig.camera.focal_length_m = 0.012;
    rig.camera.port =
        PortWindow{.distance_m = 0.05, .thickness_m = 0.012, .glass = builtin_glass("bk7")};
    return rig;
}

// f = 12 mm, 6.45 um, an object far away. Cones of 5, 10, 15 and 20 degrees at the pupil draw
// circles on a floor 10 km below, where the 62 mm of air and glass are nothing; the image of a
// circle has the radius f tan(asin(n sin t)).
TEST(TracerPort, SpreadsColoursAsTheTableOfLateralColourSays) {
    constexpr int kSubpixels = 50;
    constexpr int kWidth = 2 * 1000 * kSubpixels;
    Rig rig = port_rig(kWidth, 1, 6.45 / kSubpixels);
    rig.sled.altitude_m = 10000.0;
    rig.strobes[0].beam = {.name = "circles", .weights = ConeWeights::Literal, .cones = {}};
    const std::array<double, 4> circles_deg{5.0, 10.0, 15.0, 20.0};
    for (const double t_deg : circles_deg) {
        rig.strobes[0].beam.cones.push_back(
            {.part = "circle", .half_angle_rad = t_deg * kDegree, .weight = 1.0});
    }
    const auto image = image_of(rig, {.signals = false, .planes_nm = {450.0, 650.0}});

    // Where the light falls by a quarter or more from one subpixel to the next, in pixels.
    std::array<std::vector<double>, 2> edges_px;
    for (std::size_t colour = 0; colour < 2; ++colour) {
        const double* row = image.data() + colour * kWidth;
        for (int i = kWidth / 2; i + 1 < kWidth; ++i) {
            if (row[i + 1] < 0.8 * row[i]) {
                edges_px[colour].push_back((i + 1.0 - 0.5 * kWidth) / kSubpixels);
            }
        }
        ASSERT_EQ(edges_px[colour].size(), circles_deg.size());
    }
    constexpr std::array<double, 4> kBlueLessRed_px{1.4, 2.9, 4.8, 7.5};
    constexpr double kHalfDigit_px = 0.05;
    constexpr double kSubpixel_px = 1.0 / kSubpixels;
    const std::array<double, 2> n{1.34676, 1.33853};  // Quan and Fry, 450 and 650 nm
    constexpr double kIndexDigits_px = 0.02;          // 5e-6 of n at 1000 pixels, and the port
    for (std::size_t k = 0; k < circles_deg.size(); ++k) {
        EXPECT_NEAR(
            edges_px[0][k] - edges_px[1][k], kBlueLessRed_px[k], kHalfDigit_px + 2.0 * kSubpixel_px)
            << circles_deg[k] << " degrees";
        for (std::size_t colour = 0; colour < 2; ++colour) {
            const double air = std::asin(n[colour] * std::sin(circles_deg[k] * kDegree));
            EXPECT_NEAR(
                edges_px[colour][k], 12000.0 / 6.45 * std::tan(air), kSubpixel_px + kIndexDigits_px)
                << circles_deg[k] << " degrees";
        }
    }
}

// The path of one oblique ray, by hand: 45 degrees in air, n of N-BK7 at 587.56 nm 1.51680
// (Schott), of fresh water at 20 C 1.33306 (Quan and Fry's formula by hand; handbooks have 1.3330).
// Foot of the ray: 50 mm tan 45 + 12 mm tan(glass) + 1938 mm tan(water). The lamp is at the pupil,
// so what the water takes away tells d + r, and what reaches the camera tells d.
TEST(TracerPort, BendsAnObliqueRayAtBothFaces) {
    constexpr double kDigits = 2e-5;  // of the indices, in the foot's distance
    constexpr double kHelium_nm = 587.56;
    Rig rig = port_rig(3, 1, 12000.0);
    rig.water.salinity_psu = 0.0;
    rig.water.temperature_c = 20.0;
    const double glass = std::asin(std::sqrt(0.5) / 1.51680);
    const double water = std::asin(std::sqrt(0.5) / 1.33306);
    const double foot_m = 0.05 + 0.012 * std::tan(glass) + 1.938 * std::tan(water);
    const double d_m = std::hypot(2.0, foot_m);
    const double r_m = 1.938 / std::cos(water);
    const double clear = plane_of(rig, kHelium_nm)[2];
    const double murky = plane_of(with_loss(rig, 1.0), kHelium_nm)[2];
    EXPECT_NEAR(std::log(clear / murky), d_m + r_m, 4.0 * kDigits);
    expect_ratio(clear, 4.0 / (kPi * kPi * std::pow(d_m, 4)), 4.0 * kDigits);
}

// --- Symmetry ------------------------------------------------------------------------------

// Mirrors would not see forward and starboard exchanged. A narrow lamp aimed a little forward
// and far to starboard lights the pixels there: the third row from the top of seven, and the
// last column but one of eleven.
TEST(TracerSymmetry, TopIsForwardAndRightIsStarboard) {
    Rig rig = plain_rig(11, 7, 0.1);
    rig.strobes[0].beam = cone_of(2.0 * kDegree, 1.0);
    rig.strobes[0].axis = Vector3d(0.1, 0.4, 1.0).normalized();
    const auto plane = plane_of(rig);
    for (std::size_t i = 0; i < plane.size(); ++i) {
        EXPECT_EQ(plane[i] > 0.0, i == 2 * 11 + 9) << "pixel " << i;
    }
}

// --- The highlight -----------------------------------------------------------------------

// docs/background/physics.md: 0 where r.l <= 0, whatever the exponent. Lamp low astern, camera
// looking ahead: the mirrored ray goes ahead, away from the lamp.
TEST(TracerHighlight, IsNothingOnTheSideAwayFromTheMirroredRay) {
    Rig rig = plain_rig(1, 3, 2.0);
    rig.strobes = {lamp_at({-6.0, 0.0, 1.0})};
    rig.seafloor.reflectance = flat(0.0);
    rig.seafloor.phong = 1.0;
    for (const double size : {0.0, 1.0, 40.0}) {
        rig.seafloor.phong_size = size;
        EXPECT_EQ(plane_of(rig)[0], 0.0) << "phong_size " << size;
    }
}

// --- The spectrum ----------------------------------------------------------------------------

TEST(TracerSignal, OfFlatSpectraIsRadianceTimesResponseTimesWidth) {
    Rig rig = with_loss(plain_rig(), 0.3);
    rig.camera.sensor = Sensor({flat(1.0), flat(2.0), flat(0.5)}, ResponseKind::Energy);
    const auto image = image_of(rig, {.signals = true, .planes_nm = {kLambda_nm}});
    ASSERT_EQ(image.size(), 4U);
    const double L = std::exp(-1.2) / (kPi * kPi * 4.0);
    expect_ratio(image[0], 300.0 * L, kRounding, "red");
    expect_ratio(image[1], 600.0 * L, kRounding, "green");
    expect_ratio(image[2], 150.0 * L, kRounding, "blue");
    expect_ratio(image[3], L, kRounding, "550 nm");
}

// A narrow band counts lambda / (h c) photons per joule: 1 nm about 550 nm, where a photon has
// 3.611720e-19 J.
TEST(TracerSignal, OfAQuantumResponseCountsPhotons) {
    constexpr double kDigits = 2e-7;  // of that number
    Rig rig = plain_rig();
    rig.camera.range = {549.5, 550.5};
    const double energy = image_of(rig, {})[0];
    rig.camera.sensor = Sensor({flat(1.0), flat(1.0), flat(1.0)}, ResponseKind::Quantum);
    expect_ratio(image_of(rig, {})[0], energy / 3.611720e-19, kDigits);
}

TEST(TracerSignal, ComesWithThePlanesAskedForInTheirOrder) {
    const Rig rig = habcam(3, 2);
    const Tracer both(rig, {.signals = true, .planes_nm = {650.0, 450.0}});
    const Tracer signals(rig, {.signals = true, .planes_nm = {}});
    EXPECT_EQ(both.planes(), 5U);
    EXPECT_EQ(signals.planes(), 3U);
    EXPECT_GT(signals.grid_size(), 100U);
    EXPECT_EQ(Tracer(rig, {.signals = false, .planes_nm = {450.0}}).grid_size(), 0U);
    const auto image = both.rows(0, 2);
    const auto expect_plane = [&](std::size_t plane, const std::vector<double>& alone) {
        for (std::size_t i = 0; i < 6; ++i) {
            expect_ratio(
                image[plane * 6 + i], alone[i], kRounding, "plane " + std::to_string(plane));
        }
    };
    const auto rgb = signals.rows(0, 2);
    for (std::size_t c = 0; c < 3; ++c) {
        expect_plane(c, {rgb.begin() + static_cast<std::ptrdiff_t>(6 * c), rgb.end()});
    }
    expect_plane(3, plane_of(rig, 650.0));
    expect_plane(4, plane_of(rig, 450.0));
}

// A floor that reflects in 0.2 nm only, with an area of 0.1 nm, between all other knots.
TEST(TracerSignal, KnowsTheKnotsOfTheFloor) {
    Rig rig = plain_rig();
    rig.seafloor.reflectance =
        Spectrum("peak", {300.0, 549.9, 550.0, 550.1, 800.0}, {0.0, 0.0, 1.0, 0.0, 0.0});
    const double L_nm = 0.1 / (kPi * kPi * 4.0);
    expect_ratio(image_of(rig, {})[0], L_nm, kSpectralError);
    // And its highlight at all wavelengths: with lamp and response both t, 0 to 1 over the range,
    // int t^2 is a third of it.
    const Spectrum line("line", {400.0, 700.0}, {0.0, 1.0});
    rig.strobes[0].spectrum = line;
    rig.camera.sensor = Sensor({line, line, line}, ResponseKind::Energy);
    rig.seafloor.phong = 0.5;
    expect_ratio(
        image_of(rig, {})[0], 0.25 * L_nm + 0.5 * 100.0 / (kPi * kPi * 4.0), kSpectralError);
}

double integrated(const Rig& rig, int column, int row, int channel) {
    constexpr int kPanels = 8;  // intervals are 2.5 nm and less: an error of 1e-10 and less
    double sum = 0.0;
    for (const SimpsonNode& node : simpson_nodes(rig, kPanels)) {
        sum += node.weight_nm * closed_form::radiance(rig, column, row, node.nm).radiance *
               rig.camera.sensor.response(channel, node.nm);
    }
    return sum;
}

void expect_signals_within_stated_error(const Rig& rig, double margin) {
    const auto image = image_of(rig, {});
    const auto pixels = image.size() / kChannels;
    for (std::size_t i = 0; i < pixels; ++i) {
        const int column = static_cast<int>(i) % rig.camera.width_px;
        const int row = static_cast<int>(i) / rig.camera.width_px;
        for (int c = 0; c < kChannels; ++c) {
            const double right = integrated(rig, column, row, c);
            expect_ratio(image[static_cast<std::size_t>(c) * pixels + i],
                         right,
                         kSpectralError + margin,
                         "channel " + std::to_string(c));
        }
    }
}

constexpr double kSimpsonError = 1e-9;

TEST(TracerSignal, HoldsItsStatedErrorInEveryWater) {
    for (const double multiple : {0.0, 1.0, 6.0, 20.0}) {
        Rig rig = habcam(3, 2);
        rig.water.multiple = multiple;
        expect_signals_within_stated_error(rig, kSimpsonError);
    }
}

TEST(TracerSignal, HoldsItsStatedErrorWithDifferentLampsAHighlightAndPhotons) {
    Rig rig = habcam(3, 2);
    rig.seafloor.phong = 0.5;
    rig.strobes[1].spectrum = load_curve("xenon-arc", CurveRole::LampSpectrum, {});
    rig.strobes[2].spectrum = Spectrum("led", {390.0, 455.0, 470.0, 730.0}, {0.0, 1.0, 0.1, 0.0});
    rig.camera.sensor =
        Sensor({load_curves("nikon-d5100", CurveRole::SensorResponse, {})}, ResponseKind::Quantum);
    expect_signals_within_stated_error(rig, kSimpsonError);
}

// Just below the horizon the legs are hundreds of metres long, and only blue is left.
TEST(TracerSignal, HoldsItsStatedErrorUpToTheHorizon) {
    for (const double pitch_deg : {60.0, 75.0, 80.0}) {
        Rig rig = habcam(1, 101);
        rig.sled.pitch_rad = pitch_deg * kDegree;
        // The camera's rows from 45 degrees ahead of its axis to as much behind.
        rig.camera.pixel_pitch_m = rig.camera.focal_length_m * 2.0 / 101.0;
        const auto image = image_of(rig, {});
        int lit = 0;
        for (std::size_t row = 0; row < 101; ++row) {
            const double blue = image[202 + row];
            if (blue == 0.0) continue;
            if (++lit > 4) break;
            for (int c = 0; c < kChannels; ++c) {
                expect_ratio(image[static_cast<std::size_t>(c) * 101 + row],
                             integrated(rig, 0, static_cast<int>(row), c),
                             kSpectralError + kSimpsonError,
                             "row " + std::to_string(row));
            }
        }
        EXPECT_GT(lit, 4);
    }
}

// Behind a port the geometry changes with wavelength as well, smoothly where there is no edge.
TEST(TracerSignal, HoldsItsStatedErrorBehindAPort) {
    Rig rig = scene_rig("port.toml", 3, 2);
    for (Strobe& strobe : rig.strobes) strobe.beam = lambertian();
    expect_signals_within_stated_error(rig, kSimpsonError);
}

// --- Against the tests' own formula ----------------------------------------------------------

TEST(Tracer, AgreesWithTheClosedFormOnRandomRigs) {
    constexpr double kLongChains = 1e-12;
    // A lamp so close to a cone's edge may fall on either side of it.
    constexpr double kEdge_rad = 1e-9;
    int lit = 0;
    for (const std::uint64_t seed : rig_seeds(1, 750)) {
        Dice dice(~seed);
        Rig rig = with_pixels(random_rig(seed), 5, 4);
        for (Strobe& strobe : rig.strobes) {
            if (dice.chance(0.5))
                strobe.emitter = {.across_m = dice.between(0.0, 0.1),
                                  .along_m = dice.between(0.0, 0.1)};
        }
        const double lambda_nm = dice.between(rig.camera.range.first_nm, rig.camera.range.last_nm);
        constexpr int kAcross = 3;
        constexpr int kAlong = 2;
        const auto plane = image_of(rig,
                                    {.signals = false,
                                     .planes_nm = {lambda_nm},
                                     .lamps_across = kAcross,
                                     .lamps_along = kAlong});
        for (std::size_t i = 0; i < plane.size(); ++i) {
            const auto answer = closed_form::radiance(
                rig, static_cast<int>(i) % 5, static_cast<int>(i) / 5, lambda_nm, kAcross, kAlong);
            if (answer.edge_rad < kEdge_rad) continue;
            EXPECT_NEAR(plane[i], answer.radiance, kLongChains * answer.radiance)
                << in_words(seed, rig) << ", pixel " << i;
            if (answer.radiance > 0.0) ++lit;
        }
    }
    EXPECT_GT(lit, 10000);
}

// --- Bits ----------------------------------------------------------------------------------

TEST(Tracer, ThreadsChangeNoBit) {
    for (const char* scene : {"habcam.toml", "port.toml"}) {
        const Rig rig = scene_rig(scene, 13, 11);
        TraceOptions options{.signals = true, .planes_nm = {450.0}, .threads = 1};
        const auto alone = image_of(rig, options);
        for (const int threads : {2, 3, 16}) {
            options.threads = threads;
            EXPECT_EQ(image_of(rig, options), alone) << threads << " threads";
        }
    }
}

TEST(Tracer, RowsAreTheSameInBlocksOfAnySize) {
    constexpr std::size_t kWidth = 7;
    constexpr std::size_t kHeight = 10;
    const Rig rig = habcam(kWidth, kHeight);
    const Tracer tracer(rig, {.signals = true, .planes_nm = {450.0}});
    const auto whole = tracer.rows(0, kHeight);
    for (const std::size_t block : {1U, 3U, 4U}) {
        for (std::size_t first = 0; first < kHeight; first += block) {
            const std::size_t count = std::min(block, kHeight - first);
            const auto part = tracer.rows(static_cast<int>(first), static_cast<int>(count));
            const std::size_t samples = count * kWidth;
            ASSERT_EQ(part.size(), 4 * samples);
            for (std::size_t i = 0; i < part.size(); ++i) {
                const std::size_t plane = i / samples;
                EXPECT_EQ(part[i], whole[plane * kHeight * kWidth + first * kWidth + i % samples]);
            }
        }
    }
}

// --- Edges of cones --------------------------------------------------------------------------

std::vector<unsigned char> edges_of(const Rig& rig, WavelengthRange range = {450.0, 650.0}) {
    return Tracer(rig, {.signals = false, .planes_nm = {kLambda_nm}}).on_edges(range);
}

std::size_t count_edges(const Rig& rig) {
    const auto marks = edges_of(rig);
    return static_cast<std::size_t>(std::ranges::count(marks, 1));
}

// Lamp at the pupil, straight down on a level floor: the floor point of a pixel is off the axis
// by the pixel's own angle. Of the pixels around a middle one, twelve are five pixels away from
// it: (5, 0), (3, 4), (4, 3) and their mirror images.
TEST(TracerConeEdges, AreThePixelsWhoseCentresLieOnThem) {
    Rig rig = plain_rig(21, 17, 0.1);
    rig.strobes[0].beam = cone_of(std::atan(0.5), 1.0);
    const auto marks = edges_of(rig);
    ASSERT_EQ(marks.size(), 21U * 17U);
    for (int row = 0; row < 17; ++row) {
        for (int column = 0; column < 21; ++column) {
            const bool is_five_away = (row - 8) * (row - 8) + (column - 10) * (column - 10) == 25;
            EXPECT_EQ(marks[static_cast<std::size_t>(row * 21 + column)], is_five_away ? 1 : 0)
                << "column " << column << ", row " << row;
        }
    }
}

// Through a lens, as far as POV-Ray's rays are off, and half as far again for a floor seen aslant.
TEST(TracerConeEdges, AreAsWideAsRoundingMakesThem) {
    Rig rig = plain_rig(21, 17, 0.1);
    Rig through_lens = rig;
    through_lens.camera.lens = LensModel{.focal_px = {10.0, 10.0}, .centre_px = {10.5, 8.5}};
    for (const auto& [camera, edge_rad] :
         {std::pair{&rig, kEdgeRad}, {&through_lens, 1.5 * kEdgeThroughLensRad}}) {
        for (const double side : {-1.0, 1.0}) {
            camera->strobes[0].beam = cone_of(std::atan(0.5) + side * 0.9 * edge_rad, 1.0);
            EXPECT_EQ(count_edges(*camera), 12U) << edge_rad;
            camera->strobes[0].beam = cone_of(std::atan(0.5) + side * 1.1 * edge_rad, 1.0);
            EXPECT_EQ(count_edges(*camera), 0U) << edge_rad;
        }
    }
}

TEST(TracerConeEdges, OfEveryConeAndEveryStrobeCount) {
    Rig rig = plain_rig(21, 17, 0.1);
    rig.strobes.clear();
    EXPECT_EQ(count_edges(rig), 0U);
    rig.strobes.push_back(lamp_at(Vector3d::Zero(), cone_of(std::atan(0.5), 1.0)));
    // One pixel away: 4 more.
    rig.strobes[0].beam.cones.push_back(
        {.part = "one pixel", .half_angle_rad = std::atan(0.1), .weight = 1.0});
    EXPECT_EQ(count_edges(rig), 16U);
    // Aimed at the pixel seven pixels to starboard, from above it: 12 about that one.
    rig.strobes.push_back(lamp_at({0.0, 1.4, 0.0}, cone_of(std::atan(0.3), 1.0)));
    EXPECT_EQ(count_edges(rig), 20U);
}

TEST(TracerConeEdges, AreNotWhereTheConeEndsWithItsCosine) {
    Rig rig = plain_rig(5, 5, 0.5);
    // Aimed level: the 90 degree edge goes right through the middle row.
    rig.strobes[0].axis = Vector3d::UnitX();
    EXPECT_EQ(count_edges(rig), 0U);
    rig.strobes[0].emitter = Emitter{.across_m = 0.1, .along_m = 0.1};
    EXPECT_EQ(count_edges(rig), 0U);
}

// A cone that holds no light has no edge that one could see.
TEST(TracerConeEdges, AreNotWhereTheConeHoldsNoLight) {
    Rig rig = plain_rig(21, 17, 0.1);
    rig.strobes[0].beam = cone_of(std::atan(0.5), 0.0);
    EXPECT_EQ(count_edges(rig), 0U);
}

TEST(TracerConeEdges, AreNotInTheSky) {
    Rig rig = plain_rig(21, 17, 0.1);
    rig.strobes[0].beam = cone_of(std::atan(0.5), 1.0);
    rig.sled.pitch_rad = 70.0 * kDegree;
    // The floor ends at tan 20 degrees = 3.64 pixels above the middle: of the twelve on the
    // circle, three lie 4 and 5 pixels above.
    EXPECT_EQ(count_edges(rig), 9U);
}

// Where dispersion takes the edge across a pixel's centre, one end of the range lights it and
// the other does not: as many as the formula of the tests finds.
TEST(TracerConeEdges, AreWhereDispersionTakesThemAcrossAPixel) {
    Rig rig = port_rig(121, 91, 80.0);
    rig.sled.pitch_rad = 5.0 * kDegree;
    rig.strobes = {lamp_at({0.3, 0.1, 0.0}, cone_of(12.0 * kDegree, 1.0)),
                   lamp_at({-0.2, 0.2, 0.0}, cone_of(20.0 * kDegree, 1.0))};
    const auto marks = edges_of(rig);
    int crossed = 0;
    for (std::size_t i = 0; i < marks.size(); ++i) {
        bool is_crossed = false;
        for (const Strobe& strobe : rig.strobes) {
            Rig alone = rig;
            alone.strobes = {strobe};
            const auto lit_at = [&](double lambda_nm) {
                return closed_form::radiance(
                           alone, static_cast<int>(i) % 121, static_cast<int>(i) / 121, lambda_nm)
                           .radiance > 0.0;
            };
            is_crossed = is_crossed || lit_at(450.0) != lit_at(650.0);
        }
        EXPECT_EQ(marks[i], is_crossed ? 1 : 0) << "pixel " << i;
        crossed += is_crossed ? 1 : 0;
    }
    EXPECT_GT(crossed, 20);
    EXPECT_LT(crossed, 400);
}

// A pixel that sees one point in blue and one a little farther out in red: it is marked while the
// edge is nearer to either than POV-Ray's index is exact, and anywhere between them.
TEST(TracerConeEdges, AreAsWideBehindAPortAsASinglePrecisionIndexMakesThem) {
    Rig rig = port_rig(3, 1, 2000.0);
    const auto angle_at = [&](double lambda_nm) {
        const auto ray = closed_form::camera_ray(rig, 2, 0, lambda_nm);
        const double leg_m = (2.0 - ray.origin[2]) / ray.direction[2];
        return std::atan2(ray.origin[1] + leg_m * ray.direction[1], 2.0);
    };
    const double blue = angle_at(450.0);
    const double red = angle_at(650.0);
    ASSERT_GT(red - blue, 10.0 * kEdgeBehindPortRad);
    const auto is_marked = [&](double half_angle_rad) {
        rig.strobes[0].beam = cone_of(half_angle_rad, 1.0);
        return edges_of(rig)[2] == 1;
    };
    EXPECT_FALSE(is_marked(blue - 1.1 * kEdgeBehindPortRad));
    EXPECT_TRUE(is_marked(blue - 0.9 * kEdgeBehindPortRad));
    EXPECT_TRUE(is_marked(0.5 * (blue + red)));
    EXPECT_TRUE(is_marked(red + 0.9 * kEdgeBehindPortRad));
    EXPECT_FALSE(is_marked(red + 1.1 * kEdgeBehindPortRad));
}

// An emitter's lamps lie on both sides of the edge where the pixel has some of the light that it
// would have without the edge, and not all.
TEST(TracerConeEdges, TakeInWhereverAnEmitterIsPartlyWithin) {
    Rig rig = plain_rig(121, 91, 0.01);
    rig.strobes = {lamp_at({0.2, 0.1, -0.1}, cone_of(12.0 * kDegree, 1.0, ConeWeights::Literal))};
    rig.strobes[0].axis = Vector3d(-0.1, 0.05, 1.0).normalized();
    rig.strobes[0].emitter = Emitter{.across_m = 0.1, .along_m = 0.06};
    const auto marks = edges_of(rig);
    const auto plane = plane_with_lamps(rig, 12, 8);
    rig.strobes[0].beam = cone_of(0.5 * kPi, 1.0, ConeWeights::Literal);
    const auto whole = plane_with_lamps(rig, 12, 8);
    int partly = 0;
    int marked = 0;
    for (std::size_t i = 0; i < marks.size(); ++i) {
        const double share = plane[i] / whole[i];
        const bool is_partly_lit = share > kRounding && share < 1.0 - kRounding;
        marked += marks[i];
        if (!is_partly_lit) continue;
        ++partly;
        EXPECT_EQ(marks[i], 1) << "pixel " << i << ", share " << share;
    }
    EXPECT_GT(partly, 500);
    // By the emitter's diagonal all around, where its sides would do.
    EXPECT_LT(marked, 2 * partly);
}

// Two lamps two pixels to each side of the pupil: each has a circle of its own, which twelve
// pixels' centres lie on, and the emitter between them has no penumbra.
TEST(TracerConeEdges, AreOfEachLampByItselfWhereLampsAreGiven) {
    Rig rig = plain_rig(31, 17, 0.1);
    rig.strobes[0].beam = cone_of(std::atan(0.5), 1.0);
    rig.strobes[0].emitter = Emitter{.across_m = 1.6, .along_m = 0.0};
    TraceOptions options{.signals = false, .planes_nm = {kLambda_nm}};
    options.rendered_lamps = {{.across = 2, .along = 1}};
    const Tracer tracer(rig, options);
    const auto marks = tracer.on_edges({450.0, 650.0});
    const auto is_five_from = [](int column, int row, int middle) {
        return (row - 8) * (row - 8) + (column - middle) * (column - middle) == 25;
    };
    for (int row = 0; row < 17; ++row) {
        for (int column = 0; column < 31; ++column) {
            const bool is_marked = is_five_from(column, row, 13) || is_five_from(column, row, 17);
            EXPECT_EQ(marks[static_cast<std::size_t>(row * 31 + column)], is_marked ? 1 : 0)
                << "column " << column << ", row " << row;
        }
    }
    // The same lamps as two strobes of half the power.
    Rig apart = rig;
    apart.strobes = {lamp_at({0.0, -0.4, 0.0}, cone_of(std::atan(0.5), 1.0)),
                     lamp_at({0.0, 0.4, 0.0}, cone_of(std::atan(0.5), 1.0))};
    for (Strobe& strobe : apart.strobes) strobe.power = 0.5;
    const auto plane = tracer.rows(0, 17);
    const auto expected = plane_of(apart);
    for (std::size_t i = 0; i < plane.size(); ++i) {
        EXPECT_NEAR(plane[i], expected[i], kRounding * expected[i]);
    }
}

TEST(Tracer, PixelsAreThoseOfItsRowsAndEdges) {
    const Rig rig = scene_rig("habcam-emitters.toml", 13, 11);
    const Tracer tracer(rig, {.signals = true, .planes_nm = {450.0}, .threads = 2});
    const auto whole = tracer.rows(0, 11);
    const auto marks = tracer.on_edges(rig.camera.range);
    const std::vector<std::size_t> which{142, 0, 17, 60};
    const auto some = tracer.pixels(which);
    const auto some_marks = tracer.on_edges_of(which, rig.camera.range);
    ASSERT_EQ(some.size(), 4 * which.size());
    for (std::size_t n = 0; n < which.size(); ++n) {
        EXPECT_EQ(some_marks[n], marks[which[n]]);
        for (std::size_t plane = 0; plane < 4; ++plane) {
            EXPECT_EQ(some[plane * which.size() + n], whole[plane * 143 + which[n]]);
        }
    }
}

// --- Objects --------------------------------------------------------------------------- --------

// A white ball of radius R, c below pupil and lamp. Seen at an angle a off the axis it is
// t = c cos a - sqrt(R^2 - c^2 sin^2 a) away, where light falls at i with
// cos i = (c cos a - t) / R; and the lamp is a Lambertian one, of intensity cos a / pi.
TEST(TracerObjects, ASphereBelowTheLampHasItsClosedForm) {
    Rig rig = plain_rig(41, 1, 0.01);
    const double c = 1.2;
    const double R = 0.25;
    rig.objects = {object_of(Sphere{.centre_m = {0.0, 0.0, c}, .radius_m = R}, 0.6)};
    const auto plane = plane_of(rig);
    int seen = 0;
    for (std::size_t i = 0; i < plane.size(); ++i) {
        const double a = std::atan(slope_of(rig, i).starboard);
        const double under_root = R * R - std::pow(c * std::sin(a), 2);
        if (under_root < 0.0) continue;
        ++seen;
        const double t = c * std::cos(a) - std::sqrt(under_root);
        const double cos_i = (c * std::cos(a) - t) / R;
        expect_ratio(plane[i], 0.6 / kPi * std::cos(a) / kPi * cos_i / (t * t), kRounding);
    }
    EXPECT_EQ(seen, 41) << "the whole row looks at the ball";
}

// A lamp straight above a ball: its rays touch the ball at asin(R/h) off the plumb line, h from
// lamp to centre, so the umbra on the floor H below the lamp is a disc of radius H tan(asin(R/h)).
TEST(TracerObjects, TheShadowOfASphereUnderTheLampIsADisc) {
    Rig rig = plain_rig(2001, 1, 0.001);
    rig.strobes = {lamp_at({0.0, 1.0, 0.0})};
    const double R = 0.2;
    rig.objects = {object_of(Sphere{.centre_m = {0.0, 1.0, 1.0}, .radius_m = R})};
    const double umbra_m = 2.0 * std::tan(std::asin(R / 1.0));
    const auto plane = plane_of(rig);
    int dark = 0;
    for (std::size_t i = 0; i < plane.size(); ++i) {
        const double slope = slope_of(rig, i).starboard;
        // The pupil's ray passes the ball's centre at |y - z slope| / sqrt(1 + slope^2).
        if (std::abs(1.0 - slope) / std::hypot(1.0, slope) <= R) continue;
        const double aside_m = std::abs(2.0 * slope - 1.0);
        EXPECT_EQ(plane[i] == 0.0, aside_m < umbra_m) << "slope " << slope;
        dark += plane[i] == 0.0 ? 1 : 0;
    }
    EXPECT_GT(dark, 100);
}

// A lamp in water: the top of a large box is a floor at its height.
TEST(TracerObjects, ALargeBoxIsAFloorAtItsTop) {
    Rig floor = with_loss(plain_rig(9, 7, 0.1), 0.3);
    floor.seafloor.phong = 0.4;
    floor.strobes = {lamp_at({0.2, 0.1, 0.0}, cone_of(0.5, 1.0)), lamp_at({-0.4, 0.3, 0.2})};
    Rig box = floor;
    floor.sled.altitude_m = 1.5;
    box.seafloor.reflectance = flat(0.1);
    box.seafloor.phong = 0.0;
    box.objects = {object_of(Box{.least_m = {-9.0, -9.0, 1.5}, .most_m = {9.0, 9.0, 1.7}})};
    box.objects[0].phong = 0.4;
    const auto a = plane_of(floor);
    const auto b = plane_of(box);
    for (std::size_t i = 0; i < a.size(); ++i) {
        ASSERT_GT(a[i], 0.0);
        expect_ratio(b[i], a[i], kRounding);
    }
}

// A plate, 1.5 m below pupil and lamp over a black floor, that reflects in 0.2 nm only, with an
// area of 0.1 nm, between all knots of other tables: none but the plate's own finds it. Then its
// highlight at all wavelengths, as in TracerSignal.KnowsTheKnotsOfTheFloor.
TEST(TracerObjects, TheFullSpectrumServesTheirMaterials) {
    constexpr double kDepth_m = 1.5;
    const double axial = 1.0 / (kPi * kPi * kDepth_m * kDepth_m);
    Rig rig = plain_rig();
    rig.seafloor.reflectance = flat(0.0);
    Object plate = object_of(Box{.least_m = {-0.5, -0.5, kDepth_m}, .most_m = {0.5, 0.5, 1.7}});
    plate.reflectance =
        Spectrum("peak", {300.0, 549.9, 550.0, 550.1, 800.0}, {0.0, 0.0, 1.0, 0.0, 0.0});
    rig.objects = {plate};
    expect_ratio(image_of(rig, {})[0], 0.1 * axial, kSpectralError);

    const Spectrum line("line", {400.0, 700.0}, {0.0, 1.0});
    rig.strobes[0].spectrum = line;
    rig.camera.sensor = Sensor({line, line, line}, ResponseKind::Energy);
    rig.objects[0].phong = 0.5;
    expect_ratio(image_of(rig, {})[0], (0.25 * 0.1 + 0.5 * 100.0) * axial, kSpectralError);
}

// A ball whose outline, tan 0.5 off the axis, runs through twelve pixel centres (as the cone of
// TracerConeEdges does); lamp and pupil are at one place, so that its shadow is behind it.
TEST(TracerObjectEdges, AreThePixelsOnAnOutline) {
    Rig rig = plain_rig(21, 17, 0.1);
    rig.objects = {
        object_of(Sphere{.centre_m = {0.0, 0.0, 1.0}, .radius_m = std::sin(std::atan(0.5))})};
    EXPECT_EQ(count_edges(rig), 12U);
    for (const double side : {-1.0, 1.0}) {
        // The outline, 5 pixels from the middle, moved by so many pixels.
        const auto with_outline = [&](double moved_px) {
            const double R = std::sin(std::atan(0.5 + 0.1 * side * moved_px));
            rig.objects[0].shape = Sphere{.centre_m = {0.0, 0.0, 1.0}, .radius_m = R};
            return count_edges(rig);
        };
        EXPECT_EQ(with_outline(0.7 * kEdgePx), 12U);
        EXPECT_EQ(with_outline(1.1 * kEdgePx), 0U);
    }
}

// A wall along the sled, lit from the side: its shadow ends on a line of the floor.
TEST(TracerObjectEdges, AreThePixelsOnAShadowsEdge) {
    Rig rig = plain_rig(21, 5, 0.1);
    rig.strobes = {lamp_at({0.0, 1.0, 0.0})};
    // From the lamp, 1 m to starboard, past the far edge of the wall's top, half way down below the
    // pupil, to the floor 1 m to port: slope -0.5, five columns left of the middle.
    const Box wall{.least_m = {-9.0, 0.0, 1.0}, .most_m = {9.0, 0.001, 1.5}};
    rig.objects = {object_of(wall)};
    const auto marks = edges_of(rig);
    for (std::size_t row = 0; row < 5; ++row) {
        EXPECT_EQ(marks[row * 21 + 5], 1) << row;
        EXPECT_EQ(marks[row * 21 + 4], 0) << row;
        EXPECT_EQ(marks[row * 21 + 6], 0) << row;
    }
}

// A plate half a millimetre over the floor: where its shadow falls, POV-Ray has none.
TEST(TracerObjectEdges, AreWhereABlockerIsTooNearForPovRay) {
    Rig rig = plain_rig(21, 5, 0.001);
    rig.strobes = {lamp_at({0.0, -1.9, 0.1})};
    const auto plate_at = [](double height_m) {
        return object_of(Box{.least_m = {-9.0, -9.0, 2.0 - height_m - 1e-5},
                             .most_m = {9.0, -0.0001, 2.0 - height_m}});
    };
    rig.objects = {plate_at(0.0004)};
    // Its shadow reaches 0.4 mm farther; the pixel to starboard of the middle sees 0 mm, the next
    // one 2 mm.
    EXPECT_EQ(edges_of(rig)[2 * 21 + 10], 1);
    EXPECT_EQ(edges_of(rig)[2 * 21 + 11], 0);
    EXPECT_EQ(plane_of(rig)[2 * 21 + 10], 0.0);
    // Five millimetres up, it is a shadow as any other.
    rig.objects = {plate_at(0.005)};
    EXPECT_EQ(edges_of(rig)[2 * 21 + 11], 0);
    EXPECT_EQ(plane_of(rig)[2 * 21 + 11], 0.0);
}

TEST(TracerObjectEdges, AllowWhatThePlanDoes) {
    EXPECT_EQ(kSteepest, kObjectTilt);
}

// A tilted floor, a ball and a block, whose rays are solved by hand.
TEST(Tracer, SeesWhatARayMeetsFirst) {
    Rig rig = plain_rig(40, 30, 0.03);
    rig.sled = {.altitude_m = 2.0, .pitch_rad = 0.3, .roll_rad = -0.2};
    const CastScene scene{
        .up = {std::sin(0.3), -std::cos(0.3) * std::sin(-0.2), -std::cos(0.3) * std::cos(-0.2)},
        .height_m = -2.0 * std::cos(0.3) * std::cos(-0.2),
        .ball = {.centre_m = {0.2, 0.3, 1.5}, .radius_m = 0.2},
        .block = {.least_m = {-0.5, -0.6, 1.2}, .most_m = {-0.1, -0.2, 1.6}}};
    rig.objects = {{.name = "ball", .shape = scene.ball, .reflectance = flat(1.0)},
                   {.name = "block", .shape = scene.block, .reflectance = flat(1.0)}};
    const Tracer tracer(rig, {.signals = false, .planes_nm = {}});
    std::array<int, 3> pixels{};
    for (int row = 0; row < 30; ++row) {
        for (int column = 0; column < 40; ++column) {
            const Vector3d along((14.5 - row) * 0.03, (column - 19.5) * 0.03, 1.0);
            const CastHit hit = cast_ray(scene, Vector3d::Zero(), along);
            const auto seen = tracer.seen(column + 0.5, row + 0.5, kLambda_nm);
            ASSERT_TRUE(seen);
            EXPECT_LT((seen->point_m - hit.way * along).norm(), kRounding) << column << ' ' << row;
            EXPECT_LT((seen->normal - hit.normal).norm(), 1e2 * kRounding) << column << ' ' << row;
            ++pixels.at(seen->surface);
        }
    }
    for (const int some : pixels) EXPECT_GT(some, 20) << "all are in view";
    rig.sled.pitch_rad = 1.5;  // the floor falls away ahead, up the image
    rig.objects.clear();
    const Tracer over_horizon(rig, {.signals = false, .planes_nm = {}});
    EXPECT_FALSE(over_horizon.seen(20.5, 0.5, kLambda_nm));
    EXPECT_TRUE(over_horizon.seen(20.5, 29.5, kLambda_nm));
}

}  // namespace
}  // namespace aphotic::tracer_test
