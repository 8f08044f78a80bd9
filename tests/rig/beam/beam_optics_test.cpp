// SPDX-License-Identifier: BSD-3-Clause
#include "rig/beam/beam_optics.h"

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <boost/math/quadrature/gauss_kronrod.hpp>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace aphotic::beam_optics_test {
namespace {

using Eigen::Vector3d;

// The source paper's diffuser, before its lens, beyond it, in focus and so far out of it that the
// lens is the smaller.
const std::array kStrobes{BeamOptics{.along_m = 0.0635,
                                     .across_m = 0.0302,
                                     .focal_length_m = 0.065,
                                     .distance_m = 0.04,
                                     .aperture_m = 0.08},
                          BeamOptics{.along_m = 0.0302,
                                     .across_m = 0.0635,
                                     .focal_length_m = 0.065,
                                     .distance_m = 0.09,
                                     .aperture_m = 0.05},
                          BeamOptics{.along_m = 0.0635,
                                     .across_m = 0.0302,
                                     .focal_length_m = 0.065,
                                     .distance_m = 0.065,
                                     .aperture_m = 0.08},
                          BeamOptics{.along_m = 0.2,
                                     .across_m = 0.1,
                                     .focal_length_m = 0.05,
                                     .distance_m = 0.02,
                                     .aperture_m = 0.02}};

// By rays: the share of a fine grid on the lens through which the thin lens's law sees the
// rectangle.
double by_rays(const BeamOptics& optics, const Vector3d& direction) {
    constexpr int kAcross = 1000;
    const double R = 0.5 * optics.aperture_m;
    const double mx = direction.x() / direction.z();
    const double my = direction.y() / direction.z();
    int lit = 0;
    for (int i = 0; i < kAcross; ++i) {
        for (int j = 0; j < kAcross; ++j) {
            const double x = R * (2.0 * (i + 0.5) / kAcross - 1.0);
            const double y = R * (2.0 * (j + 0.5) / kAcross - 1.0);
            // A thin lens turns a ray's slope by -x/f: before it the slope was m + x/f.
            const double from_x = x - optics.distance_m * (mx + x / optics.focal_length_m);
            const double from_y = y - optics.distance_m * (my + y / optics.focal_length_m);
            lit += x * x + y * y <= R * R && std::abs(from_x) <= 0.5 * optics.along_m &&
                   std::abs(from_y) <= 0.5 * optics.across_m;
        }
    }
    return direction.z() / direction.norm() * 4.0 * R * R * lit / (1.0 * kAcross * kAcross);
}

TEST(BeamOptics, IsWhatRaysThroughTheLensMake) {
    constexpr double kGrid = 3e-3;  // of 1000 by 1000 points: a row and a column, of a cosine
    for (const BeamOptics& optics : kStrobes) {
        for (const double x : {0.0, 0.13, -0.31, 0.47, 0.8}) {
            for (const double y : {0.0, 0.09, 0.22, -0.4}) {
                const Vector3d direction(x, y, 1.0);
                EXPECT_NEAR(optics_intensity(optics, direction),
                            by_rays(optics, direction),
                            kGrid * most_optics_intensity(optics))
                    << optics.distance_m << " " << x << " " << y;
            }
        }
    }
}

// The closed form of the flux against the integral of I over the angles whose tangents are slopes.
TEST(BeamOptics, HasTheFluxOfItsIntensity) {
    using Kronrod = boost::math::quadrature::gauss_kronrod<double, 15>;
    constexpr unsigned kHalvings = 9;
    constexpr double kClose = 1e-8;
    for (const BeamOptics& optics : kStrobes) {
        // A quarter of it; a sharp image up to its edges.
        const auto end_rad = [&](double side_m) {
            return is_focused(optics) ? std::atan(0.5 * side_m / optics.distance_m)
                                      : 0.5 * std::numbers::pi;
        };
        const auto at = [&](double a, double b) {
            const Vector3d direction(std::tan(a), std::tan(b), 1.0);
            return optics_intensity(optics, direction) * std::pow(direction.norm(), -3) /
                   std::pow(std::cos(a) * std::cos(b), 2);
        };
        const auto line = [&](double a) {
            return Kronrod::integrate([&](double b) { return at(a, b); },
                                      0.0,
                                      end_rad(optics.across_m),
                                      kHalvings,
                                      kClose);
        };
        const double found =
            4.0 * Kronrod::integrate(line, 0.0, end_rad(optics.along_m), kHalvings, kClose);
        EXPECT_NEAR(found / optics_flux(optics), 1.0, 1e-6) << optics.distance_m;
    }
}

// All lengths 1e-5 times as long: the same angles, from 1e-10 of the area. The integral
// takes no longer.
TEST(BeamOptics, OfAnySizeHasTheFluxOfItsArea) {
    const BeamOptics metres{.along_m = 1.0,
                            .across_m = 1.0,
                            .focal_length_m = 1e6,
                            .distance_m = 1.0,
                            .aperture_m = 1.0};
    BeamOptics small = metres;
    for (double* length_m : {&small.along_m,
                             &small.across_m,
                             &small.focal_length_m,
                             &small.distance_m,
                             &small.aperture_m}) {
        *length_m *= 1e-5;
    }
    EXPECT_NEAR(optics_flux(small) / (1e-10 * optics_flux(metres)), 1.0, 1e-10);
}

// A lens far larger than the diffuser close behind it takes all that a Lambertian rectangle emits,
// pi times its area: that of the image, 1/(1 - s/f)^2 times as large.
TEST(BeamOptics, ALargeLensTakesAll) {
    const BeamOptics optics{.along_m = 0.001,
                            .across_m = 0.002,
                            .focal_length_m = 1.0,
                            .distance_m = 0.0005,
                            .aperture_m = 2.0};
    const double image_m2 = 2e-6 / std::pow(1.0 - 0.0005, 2);
    EXPECT_NEAR(optics_flux(optics) / (std::numbers::pi * image_m2), 1.0, 1e-6);
}

TEST(BeamOptics, BoundsWhatAConeOfDirectionsHolds) {
    std::mt19937 engine(7);
    std::uniform_real_distribution<double> share(-1.0, 1.0);
    for (const BeamOptics& optics : kStrobes) {
        // Areas are differences of parts of a disc.
        const double rounding = 1e-15 * most_optics_intensity(optics);
        for (int trial = 0; trial < 200; ++trial) {
            const Vector3d middle = Vector3d(share(engine), share(engine), 1.0).normalized();
            const double within_rad = 0.3 * std::abs(share(engine));
            const double bound = most_optics_intensity(optics, middle, within_rad);
            for (int k = 0; k < 50; ++k) {
                const Vector3d aside =
                    middle.cross(Vector3d(share(engine), share(engine), share(engine)))
                        .normalized();
                const double angle_rad = within_rad * std::abs(share(engine));
                const Vector3d direction =
                    std::cos(angle_rad) * middle + std::sin(angle_rad) * aside;
                EXPECT_LE(optics_intensity(optics, direction), bound + rounding);
            }
        }
    }
}

// With the long side along and the focus at the diffuser, the image is cut at u/f.
TEST(BeamOptics, InFocusEndsAtTheDiffusersOwnAngles) {
    const BeamOptics& optics = kStrobes[2];
    ASSERT_TRUE(is_focused(optics));
    const double along = 0.5 * 0.0635 / 0.065;
    const double across = 0.5 * 0.0302 / 0.065;
    for (const double beside : {1.0 - 1e-9, 1.0 + 1e-9}) {
        EXPECT_EQ(is_within_image(optics, {along * beside, 0.0, 1.0}), beside < 1.0);
        EXPECT_EQ(optics_intensity(optics, {0.0, across * beside, 1.0}) > 0.0, beside < 1.0);
    }
    EXPECT_FALSE(is_focused(kStrobes[0]));
}

}  // namespace
}  // namespace aphotic::beam_optics_test
