// SPDX-License-Identifier: BSD-3-Clause
//
// Maps behind ports, where every wavelength has its own ray, against the reference tracer: beams
// with kinks and steep edges, ports of every kind. The printed figure must hold at every pixel off
// the beams' edges.
#include "light/floor_light.h"

#include "base/error.h"
#include "light/path_range.h"
#include "lightmap/lightmap.h"
#include "support/effort.h"
#include "support/random_beam.h"
#include "support/random_camera.h"
#include "support/scene_rig.h"
#include "validation/tracer.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <boost/math/quadrature/gauss.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace aphotic::floor_light_test {
namespace {

// Three lines of 2 nm: in light of one wavelength no neighbour evens out what a kink does.
Sensor line_sensor() {
    std::vector<Spectrum> responses;
    for (const double line_nm : {650.0, 550.0, 450.0}) {
        responses.emplace_back(
            fmt::format("line at {} nm", line_nm),
            std::vector<double>{400.0, line_nm - 1.0, line_nm, line_nm + 1.0, 720.0},
            std::vector<double>{0.0, 0.0, 1.0, 0.0, 0.0});
    }
    return {std::move(responses), ResponseKind::Energy};
}

// The tracer's own grid is for light that is smooth over wavelengths. Gauss's rule between all
// knots holds what a kink makes of it.
std::vector<double> by_every_wavelength(const Rig& rig, std::size_t pixel) {
    constexpr unsigned kPoints = 20;
    using Gauss = boost::math::quadrature::gauss<double, kPoints>;
    std::vector<const Spectrum*> curves = rig.camera.sensor.curves();
    for (const Spectrum* curve : rig.water.curves()) curves.push_back(curve);
    for (const Strobe& strobe : rig.strobes) curves.push_back(&strobe.spectrum);
    curves.push_back(&rig.seafloor.reflectance);
    const std::vector<double> knots_nm = union_of_knots(curves, rig.camera.range);
    std::vector<double> nodes_nm;
    std::vector<double> widths_nm;
    for (std::size_t k = 0; k + 1 < knots_nm.size(); ++k) {
        const double half_nm = 0.5 * (knots_nm[k + 1] - knots_nm[k]);
        for (const double sign : {-1.0, 1.0}) {
            for (std::size_t i = 0; i < Gauss::abscissa().size(); ++i) {
                nodes_nm.push_back(knots_nm[k] + half_nm * (1.0 + sign * Gauss::abscissa()[i]));
                widths_nm.push_back(half_nm * Gauss::weights()[i]);
            }
        }
    }
    const std::vector<double> radiance =
        Tracer(rig, {.signals = false, .planes_nm = nodes_nm}).pixels({&pixel, 1});
    std::vector<double> signals(kChannels, 0.0);
    for (std::size_t i = 0; i < nodes_nm.size(); ++i) {
        for (int c = 0; c < kChannels; ++c) {
            signals[static_cast<std::size_t>(c)] +=
                widths_nm[i] * rig.camera.sensor.response(c, nodes_nm[i]) * radiance[i];
        }
    }
    return signals;
}

struct Worst {
    double of_promise = 0.0;  // error / what is printed
    std::size_t sample = 0;
    int compared = 0;
};

Worst worst_off_edges(const Rig& rig) {
    const LightmapOptions options;
    const double promise = map_promise(rig, options).error + kSpectralError;
    const std::vector<float> found =
        signal_of(LightmapMaker(rig, std::nullopt, options).map(rig.sled));
    const Tracer tracer(rig, {});
    const std::vector<double> expected = tracer.rows(0, rig.camera.height_px);
    const std::vector<unsigned char> edges = tracer.on_edges(rig.camera.range);
    const std::size_t plane = edges.size();
    Worst worst;
    for (std::size_t c = 0; c < kChannels; ++c) {
        const auto first = expected.begin() + static_cast<std::ptrdiff_t>(c * plane);
        const double brightest =
            *std::max_element(first, first + static_cast<std::ptrdiff_t>(plane));
        for (std::size_t i = 0; i < plane; ++i) {
            const std::size_t k = c * plane + i;
            const auto off = [&](double light) { return std::abs(found[k] - light); };
            if (edges[i] != 0 || off(expected[k]) <= kDarkShare * brightest) continue;
            ++worst.compared;
            double ratio = off(expected[k]) / expected[k] / promise;
            if (ratio > 0.5) {
                const double exact = by_every_wavelength(rig, i)[c];
                ratio = off(exact) / exact / promise;
            }
            if (ratio > worst.of_promise) {
                worst.of_promise = ratio;
                worst.sample = k;
            }
        }
    }
    return worst;
}

// Sleds with one to four strobes of any beam, whose camera sees by colours or by lines.
Rig random_port_rig(std::uint64_t seed) {
    Dice dice(seed);
    Rig rig = habcam(40, 30);
    rig.sled = {.altitude_m = dice.over_octaves(0.6, 6.0),
                .pitch_rad = dice.between(-15.0, 15.0) * kDegree,
                .roll_rad = dice.between(-15.0, 15.0) * kDegree};
    rig.camera.pixel_pitch_m *= dice.between(0.5, 2.5);
    rig.water.multiple = dice.between(0.0, 3.0);
    if (dice.chance(0.5)) rig.camera.sensor = line_sensor();
    if (dice.chance(0.2)) {
        rig.seafloor.phong = dice.between(0.05, 1.0);
        rig.seafloor.phong_size = dice.over_octaves(4.0, 200.0);
    }
    rig.strobes.erase(rig.strobes.begin() + dice.whole(1, 4), rig.strobes.end());
    for (Strobe& strobe : rig.strobes) {
        strobe.position_m = {
            dice.between(-0.7, 0.7), dice.between(-0.7, 0.7), dice.between(-0.3, 0.1)};
        strobe.axis =
            Eigen::Vector3d(dice.between(-0.6, 0.6), dice.between(-0.6, 0.6), 1.0).normalized();
        strobe.power = dice.between(0.1, 3.0);
        strobe.beam = random_beam_of(kBeamKinds.at(dice.index_in(kBeamKinds)), dice);
    }
    give_port(kPortKinds.at(seed % kPortKinds.size()), dice, rig.camera);
    if (dice.chance(0.3)) give_lens(kLensKinds.at(dice.index_in(kLensKinds)), dice, rig.camera);
    if (dice.chance(0.3)) give_vignetting(dice.index_in(kLensKinds), dice, rig.camera);
    // A lens whose formula ends between the points at which it is asked is refused as a rig.
    try {
        static_cast<void>(path_range(rig));
    } catch (const InputError&) {
        rig.camera.lens.reset();
    }
    return rig;
}

TEST(PortLight, IsWithinThePrintedFigureForRandomBeamsAndPorts) {
    const int count = campaign(12, 300);
    double worst = 0.0;
    for (int i = 0; i < count; ++i) {
        const std::uint64_t seed = 4000 + static_cast<std::uint64_t>(i);
        const Rig rig = random_port_rig(seed);
        const Worst found = worst_off_edges(rig);
        worst = std::max(worst, found.of_promise);
        EXPECT_LE(found.of_promise, 1.0) << "seed " << seed << ", sample " << found.sample << " of "
                                         << rig.camera.width_px << " x " << rig.camera.height_px;
    }
    fmt::print("worst error over the printed figure, of {} rigs: {:.3f}\n", count, worst);
    RecordProperty("worst", std::to_string(worst));
}

// Rows of a table 5 degrees apart, of the smooth cos^4 that a maker's file would have, and steep
// ones, as no maker's has; a soft edge that is narrower than dispersion.
TEST(PortLight, FollowsKinksThatLieBetweenTheWatersIndices) {
    Beam smooth{.name = "smooth", .cones = {}};
    Beam steep{.name = "steep", .cones = {}};
    BeamTable rows{
        .angles = TableAngles::TypeC, .vertical_rad = {}, .horizontal_rad = {0.0}, .intensity = {}};
    BeamTable zigzag = rows;
    for (double theta_deg = 0.0; theta_deg <= 90.0; theta_deg += 5.0) {
        rows.vertical_rad.push_back(theta_deg * kDegree);
        rows.intensity.push_back(std::pow(std::cos(theta_deg * kDegree), 4));
        zigzag.vertical_rad.push_back(theta_deg * kDegree);
        zigzag.intensity.push_back(zigzag.intensity.size() % 2 == 0 ? 1.0 : 0.3);
    }
    rows.intensity.back() = 0.0;
    smooth.pattern = rows;
    steep.pattern = zigzag;
    const Beam soft{
        .name = "soft",
        .cones = {{.part = "all", .half_angle_rad = 0.5 * std::numbers::pi, .weight = 0.5},
                  {.part = "soft",
                   .half_angle_rad = 20.0 * kDegree,
                   .weight = 0.5,
                   .edge_rad = 0.1 * kDegree}}};
    for (const Beam& beam : {smooth, steep, soft}) {
        for (const PortKind kind : kPortKinds) {
            Dice dice(5);
            Rig rig = habcam(pixels(136), pixels(102));
            rig.camera.sensor = line_sensor();
            rig.strobes.erase(rig.strobes.begin() + 2, rig.strobes.end());
            for (Strobe& strobe : rig.strobes) strobe.beam = scaled_to_flux(beam);
            give_port(kind, dice, rig.camera);
            const Worst found = worst_off_edges(rig);
            EXPECT_LE(found.of_promise, 1.0)
                << beam.name << ", port " << static_cast<int>(kind) << ", sample " << found.sample;
            EXPECT_GT(found.compared, 1000);
        }
    }
}

TEST(PortLight, IsTheSameToTheBitForAnyThreads) {
    const Rig rig = random_port_rig(4007);
    const Lightmap whole = LightmapMaker(rig, std::nullopt, {.threads = 1}).map(rig.sled);
    EXPECT_EQ(LightmapMaker(rig, std::nullopt, {.threads = 3}).map(rig.sled).samples,
              whole.samples);
}

}  // namespace
}  // namespace aphotic::floor_light_test
