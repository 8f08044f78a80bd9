// SPDX-License-Identifier: BSD-3-Clause
#include "survey/relief/local_planes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace aphotic::local_planes_test {
namespace {

constexpr int kWidth_px = 120;
constexpr int kHeight_px = 90;
constexpr double kPixel_rad = 1e-3;
constexpr double kOfFloats = 1e-4;  // a slope over two pixels of floats' rounding

// Depth along the axis at the tangents of a pixel.
std::vector<InversePlace> places_of(const std::function<double(double x, double y)>& depth_m) {
    std::vector<InversePlace> places;
    for (int row = 0; row < kHeight_px; ++row) {
        for (int column = 0; column < kWidth_px; ++column) {
            const double x = kPixel_rad * (column + 0.5 - 0.5 * kWidth_px);
            const double y = kPixel_rad * (row + 0.5 - 0.5 * kHeight_px);
            places.push_back({.place = {static_cast<float>(x), static_cast<float>(y)},
                              .inverse_per_m = static_cast<float>(1.0 / depth_m(x, y))});
        }
    }
    return places;
}

// Of the plane n . P = h.
std::vector<InversePlace> plane(const Eigen::Vector3d& n, double h) {
    return places_of([=](double x, double y) { return h / n.dot(Eigen::Vector3d(x, y, 1.0)); });
}

}  // namespace

TEST(LocalPlanes, OfATiltedPlaneAreIt) {
    const Eigen::Vector3d n = Eigen::Vector3d(0.4, -0.3, 1.0).normalized();
    const std::vector<InversePlace> places = plane(n, 2.0);
    const LocalPlanes planes(places, kWidth_px, kLeastBlock_px);
    for (const auto& [column, row] : {std::pair{0, 0}, {60, 45}, {119, 89}, {3, 88}}) {
        const LocalPlane found = planes.at(column, row).value();
        EXPECT_LT((found.normal() + n).norm(), kOfFloats) << column << ", " << row;
        const InversePlace& here = places[static_cast<std::size_t>(row * kWidth_px + column)];
        EXPECT_NEAR(found.inverse_at(here.place), here.inverse_per_m, 1e-6);
    }
    EXPECT_LT(planes.roughness(), 1e-6);
}

// On both sides of a step between two columns of a block, up to its very edge.
TEST(LocalPlanes, KeepToTheirSideOfAStep) {
    for (const int step_px : {60, 61}) {
        const std::vector<InversePlace> places = places_of([&](double x, double /*y*/) {
            return x < kPixel_rad * (step_px - 0.5 * kWidth_px) ? 2.0 : 2.3;
        });
        const LocalPlanes planes(places, kWidth_px, kLeastBlock_px);
        for (int column = step_px - 6; column < step_px + 6; ++column) {
            const LocalPlane found = planes.at(column, 40).value();
            EXPECT_LT((found.normal() + Eigen::Vector3d::UnitZ()).norm(), kOfFloats) << column;
            EXPECT_NEAR(1.0 / found.inverse_at(places[static_cast<std::size_t>(column)].place),
                        column < step_px ? 2.0 : 2.3,
                        1e-5)
                << column;
        }
    }
}

// sqrt(12) sigma / (m^2 p), of windows of m pixels, on a floor at 2 m.
TEST(LocalPlanes, TiltByTheNoiseThatTheirHeaderSays) {
    constexpr double kDepth_m = 2.0;
    constexpr double kSigma_m = 0.002;
    constexpr int kBlock_px = 4;
    constexpr double kOfAFewWindows = 0.15;  // of some hundred independent ones
    std::mt19937 engine(5);
    std::normal_distribution<double> noise(0.0, kSigma_m);
    const std::vector<InversePlace> places =
        places_of([&](double, double) { return kDepth_m + noise(engine); });
    const LocalPlanes planes(places, kWidth_px, kBlock_px);
    double sum = 0.0;
    int count = 0;
    // In the middle of a block the plane is that of the block's own window, for the most part.
    for (int row = 6; row < kHeight_px - 6; row += 3 * kBlock_px) {
        for (int column = 6; column < kWidth_px - 6; column += 3 * kBlock_px) {
            const Eigen::Vector3d normal = planes.at(column, row).value().normal();
            sum += normal.head<2>().squaredNorm();
            count += 2;
        }
    }
    const double expected =
        std::sqrt(12.0) * kSigma_m / (9.0 * kBlock_px * kBlock_px * kPixel_rad * kDepth_m);
    EXPECT_NEAR(std::sqrt(sum / count) / expected, 1.0, 3.0 * kOfAFewWindows);
    EXPECT_NEAR(planes.roughness(), kSigma_m / kDepth_m, kOfAFewWindows * kSigma_m / kDepth_m);
    // As many pixels as the header's formula asks for.
    const double pixels = std::sqrt(std::sqrt(12.0) * 1e-3 / (kSlopeError * kPixel_rad));
    EXPECT_NEAR(3.0 * block_for(1e-3, kPixel_rad, 4000), pixels, 3.0);
}

TEST(LocalPlanes, AreNoneFarFromWhatIsKnown) {
    std::vector<InversePlace> places = plane(Eigen::Vector3d::UnitZ(), 2.0);
    for (int row = 0; row < kHeight_px; ++row)
        for (int column = 40; column < kWidth_px; ++column)
            places[static_cast<std::size_t>(row * kWidth_px + column)].inverse_per_m =
                std::numeric_limits<float>::quiet_NaN();
    const LocalPlanes planes(places, kWidth_px, kLeastBlock_px);
    EXPECT_TRUE(planes.at(41, 40));
    EXPECT_FALSE(planes.at(80, 40));
}

}  // namespace aphotic::local_planes_test
