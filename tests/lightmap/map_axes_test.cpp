// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/map_axes.h"

#include "base/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

namespace aphotic::map_axes_test {
namespace {

// A float, through logarithm and exponential.
constexpr double kRounding = 2e-6;

MapAxes axes() {
    return {.altitude_m = {1.0, 2.0, 4.0},
            .pitch_rad = {-0.1, 0.1},
            .roll_rad = {0.0},
            .water_multiple = {1.0}};
}

Lightmap of(float value) {
    return {.width_px = 1, .height_px = 1, .samples = {value, 2.0F * value, 0.0F}};
}

// A map of 1/h^3, without an error at any altitude; and exact at the bins themselves.
TEST(MapAxes, InterpolatesPowersOfAltitudeExactly) {
    const std::vector<MapPoint> points = points_of(axes());
    for (const double altitude_m : {1.0, 1.3, 2.0, 3.1, 4.0}) {
        const auto neighbours =
            neighbours_of(axes(), {.sled = {.altitude_m = altitude_m, .pitch_rad = 0.03}});
        std::vector<Lightmap> maps;
        std::vector<const Lightmap*> pointers;
        double weights = 0.0;
        for (const Neighbour& n : neighbours) {
            maps.push_back(of(static_cast<float>(std::pow(points[n.bin].sled.altitude_m, -3))));
            weights += n.weight;
        }
        for (const Lightmap& map : maps) pointers.push_back(&map);
        EXPECT_NEAR(weights, 1.0, 1e-12);
        const Lightmap map = blended(pointers, neighbours);
        const double wanted = std::pow(altitude_m, -3);
        EXPECT_NEAR(map.samples[0] / wanted, 1.0, kRounding) << altitude_m;
        EXPECT_NEAR(map.samples[1] / wanted, 2.0, kRounding) << altitude_m;
        EXPECT_EQ(map.samples[2], 0.0F);
    }
}

// Where a bin is black the mean of the bins stands in.
TEST(MapAxes, TakesTheMeanWhereABinIsBlack) {
    const Lightmap lit = of(3.0F);
    const Lightmap black = of(0.0F);
    const std::vector<const Lightmap*> maps{&lit, &black};
    const std::vector<Neighbour> neighbours{{0, 0.25}, {1, 0.75}};
    EXPECT_FLOAT_EQ(blended(maps, neighbours).samples[0], 0.75F);
}

TEST(MapAxes, NeighboursAreTheBinsAboutAPoint) {
    const std::vector<MapPoint> points = points_of(axes());
    EXPECT_EQ(points.size(), 6U);
    const auto neighbours = neighbours_of(axes(), {.sled = {.altitude_m = 3.0, .pitch_rad = 0.05}});
    ASSERT_EQ(neighbours.size(), 4U);
    std::set<double> altitudes;
    for (const Neighbour& n : neighbours) altitudes.insert(points[n.bin].sled.altitude_m);
    EXPECT_EQ(altitudes, (std::set<double>{2.0, 4.0}));
    const auto one = neighbours_of(axes(), {.sled = {.altitude_m = 2.0, .pitch_rad = -0.1}});
    ASSERT_EQ(one.size(), 1U);
    EXPECT_EQ(points[one[0].bin].sled.altitude_m, 2.0);
}

TEST(MapAxes, RefusesWhatTheyDoNotCover) {
    for (const double altitude_m : {0.99, 4.01, std::numeric_limits<double>::quiet_NaN()}) {
        EXPECT_THROW((void)neighbours_of(axes(), {.sled = {.altitude_m = altitude_m}}), InputError);
    }
    EXPECT_THROW((void)neighbours_of(axes(), {.sled = {.altitude_m = 2.0, .roll_rad = 0.1}}),
                 InputError);
}

}  // namespace
}  // namespace aphotic::map_axes_test
