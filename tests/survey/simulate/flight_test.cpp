// SPDX-License-Identifier: BSD-3-Clause
#include "survey/simulate/flight.h"

#include "base/degrees.h"
#include "base/error.h"
#include "rig/file/rig_reader.h"
#include "support/refusal.h"
#include "survey/navigation/navigation_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace aphotic::flight_test {
namespace {

constexpr std::uint64_t kSeed = 7;
// Of a degree and back, and of ten digits.
constexpr double kDigits = 1e-9;

TEST(Flight, OfAShortSurveyIsTheBeginningOfALongOne) {
    const std::string few = navigation_text(flight({}, kSeed, 5), ".tif");
    EXPECT_EQ(navigation_text(flight({}, kSeed, 50), ".tif").substr(0, few.size()), few);
    EXPECT_NE(navigation_text(flight({}, kSeed + 1, 5), ".tif"), few);
}

TEST(Flight, StaysWithinItsRanges) {
    const FlightRanges ranges{
        .altitude_m = {2.0, 2.5}, .pitch_deg = {1.0, 4.0}, .roll_deg = {-1.0, 0.0}};
    constexpr double rounding_rad = 1e-12;
    for (const Leg& leg : flight(ranges, kSeed, 200)) {
        EXPECT_GE(leg.sled.altitude_m, 2.0);
        EXPECT_LE(leg.sled.altitude_m, 2.5);
        EXPECT_GE(leg.sled.pitch_rad, 1.0 * kRadiansPerDegree - rounding_rad);
        EXPECT_LE(leg.sled.pitch_rad, 4.0 * kRadiansPerDegree + rounding_rad);
        EXPECT_GE(leg.sled.roll_rad, -1.0 * kRadiansPerDegree - rounding_rad);
        EXPECT_LE(leg.sled.roll_rad, rounding_rad);
        EXPECT_LT(floor_seed(kSeed, leg.image), 1U << 31U);
    }
}

TEST(Flight, HasEachAltitudeAboutAsOften) {
    const FlightRanges ranges;
    std::array<int, 10> images{};
    for (const Leg& leg : flight(ranges, kSeed, 50)) {
        const auto [lowest_m, highest_m] = ranges.altitude_m;
        const double share = (leg.sled.altitude_m - lowest_m) / (highest_m - lowest_m);
        ++images.at(std::min<std::size_t>(9, static_cast<std::size_t>(10.0 * share)));
    }
    // Of 50 points of a golden rotation, a tenth holds 5, give or take their discrepancy.
    constexpr int kDiscrepancy = 2;
    for (const int count : images) EXPECT_NEAR(count, 5, kDiscrepancy);
}

void expect_same(const Sled& found, const Sled& expected) {
    EXPECT_NEAR(found.altitude_m, expected.altitude_m, kDigits);
    EXPECT_NEAR(found.pitch_rad, expected.pitch_rad, kDigits);
    EXPECT_NEAR(found.roll_rad, expected.roll_rad, kDigits);
}

TEST(Flight, IsWhatTheNavigationSays) {
    const std::vector<Leg> legs = flight({}, kSeed, 20);
    const std::string text = navigation_text(legs, ".tif");
    const std::vector<Leg> read =
        flight_of(parse_navigation(text, {.source = "navigation.txt"}, {}, nullptr));
    ASSERT_EQ(read.size(), legs.size());
    for (std::size_t i = 0; i < legs.size(); ++i) {
        EXPECT_EQ(read[i].name, legs[i].name);
        EXPECT_EQ(read[i].image, legs[i].image);
        expect_same(read[i].sled, legs[i].sled);
    }
}

// Names as users have them, and a camera that is not where the navigation is.
TEST(Flight, IsTheCamerasWhereTheNavigationIsTheVehicles) {
    std::vector<Leg> legs = flight({}, kSeed, 5);
    legs[0].name = "dive 3, first";
    legs[1].name = "#2";
    Rig rig = read_rig(APHOTIC_SOURCE_DIR "/scenes/habcam.toml");
    rig.mounting = {.altitude_is = AltitudeIs::Nearest,
                    .altitude_offset_m = 0.2,
                    .position_m = {0.5, -0.2, 0.3},
                    .roll_pitch_yaw_rad = {0.1, -0.2, 0.3}};
    const std::string text = navigation_text(of_vehicle(legs, rig.mounting), ".tif");
    const std::vector<Leg> read =
        flight_of(parse_navigation(text, {.source = "navigation.txt"}, {}, &rig));
    ASSERT_EQ(read.size(), legs.size());
    for (std::size_t i = 0; i < legs.size(); ++i) {
        EXPECT_EQ(read[i].name, legs[i].name);
        expect_same(read[i].sled, legs[i].sled);
    }
}

TEST(Flight, NeedsPosesOfImages) {
    const Navigation none("track.csv", {}, {});
    EXPECT_THROW(static_cast<void>(flight_of(none)), InputError);
    const Navigation bad("track.csv", {{.image = "a", .sled = {0.0, 0.0, 0.0}, .line = 3}}, {});
    const std::string said = refusal_of([&] { return flight_of(bad); });
    EXPECT_EQ(said, "track.csv:3: altitude_m: found 0; allowed: 0.001 to 10000");
}

TEST(Flight, HasItsCornersAroundIt) {
    const std::vector<Sled> corners = corners_of({{1.0, 0.1, -0.2}, {2.0, 0.2, 0.3}});
    // Pitch of both signs has none at 0: there it goes from 0, level, which is nearest, to 0.2.
    const auto has = [&](double altitude_m, double pitch_rad, double roll_rad) {
        return std::ranges::any_of(corners, [&](const Sled& sled) {
            return sled.altitude_m == altitude_m && sled.pitch_rad == pitch_rad &&
                   sled.roll_rad == roll_rad;
        });
    };
    EXPECT_TRUE(has(1.0, 0.1, 0.0));
    EXPECT_TRUE(has(2.0, 0.2, 0.3));
    EXPECT_TRUE(has(2.0, 0.2, -0.2));
    EXPECT_TRUE(corners_of(std::vector<Sled>{}).empty());
}

TEST(Flight, IsMeasuredWithTheErrorsOfInstruments) {
    constexpr int kLegs = 4000;
    const std::vector<Leg> legs = flight({}, kSeed, kLegs);
    const InstrumentErrors errors{.altitude_bias_m = 0.05, .pitch_bias_deg = -1.0};
    const std::vector<Leg> measured = as_measured(legs, errors, kSeed);
    struct Sums {
        double mean = 0.0;
        double square = 0.0;
    };
    const auto sums = [&](double Sled::*part, double unit, double bias) {
        Sums sum;
        for (std::size_t i = 0; i < legs.size(); ++i) {
            const double off = (measured[i].sled.*part - legs[i].sled.*part) / unit - bias;
            sum.mean += off / kLegs;
            sum.square += off * off / kLegs;
        }
        return sum;
    };
    // Four standard deviations of a standard deviation of 4000, and of a mean.
    const double tolerance = 4.0 / std::sqrt(2.0 * kLegs);
    const auto expect_normal = [&](const Sums& sum, double deviation) {
        EXPECT_NEAR(std::sqrt(sum.square) / deviation, 1.0, tolerance);
        EXPECT_NEAR(sum.mean / deviation, 0.0, 4.0 / std::sqrt(kLegs));
    };
    expect_normal(sums(&Sled::altitude_m, 1.0, 0.05), 0.02);
    expect_normal(sums(&Sled::pitch_rad, kRadiansPerDegree, -1.0), 0.5);
    expect_normal(sums(&Sled::roll_rad, kRadiansPerDegree, 0.0), 0.5);
}

}  // namespace
}  // namespace aphotic::flight_test
