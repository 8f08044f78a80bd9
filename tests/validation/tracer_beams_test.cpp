// SPDX-License-Identifier: BSD-3-Clause
//
// Images of every kind of beam by the reference: what a pixel has of the beam's intensity, which
// pixels are on its edges, and how many lamps stand for an emitter.
#include "rig/geometry.h"
#include "support/exact_light.h"
#include "support/random_beam.h"
#include "support/random_rig.h"
#include "validation/tracer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

namespace aphotic::tracer_beams_test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kLambda_nm = 530.0;
constexpr int kRigs = 6;
// Of the largest intensity: quadratures of flux and optics.
constexpr double kAgreement = 1e-9;

// One strobe over a bare floor, in a few pixels.
Rig rig_with(const Beam& beam, std::uint64_t seed) {
    Rig rig = with_pixels(random_rig(seed), 12, 9);
    rig.strobes.erase(rig.strobes.begin() + 1, rig.strobes.end());
    rig.strobes[0].beam = beam;
    return rig;
}

Beam random_beam_of(BeamKind kind, std::uint64_t seed) {
    Dice dice(seed);
    return aphotic::random_beam_of(kind, dice);
}

Tracer tracer_of(const Rig& rig) {
    return {rig, {.signals = false, .planes_nm = {kLambda_nm}}};
}

std::vector<double> image_of(const Rig& rig) {
    return tracer_of(rig).rows(0, rig.camera.height_px);
}

std::vector<unsigned char> edges_of(const Rig& rig) {
    return tracer_of(rig).on_edges({.first_nm = kLambda_nm, .last_nm = kLambda_nm});
}

// Light is proportional to I, so that a beam's image is that of a Lambertian lamp times I/cos.
TEST(TracerBeams, LightAPixelByTheirIntensity) {
    const Beam lambert{.name = "lambert",
                       .weights = ConeWeights::Literal,
                       .cones = {{.part = "", .half_angle_rad = 0.5 * kPi, .weight = 1.0}}};
    for (const BeamKind kind : kBeamKinds) {
        for (const std::uint64_t seed : rig_seeds(300, kRigs)) {
            const Beam beam = random_beam_of(kind, seed);
            const Rig rig = rig_with(beam, seed);
            const std::vector<double> image = image_of(rig);
            const std::vector<double> even = image_of(rig_with(lambert, seed));
            const std::vector<unsigned char> edges = edges_of(rig);
            const Strobe& strobe = rig.strobes[0];
            const BeamFrame frame = frame_about(strobe.axis);
            const double most = most_intensity(beam);
            for (std::size_t i = 0; i < image.size(); ++i) {
                const WaterRay ray = pixel_ray(rig,
                                               static_cast<double>(i % 12) + 0.5,
                                               static_cast<double>(i / 12) + 0.5,
                                               kLambda_nm);
                const auto distance_m = distance_to(floor_plane(rig.sled), ray);
                if (!distance_m || edges[i] != 0 || even[i] == 0.0) continue;
                const Eigen::Vector3d towards =
                    ray.origin_m + *distance_m * ray.direction - strobe.position_m;
                const double by_cosine = even[i] / (towards.normalized().dot(strobe.axis));
                EXPECT_NEAR(image[i],
                            by_cosine * intensity_towards(beam, frame, towards),
                            kAgreement * by_cosine * most)
                    << "kind " << static_cast<int>(kind) << ", seed " << seed << ", pixel " << i;
            }
        }
    }
}

TEST(TracerBeams, AgreeWithTheExactLight) {
    for (const BeamKind kind : kBeamKinds) {
        for (const std::uint64_t seed : rig_seeds(400, kRigs)) {
            const Rig rig = rig_with(random_beam_of(kind, seed), seed);
            const ExactLight<long double> light(rig);
            const std::vector<double> image = image_of(rig);
            const std::vector<unsigned char> edges = edges_of(rig);
            const double most = *std::ranges::max_element(image);
            for (std::size_t i = 0; i < image.size(); ++i) {
                if (edges[i] != 0) continue;
                const auto exact =
                    static_cast<double>(light.radiance(static_cast<double>(i % 12) + 0.5,
                                                       static_cast<double>(i / 12) + 0.5,
                                                       kLambda_nm));
                EXPECT_NEAR(image[i], exact, kAgreement * most)
                    << "kind " << static_cast<int>(kind) << ", seed " << seed << ", pixel " << i;
            }
        }
    }
}

