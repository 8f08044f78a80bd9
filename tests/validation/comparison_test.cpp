// SPDX-License-Identifier: BSD-3-Clause
#include "validation/comparison.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace aphotic::comparison_test {
namespace {

// Two or three operations on doubles.
constexpr double kRounding = 1e-15;
constexpr double kNoFloor = 0.0;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

using Plane = std::vector<float>;       // a render's
using Reference = std::vector<double>;  // the tracer's
using Marks = std::vector<unsigned char>;

Comparison compared(const Plane& a,
                    const Reference& b,
                    const Marks& on_edge = {},
                    double floor = kNoFloor,
                    double bound = 0.5) {
    return compare_planes("550 nm", a, b, 2, on_edge, floor, bound);
}

// --- One sample --------------------------------------------------------------------------------

TEST(RelativeError, IsTheDifferenceOverTheReferenceOrTheFloorWithItsSign) {
    struct Case {
        double found, reference, floor, wanted;
    };
    for (const Case& one : {Case{3.0, 2.0, kNoFloor, 0.5},
                            {2.0, 3.0, kNoFloor, -1.0 / 3.0},
                            {-3.0, -2.0, kNoFloor, -0.5},
                            {0.3, 0.1, 0.4, 0.5},
                            {0.3, 0.0, 0.4, 0.75},
                            {3.0, 2.0, 0.4, 0.5},
                            {0.0, 0.0, kNoFloor, 0.0},
                            {-0.0, 0.0, kNoFloor, 0.0}})
        EXPECT_NEAR(relative_error(one.found, one.reference, one.floor), one.wanted, kRounding)
            << one.found << " of " << one.reference;
    EXPECT_TRUE(std::isinf(relative_error(1e-30, 0.0, kNoFloor)));
    for (const float bad : {kNaN, kInfinity, -kInfinity}) {
        EXPECT_TRUE(std::isnan(relative_error(bad, 1.0, 1.0))) << bad;
        EXPECT_TRUE(std::isnan(relative_error(1.0, bad, 1.0))) << bad;
        EXPECT_TRUE(std::isnan(relative_error(bad, bad, 1.0))) << bad;
    }
}

// --- A plane -----------------------------------------------------------------------------------

// e = 0.5, -0.25, 0, 0.125: all exact in binary. Mean 0.375 / 4; squares add up to
// 0.25 + 0.0625 + 0 + 0.015625 = 0.328125.
TEST(ComparePlanes, GivesMaxRmsAndSignedMeanOfAHandMadePlane) {
    const Comparison found = compared({3.0F, 3.0F, 7.0F, 9.0F}, {2.0, 4.0, 7.0, 8.0});
    EXPECT_EQ(found.name, "550 nm");
    EXPECT_EQ(found.compared, 4U);
    EXPECT_NEAR(found.max_error, 0.5, kRounding);
    EXPECT_NEAR(found.rms_error, std::sqrt(0.328125 / 4.0), kRounding);
    EXPECT_NEAR(found.mean_error, 0.375 / 4.0, kRounding);
}

TEST(ComparePlanes, SaysWhereTheLargestErrorIsAndThatItMayBeNegative) {
    const Comparison found =
        compared({1.0F, 1.0F, 1.0F, 1.0F, 1.1F, 0.25F}, {1.0, 1.0, 1.0, 1.0, 1.0, 1.0});
    EXPECT_NEAR(found.max_error, 0.75, kRounding);
    EXPECT_EQ(found.column, 1);
    EXPECT_EQ(found.row, 2);
    EXPECT_LT(found.mean_error, 0.0);
}

// Nearest rank: the smallest error that at least 99.9 % of the samples do not exceed. Of 1000
// errors 1, 2 ... 1000 that is the 999th; of 2001 it is the 1999th, for 0.999 x 2001 = 1998.999;
// of 10 it is the largest.
TEST(ComparePlanes, GivesThePercentileByNearestRank) {
    const auto percentile_of = [](int count) {
        Plane a;
        const Reference b(static_cast<std::size_t>(count), 1.0F);
        // In no order: 7 has no factor in common with any of the counts.
        for (int i = 0; i < count; ++i) a.push_back(static_cast<float>(1 + 1 + i * 7 % count));
        return compared(a, b).percentile_999;
    };
    EXPECT_EQ(percentile_of(1000), 999.0);
    EXPECT_EQ(percentile_of(2001), 1999.0);
    EXPECT_EQ(percentile_of(10), 10.0);
    EXPECT_EQ(percentile_of(1), 1.0);
}

TEST(ComparePlanes, MeasuresEdgesOnTheirOwn) {
    const Comparison found =
        compared({1.25F, 9.0F, 1.0F, 0.5F}, {1.0, 1.0, 1.0, 1.0}, {0, 1, 0, 1});
    EXPECT_EQ(found.compared, 2U);
    EXPECT_EQ(found.on_edges, 2U);
    EXPECT_NEAR(found.max_error, 0.25, kRounding);
    EXPECT_EQ(found.column, 0);
    EXPECT_EQ(found.row, 0);
    EXPECT_NEAR(found.percentile_999, 0.25, kRounding);
    EXPECT_NEAR(found.mean_error, 0.125, kRounding);
    EXPECT_NEAR(found.rms_error, std::sqrt(0.0625 / 2.0), kRounding);
    EXPECT_NEAR(found.max_error_on_edges, 8.0, kRounding);
    EXPECT_TRUE(found.holds());
}

TEST(ComparePlanes, AppliesTheFloorToEverySample) {
    const Comparison found = compared({0.5F, 0.25F}, {0.0, 0.5}, {}, 1.0);
    EXPECT_NEAR(found.max_error, 0.5, kRounding);
    EXPECT_NEAR(found.mean_error, 0.125, kRounding);
}

TEST(ComparePlanes, TellsTheFloorAndHowManySamplesAreUnderIt) {
    const Comparison found =
        compared({1.0F, 1.0F, 1.0F, 1.0F}, {0.5, -0.5, 1.0, 0.5}, {0, 0, 0, kOnEdge}, 1.0);
    EXPECT_EQ(found.floor, 1.0);
    EXPECT_EQ(found.under_floor, 2U) << "neither what is at the floor nor what is on edges";
}

TEST(ComparePlanes, HoldsUpToTheBoundAndNotBeyond) {
    const Reference one{1.0};
    EXPECT_TRUE(compared({1.25F}, one, {}, kNoFloor, 0.25).holds());
    EXPECT_FALSE(compared({1.25F}, one, {}, kNoFloor, std::nextafter(0.25, 0.0)).holds());
    EXPECT_TRUE(compared({0.75F}, one, {}, kNoFloor, 0.25).holds());
    EXPECT_FALSE(compared({0.75F}, one, {}, kNoFloor, std::nextafter(0.25, 0.0)).holds());
    EXPECT_TRUE(compared({1.0F}, one, {}, kNoFloor, 0.0).holds());
}

TEST(ComparePlanes, CountsWhatIsNotFiniteAndDoesNotHold) {
    const Reference ones(6, 1.0);
    const Comparison found = compared({1.0F, kNaN, 1.25F, kInfinity, 1.0F, -kInfinity}, ones);
    EXPECT_EQ(found.not_finite, 3U);
    EXPECT_EQ(found.compared, 3U);
    EXPECT_NEAR(found.max_error, 0.25, kRounding);
    EXPECT_NEAR(found.mean_error, 0.25 / 3.0, kRounding);
    EXPECT_FALSE(found.holds());
}

TEST(ComparePlanes, DoesNotHoldWhenBothAreTheSameInfinity) {
    EXPECT_FALSE(compared({kInfinity, 1.0F}, {kInfinity, 1.0}).holds());
    EXPECT_FALSE(compared({1.0F, 1.0F}, {1.0, kNaN}).holds());
}

TEST(ComparePlanes, DoesNotForgiveNaNOnAnEdge) {
    const Comparison found = compared({1.0F, kNaN}, {1.0, 1.0}, {0, 1});
    EXPECT_EQ(found.not_finite, 1U);
    EXPECT_EQ(found.on_edges, 1U);
    EXPECT_FALSE(found.holds());
}

TEST(ComparePlanes, TakesTheReferenceInDoublePrecision) {
    EXPECT_NEAR(compared({1.0F}, {1.0 + 1e-9}).max_error, 1e-9, 1e-15);
}

TEST(ComparePlanes, OfNothingDoesNotHold) {
    EXPECT_FALSE(compared({}, {}).holds());
    const Comparison all_edges = compared({1.0F, 1.0F}, {1.0, 1.0}, {1, 1});
    EXPECT_EQ(all_edges.compared, 0U);
    EXPECT_EQ(all_edges.on_edges, 2U);
    EXPECT_FALSE(all_edges.holds());
}

TEST(ComparePlanes, DoesNotHoldWhereBlackIsExpectedAndAnythingIsFound) {
    const Comparison found = compared({1e-30F, 1.0F}, {0.0, 1.0});
    EXPECT_TRUE(std::isinf(found.max_error));
    EXPECT_FALSE(found.holds());
}

}  // namespace
}  // namespace aphotic::comparison_test
