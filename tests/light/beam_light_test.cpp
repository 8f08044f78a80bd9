// SPDX-License-Identifier: BSD-3-Clause
//
// Maps of every kind of beam against plain sums over lamps, pixel by pixel, of the closed form of
// physics.md in water of one K, with rig/beam's intensity and rig/geometry's rays.
#include "light/beam_light.h"

#include "light/floor_image.h"
#include "lightmap/cone_edge.h"
#include "lightmap/lightmap.h"
#include "rig/geometry.h"
#include "support/cones_seen.h"
#include "support/effort.h"
#include "support/scene_rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

namespace aphotic::beam_light_test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kLoss_per_m = 0.3;
// What the maps' tables are asked for, and the rounding of a sum of a dozen floats, twice: the
// closed form has its unit from a map too.
constexpr double kError = 2.0 * (4e-6 + 12.0 * 0x1p-24) + kTileError;

// One K and, behind a port, all but one index.
Rig plain_rig(int width_px, int height_px) {
    Rig rig = habcam(width_px, height_px);
    rig.camera.range = {549.995, 550.005};
    rig.water.multiple = 0.0;
    rig.water.uniform_loss_per_m = kLoss_per_m;
    rig.sled = {.altitude_m = 1.7, .pitch_rad = 6.0 * kDegree, .roll_rad = -9.0 * kDegree};
    return rig;
}

// Light of a point of the floor, per unit of what the camera makes of it.
double light_at(const Strobe& strobe,
                const std::vector<Eigen::Vector3d>& positions_m,
                const Plane& floor,
                const WaterRay& ray) {
    const auto leg_m = distance_to(floor, ray);
    if (!leg_m) return 0.0;
    const Eigen::Vector3d point_m = ray.origin_m + *leg_m * ray.direction;
    const BeamFrame frame = frame_about(strobe.axis);
    double sum = 0.0;
    for (const Eigen::Vector3d& position_m : positions_m) {
        const Eigen::Vector3d way_m = point_m - position_m;
        const double d_m = way_m.norm();
        sum += intensity_towards(strobe.beam, frame, way_m) * -floor.normal.dot(way_m) /
               (std::numbers::pi * d_m * d_m * d_m) * std::exp(-kLoss_per_m * (d_m + *leg_m));
    }
    return strobe.power * sum / static_cast<double>(positions_m.size());
}

std::vector<double> lights_of(const Rig& rig) {
    const Plane floor = floor_plane(rig.sled);
    const double lambda_nm = std::midpoint(rig.camera.range.first_nm, rig.camera.range.last_nm);
    std::vector<std::vector<Eigen::Vector3d>> positions_m;
    for (const Strobe& strobe : rig.strobes) {
        positions_m.push_back(lamp_positions_m(strobe, lamp_grid(rig, strobe, 0.0)));
    }
    std::vector<double> lights;
    for (int row = 0; row < rig.camera.height_px; ++row) {
        for (int column = 0; column < rig.camera.width_px; ++column) {
            const WaterRay ray = pixel_ray(rig, column + 0.5, row + 0.5, lambda_nm);
            double sum = 0.0;
            for (std::size_t s = 0; s < rig.strobes.size(); ++s) {
                sum += light_at(rig.strobes[s], positions_m[s], floor, ray);
            }
            lights.push_back(sum);
        }
    }
    return lights;
}

std::vector<float> green_of(const Rig& rig) {
    const Lightmap map =
        LightmapMaker(rig, std::nullopt, {.error = 4e-6, .threads = 1}).map(rig.sled);
    const auto plane = static_cast<std::ptrdiff_t>(map.samples.size() / kChannels);
    return {map.samples.begin() + plane, map.samples.begin() + 2 * plane};
}

// What a signal of one light is: of the rig's cones, whose maps the reference holds.
double unit_of(const Rig& rig) {
    Rig cones = rig;
    cones.camera.width_px = cones.camera.height_px = 1;
    for (Strobe& strobe : cones.strobes) {
        strobe.beam = {};
        strobe.beam.cones = {{.part = "", .half_angle_rad = 90.0 * kDegree, .weight = 1.0}};
        strobe.emitter = std::nullopt;
    }
    return green_of(cones).front() / lights_of(cones).front();
}

