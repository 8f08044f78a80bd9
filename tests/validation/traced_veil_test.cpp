// SPDX-License-Identifier: BSD-3-Clause
//
// The reference's veil against closed forms, and against light/veil.h, of which it has no line.
#include "validation/traced_veil.h"

#include "light/veil.h"
#include "spectral/phase_loader.h"
#include "support/flat.h"
#include "support/random_beam.h"
#include "support/veil_rig.h"
#include "validation/tracer.h"

#include <gtest/gtest.h>
#include <boost/math/quadrature/gauss.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace aphotic::traced_veil_test {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kDegree_rad = pi / 180.0;
constexpr double kNm = 500.0;
constexpr double kOfClosedForms = 1e-10;
// 3e-7 is measured, of a table by azimuths, at whose columns the reference does not cut. The rig's
// nodes take four times their points: with their own they are off by up to 6e-6 here.
constexpr double kOfTwoQuadratures = 1e-6;
constexpr double kFar = std::numeric_limits<double>::infinity();

VeilRay down(double length_m) {
    return {Vector3d::Zero(), Vector3d::UnitZ(), length_m};
}

double veil_of(const Rig& rig, const VeilRay& ray) {
    return TracedVeil(rig, TracedWater(rig.water)).radiance(ray, kNm);
}

}  // namespace

TEST(TracedVeil, IsThatOfTheRigsOwnNodes) {
    Dice dice(17);
    const std::vector<PhaseFunction> phases{builtin_phase("petzold"),
                                            fournier_forand(0.0183),
                                            henyey_greenstein(0.924),
                                            builtin_phase("sea-water")};
    for (int k = 0; k < 40; ++k) {
        const Vector3d position_m(
            dice.between(-0.6, 0.6), dice.between(-0.6, 0.6), dice.between(-0.2, 0.4));
        const Rig rig = one_lamp(
            position_m,
            {dice.between(-0.4, 0.4), dice.between(-0.4, 0.4), 1.0},
            random_beam_of(kBeamKinds[static_cast<std::size_t>(k) % kBeamKinds.size()], dice),
            phases[static_cast<std::size_t>(k) % phases.size()]);
        const Vector3d towards =
            Vector3d(dice.between(-0.4, 0.4), dice.between(-0.4, 0.4), 1.0).normalized();
        const double length_m = k % 5 == 0 ? kFar : dice.between(0.5, 4.0);
        const double found = veil_of(rig, {Vector3d::Zero(), towards, length_m});
        const double other =
            Veil(rig, 4 * kVeilPoints).radiance({Vector3d::Zero(), towards}, length_m, kNm);
        // Where a beam all but misses the ray, a share of what it would be.
        constexpr double kDim = 1e-6;
        EXPECT_NEAR(found, other, kOfTwoQuadratures * std::max(other, kDim)) << k;
    }
}

// What the pixel sees of a black floor is the veil before it, and of the sky the whole.
TEST(TracedVeil, IsInTheTracersPixels) {
    Rig rig = one_lamp({0.3, 0.4, 0.0}, Vector3d::UnitZ(), even_beam(0.6), henyey_greenstein(0.8));
    rig.seafloor.reflectance = flat(0.0);
    rig.seafloor.phong = 0.0;
    rig.camera.width_px = 3;
    rig.camera.height_px = 3;
    for (const double pitch_rad : {0.0, 100.0 * kDegree_rad}) {
        rig.sled.pitch_rad = pitch_rad;
        const Tracer tracer(rig, {.signals = false, .planes_nm = {kNm}});
        const std::size_t middle = 4;
        const double length_m = pitch_rad == 0.0 ? rig.sled.altitude_m : kFar;
        const std::vector<double> pixel = tracer.pixels({&middle, 1});
        EXPECT_NEAR(pixel[0] / veil_of(rig, down(length_m)), 1.0, kOfClosedForms) << pitch_rad;
    }
}

// The full spectrum is as good as it says for paths as short as they are: a lamp beside a dome of
// 15 cm is a few centimetres from where a sight enters the water, and colours that are spent over
// 18 cm, its distance to the pupil, count there. Against Gauss's rule over every wavelength.
TEST(TracedVeil, HoldsTheSpectralErrorBesideADome) {
    constexpr unsigned kPoints = 30;
    using Gauss = boost::math::quadrature::gauss<double, kPoints>;
    Rig rig =
        one_lamp({0.18, 0.0, 0.02}, Vector3d(-0.2, 0.0, 1.0), even_beam(), henyey_greenstein(0.0));
    rig.water.absorption_per_m = {"steep", {300.0, 540.0, 560.0, 900.0}, {0.2, 0.2, 200.0, 200.0}};
    rig.camera.range = {.first_nm = 535.0, .last_nm = 565.0};
    rig.camera.width_px = 3;
    rig.camera.height_px = 3;
    rig.camera.pixel_pitch_m = 0.5 * rig.camera.focal_length_m;
    rig.camera.port = {.thickness_m = 0.005, .glass = builtin_glass("bk7")};
    rig.camera.port->dome = Dome{.radius_m = 0.15};
    std::vector<const Spectrum*> curves = rig.water.curves();
    for (const Spectrum* curve : rig.camera.sensor.curves()) curves.push_back(curve);
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
    const Tracer planes(rig, {.signals = false, .planes_nm = nodes_nm});
    const Tracer tracer(rig, {});
    for (const std::size_t pixel : {1U, 4U, 7U}) {
        const std::vector<double> radiance = planes.pixels({&pixel, 1});
        const std::vector<double> found = tracer.pixels({&pixel, 1});
        for (int c = 0; c < kChannels; ++c) {
            double expected = 0.0;
            for (std::size_t i = 0; i < nodes_nm.size(); ++i) {
                expected += widths_nm[i] * rig.camera.sensor.response(c, nodes_nm[i]) * radiance[i];
            }
            EXPECT_NEAR(found[static_cast<std::size_t>(c)] / expected, 1.0, kSpectralError)
                << pixel << ", " << c;
        }
    }
}

}  // namespace aphotic::traced_veil_test