// A lamp of 5 by 4 cm, 2 m over the floor, which looks where the camera does.
Rig rig_of_size(const Beam& beam) {
    Rig rig = rig_with(beam, 1);
    rig.camera.port.reset();
    rig.camera.focal_length_m = 0.006;
    rig.sled = {.altitude_m = 2.0, .pitch_rad = 0.0, .roll_rad = 0.0};
    rig.seafloor.phong = 0.0;
    rig.strobes[0].position_m = {0.1, -0.2, 0.0};
    rig.strobes[0].axis = Eigen::Vector3d(-0.05, 0.1, 1.0).normalized();
    rig.strobes[0].emitter = {.across_m = 0.05, .along_m = 0.04};
    return rig;
}

Cone soft_cone() {
    return {.part = "", .half_angle_rad = 0.5, .weight = 1.0, .exponent = 2.0, .edge_rad = 0.4};
}

// 1 + cos over the half width of a rectangle of angles, down to 0 at its sides.
BeamTable bell_table() {
    BeamTable table{
        .angles = TableAngles::TypeB, .vertical_rad = {}, .horizontal_rad = {}, .intensity = {}};
    constexpr int kHalf = 12;
    for (int i = -kHalf; i <= kHalf; ++i) {
        table.vertical_rad.push_back(2.0 * i * kDegree);
        table.horizontal_rad.push_back(3.0 * i * kDegree);
    }
    const auto bell = [](int i) { return std::max(0.0, 1.0 + std::cos(kPi * i / kHalf)); };
    for (int h = -kHalf; h <= kHalf; ++h) {
        for (int v = -kHalf; v <= kHalf; ++v) {
            const bool is_side = std::abs(h) == kHalf || std::abs(v) == kHalf;
            table.intensity.push_back(is_side ? 0.0 : bell(h) * bell(v));
        }
    }
    return table;
}

BeamOptics optics(double distance_m) {
    return {.along_m = 0.03,
            .across_m = 0.02,
            .focal_length_m = 0.05,
            .distance_m = distance_m,
            .aperture_m = 0.04};
}

Beam patterned(BeamPattern pattern) {
    return {.name = "", .cones = {}, .pattern = std::move(pattern), .turn_rad = 0.3};
}

std::vector<Beam> smooth_beams() {
    std::vector<Beam> beams{
        {.name = "", .cones = {soft_cone()}}, patterned(bell_table()), patterned(optics(0.03))};
    for (std::size_t i = 0; i < 3; ++i) {
        beams.push_back(beams[i]);
        beams.back().window = {.glass_index = 1.52, .water_index = 1.34};
    }
    return beams;
}

// Nothing is left out of the comparison of smooth beams, not even under emitters of a size.
TEST(TracerBeams, WithoutEdgesMarkNoPixel) {
    for (const Beam& beam : smooth_beams()) {
        const Rig rig = rig_of_size(beam);
        EXPECT_GT(std::ranges::max(image_of(rig)), 0.0);
        EXPECT_EQ(std::ranges::count(edges_of(rig), 1), 0);
    }
}

TEST(TracerBeams, WithEdgesMarkThePenumbra) {
    Cone sharp = soft_cone();
    sharp.edge_rad = 0.0;
    BeamTable cut = bell_table();
    cut.horizontal_rad.erase(cut.horizontal_rad.begin() + 16, cut.horizontal_rad.end());
    cut.intensity.resize(16 * cut.vertical_rad.size());
    for (const Beam& beam :
         {Beam{.name = "", .cones = {sharp}}, patterned(cut), patterned(optics(0.05))}) {
        const std::vector<unsigned char> edges = edges_of(rig_of_size(beam));
        EXPECT_GT(std::ranges::count(edges, 1), 2);
        EXPECT_LT(std::ranges::count(edges, 1), 60);
    }
}

// Twice as many lamps a side change no pixel by more than the promise, of what has a tenth of the
// most light.
TEST(TracerBeams, HaveLampsEnoughOnEmitters) {
    for (const Beam& beam : smooth_beams()) {
        const Rig rig = rig_of_size(beam);
        const Tracer tracer = tracer_of(rig);
        const EmitterLamps lamps = tracer.lamps(0);
        const std::vector<double> image = tracer.rows(0, rig.camera.height_px);
        const std::vector<double> finer = Tracer(rig,
                                                 {.signals = false,
                                                  .planes_nm = {kLambda_nm},
                                                  .lamps_across = 2 * lamps.across,
                                                  .lamps_along = 2 * lamps.along})
                                              .rows(0, rig.camera.height_px);
        const double dim = TracedBeam::kDimmest * std::ranges::max(finer);
        double worst = 0.0;
        for (std::size_t i = 0; i < image.size(); ++i) {
            worst = std::max(worst, std::abs(image[i] - finer[i]) / std::max(finer[i], dim));
        }
        EXPECT_LT(worst, kEmitterError) << lamps.across << " x " << lamps.along << " lamps";
        EXPECT_LT(lamps.across * lamps.along, 5000);
    }
}

}  // namespace
}  // namespace aphotic::tracer_beams_test