void expect_light(const Rig& rig, const std::string& what) {
    const std::vector<float> found = green_of(rig);
    const std::vector<double> lights = lights_of(rig);
    const double unit = unit_of(rig);
    const double brightest = *std::ranges::max_element(lights);
    double worst = 0.0;
    std::size_t worst_at = 0;
    int lit = 0;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const double expected = unit * lights[i];
        const double off = std::abs(found[i] - expected);
        lit += lights[i] > 0.0 ? 1 : 0;
        if (off <= kDarkShare * unit * brightest) continue;
        if (off / expected > worst) worst = off / expected, worst_at = i;
    }
    testing::Test::RecordProperty(what, std::to_string(worst));
    EXPECT_LE(worst, kError) << what << ": pixel " << worst_at << ": found " << found[worst_at]
                             << ", expected " << unit * lights[worst_at];
    EXPECT_GT(lit, static_cast<int>(lights.size()) / 20) << what;
}

// On few pixels a block spans the image, on many a small part of it.
void expect_everywhere(const Beam& beam, const std::string& what) {
    const auto with_beam = [&](Rig rig) {
        for (Strobe& strobe : rig.strobes) strobe.beam = beam;
        return rig;
    };
    expect_light(with_beam(plain_rig(96, cases(24))), what);
    Rig fine = plain_rig(1360, cases(3));
    expect_light(with_beam(fine), what + ", many pixels");
    Rig behind_port = plain_rig(64, cases(16));
    behind_port.camera.port = {
        .distance_m = 0.02, .thickness_m = 0.01, .glass = builtin_glass("bk7")};
    expect_light(with_beam(behind_port), what + ", behind a port");
    Rig of_size = plain_rig(32, cases(8));
    of_size.strobes.erase(of_size.strobes.begin() + 2, of_size.strobes.end());
    for (Strobe& strobe : of_size.strobes) strobe.emitter = {.across_m = 0.0635, .along_m = 0.0302};
    expect_light(with_beam(of_size), what + ", of a size");
}

void expect_in_water_and_air(Beam beam, const std::string& what) {
    expect_everywhere(beam, what);
    beam.window = BeamWindow{.glass_index = 1.52, .water_index = 1.34};
    beam.turn_rad = 0.7;
    expect_everywhere(beam, what + ", behind a window, turned");
}

Beam of_pattern(BeamPattern pattern) {
    return scaled_to_flux({.name = "pattern", .cones = {}, .pattern = std::move(pattern)});
}

// Whole numbers that look random: kinks at every node.
std::vector<double> kinked(std::size_t planes, std::size_t rows, bool closes) {
    std::vector<double> values;
    for (std::size_t h = 0; h < planes; ++h) {
        const std::size_t plane = closes && h + 1 == planes ? 0 : h;
        for (std::size_t v = 0; v < rows; ++v) {
            values.push_back(3.0 + static_cast<double>((plane * 7919 + v * 104729) % 11));
        }
    }
    if (closes) {
        // One value where all planes meet.
        for (std::size_t h = 0; h < planes; ++h) values[h * rows] = values[0];
    }
    return values;
}

std::vector<double> even(double first_deg, double last_deg, std::size_t count) {
    std::vector<double> nodes;
    for (std::size_t i = 0; i < count; ++i) {
        const double share = static_cast<double>(i) / static_cast<double>(count - 1);
        nodes.push_back((first_deg + share * (last_deg - first_deg)) * kDegree);
    }
    return nodes;
}

TEST(BeamLight, IsThePlainSumForSoftCones) {
    Beam beam{.name = "soft",
              .cones = {{.part = "a", .half_angle_rad = 12.0 * kDegree, .weight = 0.2},
                        {.part = "b", .half_angle_rad = 27.0 * kDegree, .weight = 0.3},
                        {.part = "c", .half_angle_rad = 80.0 * kDegree, .weight = 0.5}}};
    for (Cone& cone : beam.cones) cone.edge_rad = 0.6 * cone.half_angle_rad;
    expect_in_water_and_air(beam, "soft");
    beam.cones[1].exponent = 4.0;
    beam.cones[2].exponent = 0.7;
    beam.cones[2].half_angle_rad = 90.0 * kDegree;
    expect_in_water_and_air(beam, "soft, other powers");
    beam.cones[1].edge_rad = beam.cones[2].edge_rad = 0.0;
    expect_in_water_and_air(beam, "soft and sharp");
}

TEST(BeamLight, IsThePlainSumForDataSheets) {
    for (const double fwhm_deg : {8.0, 60.0, 100.0, 150.0}) {
        const double n = std::log(0.5) / std::log(std::cos(0.5 * fwhm_deg * kDegree));
        const Beam beam{
            .name = "sheet",
            .cones = {
                {.part = "", .half_angle_rad = 90.0 * kDegree, .weight = 1.0, .exponent = n}}};
        expect_in_water_and_air(beam, "fwhm " + std::to_string(fwhm_deg));
    }
}

