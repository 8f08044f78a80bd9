// SPDX-License-Identifier: BSD-3-Clause
//
// The veil at many wavelengths at once against the veil of each by itself, whose points are its
// own.
#include "validation/veil_spectrum.h"

#include "support/flat.h"
#include "support/random_rig.h"
#include "support/veil_rig.h"
#include "validation/tracer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace aphotic::veil_spectrum_test {
namespace {

// The integral's own tolerance on both sides, for panels settle by themselves, and the rays'.
constexpr double kBound = 4.0 * kVeilTolerance + kVeilOverRays;
// Where the fifteen points of a panel miss a row of a table both agree wrongly: at single
// wavelengths the direct integral is up to 9e-8 beside its neighbours, which the polynomial is not.
constexpr double kOfMissedRows = 2e-7;
constexpr double kMissed = 0.02;  // of all wavelengths
constexpr int kWavelengths = 80;

std::vector<double> wavelengths_of(const Rig& rig) {
    std::vector<double> lambda_nm;
    const WavelengthRange range = rig.camera.range;
    for (int j = 0; j < kWavelengths; ++j)
        lambda_nm.push_back(std::lerp(range.first_nm, range.last_nm, j / (kWavelengths - 1.0)));
    return lambda_nm;
}

}  // namespace

TEST(VeilSpectrum, IsThatOfEachWavelengthBehindAnyPort) {
    int judged = 0;
    int ports = 0;
    int within = 0;
    int compared = 0;
    for (unsigned seed = 0; seed < 40; ++seed) {
        const Rig rig = random_extended_rig(seed);
        const TracedWater water(rig.water);
        if (!water.scatters()) continue;
        const std::vector<double> lambda_nm = wavelengths_of(rig);
        const Tracer tracer(rig, {.signals = false, .planes_nm = lambda_nm});
        const TracedVeil one(rig, water);
        const VeilSpectrum all(rig, water, lambda_nm);
        for (const double at : {0.1, 0.5, 0.9}) {
            std::vector<VeilRay> rays;
            for (const double nm : lambda_nm) {
                const auto ray =
                    tracer.ray(at * rig.camera.width_px, (1.0 - at) * rig.camera.height_px, nm);
                if (ray) rays.push_back(*ray);
            }
            if (rays.size() < lambda_nm.size()) continue;
            const Eigen::ArrayXd found = all.along([&](std::size_t j) { return rays[j]; });
            const Eigen::ArrayXd of_first = all.along(rays.front());
            for (std::size_t j = 0; j < lambda_nm.size(); j += 7) {
                const auto n = static_cast<Eigen::Index>(j);
                const double expected = one.radiance(rays[j], lambda_nm[j]);
                EXPECT_NEAR(found(n), expected, kOfMissedRows * expected) << seed << ", " << at;
                const double first = one.radiance(rays.front(), lambda_nm[j]);
                EXPECT_NEAR(of_first(n), first, kOfMissedRows * first) << seed << ", " << at;
                within += std::abs(found(n) - expected) <= kBound * expected ? 1 : 0;
                ++compared;
            }
            ++judged;
            ports += rig.camera.port ? 1 : 0;
        }
    }
    EXPECT_GE(within, (1.0 - kMissed) * compared);
    EXPECT_GT(judged, 20);
    EXPECT_GT(ports, 10);
}

// Rays that swing across the edge of a beam: no polynomial has their veil, which is traced ray by
// ray.
TEST(VeilSpectrum, FollowsAnEdgeBetweenTheRays) {
    Rig rig = random_extended_rig(1);
    rig.camera.port.reset();
    rig.strobes.erase(rig.strobes.begin() + 1, rig.strobes.end());
    rig.strobes[0].emitter.reset();
    rig.strobes[0].position_m = {0.5, 0.0, 0.0};
    rig.strobes[0].axis = Eigen::Vector3d::UnitZ();
    rig.strobes[0].power = 1.0;
    rig.strobes[0].beam = even_beam(0.4);
    rig.water.scatterers = {{flat(0.3), henyey_greenstein(0.8)}};
    const TracedWater water(rig.water);
    const std::vector<double> lambda_nm = wavelengths_of(rig);
    const VeilSpectrum all(rig, water, lambda_nm);
    const TracedVeil one(rig, water);
    // A ray at 1 m beside the axis enters the beam's cone where its length reaches 1 m / tan(0.4).
    const auto ray = [&](std::size_t j) {
        const double beside_m = 1.0 + 0.01 * static_cast<double>(j) / kWavelengths;
        return VeilRay{.origin_m = {0.5 + beside_m, 0.0, 0.0},
                       .direction = Eigen::Vector3d::UnitZ(),
                       .length_m = 1.004 / std::tan(0.4)};
    };
    const Eigen::ArrayXd found = all.along(ray);
    for (std::size_t j = 0; j < lambda_nm.size(); ++j) {
        const double expected = one.radiance(ray(j), lambda_nm[j]);
        EXPECT_NEAR(found(static_cast<Eigen::Index>(j)), expected, kBound * expected) << j;
    }
    EXPECT_GT(found(0), 0.0);
    EXPECT_EQ(found(kWavelengths - 1), 0.0);
}

}  // namespace aphotic::veil_spectrum_test