TEST(BeamLight, IsThePlainSumForTablesWithKinks) {
    expect_in_water_and_air(of_pattern(BeamTable{.angles = TableAngles::TypeC,
                                                 .vertical_rad = even(0.0, 90.0, 91),
                                                 .horizontal_rad = even(0.0, 360.0, 73),
                                                 .intensity = kinked(73, 91, true)}),
                            "type C");
    expect_in_water_and_air(of_pattern(BeamTable{.angles = TableAngles::TypeC,
                                                 .vertical_rad = even(0.0, 180.0, 181),
                                                 .horizontal_rad = {0.0},
                                                 .intensity = kinked(1, 181, false)}),
                            "type C, the same all about");
    // Nodes of uneven steps, and an end that is a step.
    std::vector<double> uneven{0.0, 0.013, 2.0, 2.7, 5.0, 11.0, 19.0, 19.5, 31.0};
    for (double& angle : uneven) angle *= kDegree;
    expect_in_water_and_air(of_pattern(BeamTable{.angles = TableAngles::TypeC,
                                                 .vertical_rad = uneven,
                                                 .horizontal_rad = even(0.0, 360.0, 13),
                                                 .intensity = kinked(13, 9, true)}),
                            "type C, uneven");
    for (const TableAngles angles : {TableAngles::TypeA, TableAngles::TypeB}) {
        expect_in_water_and_air(of_pattern(BeamTable{.angles = angles,
                                                     .vertical_rad = even(-50.0, 40.0, 46),
                                                     .horizontal_rad = even(-25.0, 35.0, 31),
                                                     .intensity = kinked(31, 46, false)}),
                                angles == TableAngles::TypeA ? "type A" : "type B");
    }
}

TEST(BeamLight, IsThePlainSumForOptics) {
    const BeamOptics blurred{.along_m = 0.0635,
                             .across_m = 0.0302,
                             .focal_length_m = 0.065,
                             .distance_m = 0.045,
                             .aperture_m = 0.06};
    expect_in_water_and_air(of_pattern(blurred), "optics");
    BeamOptics small = blurred;
    small.along_m = small.across_m = 0.004;
    expect_in_water_and_air(of_pattern(small), "optics of a small diffuser");
    BeamOptics sharp = blurred;
    sharp.distance_m = sharp.focal_length_m;
    expect_in_water_and_air(of_pattern(sharp), "optics in focus");
}

// A pixel within a sharp image or a table's rectangle, and its neighbour that is not.
TEST(BeamLight, MarksTheEdgesOfRimsAndWindows) {
    Rig rig = plain_rig(160, 120);
    rig.strobes.erase(rig.strobes.begin() + 1, rig.strobes.end());
    Strobe& strobe = rig.strobes.front();
    const auto expect_marks = [&](const Beam& beam, bool has_any) {
        strobe.beam = beam;
        const std::vector<std::uint8_t> mask = ConeEdges(rig).mask(rig.sled, 1);
        const std::vector<double> numbers = cones_seen(rig);
        const std::vector<double> lights = lights_of(rig);
        int steps = 0;
        for (std::size_t i = 0; i < lights.size(); ++i) {
            if (i % 160 == 0) continue;
            const bool is_step = (lights[i] > 0.0) != (lights[i - 1] > 0.0);
            EXPECT_EQ(is_step && has_any, numbers[i] != numbers[i - 1]) << i;
            if (is_step && has_any) {
                EXPECT_TRUE(mask[i] == 1 && mask[i - 1] == 1) << i;
            }
            steps += is_step ? 1 : 0;
        }
        EXPECT_GT(steps, 10);
        EXPECT_EQ(std::ranges::count(mask, 1) > 0, has_any);
    };
    const BeamOptics sharp{.along_m = 0.02,
                           .across_m = 0.012,
                           .focal_length_m = 0.065,
                           .distance_m = 0.065,
                           .aperture_m = 0.06};
    Beam image = of_pattern(sharp);
    image.turn_rad = 0.4;
    expect_marks(image, true);
    image.window = BeamWindow{};
    expect_marks(image, true);
    expect_marks(of_pattern(BeamTable{.angles = TableAngles::TypeB,
                                      .vertical_rad = even(-9.0, 6.0, 4),
                                      .horizontal_rad = even(-8.0, 11.0, 4),
                                      .intensity = kinked(4, 4, false)}),
                 true);
    Beam soft{.name = "soft",
              .cones = {{.part = "a", .half_angle_rad = 12.0 * kDegree, .weight = 1.0}}};
    expect_marks(soft, true);
    soft.cones[0].edge_rad = 3.0 * kDegree;
    expect_marks(soft, false);
}

}  // namespace
}  // namespace aphotic::beam_light_test
