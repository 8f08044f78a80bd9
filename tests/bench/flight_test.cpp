// SPDX-License-Identifier: BSD-3-Clause
#include "bench/survey/flight.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

namespace aphotic::survey::flight_test {
namespace {

constexpr std::uint64_t kSeed = 7;

TEST(Flight, OfAShortSurveyIsTheBeginningOfALongOne) {
    const std::string few = navigation(flight(kSeed, 5), ".tif");
    EXPECT_EQ(navigation(flight(kSeed, 50), ".tif").substr(0, few.size()), few);
    EXPECT_NE(navigation(flight(kSeed + 1, 5), ".tif"), few);
}

TEST(Flight, StaysWithinItsBounds) {
    for (const Leg& leg : flight(kSeed, 500)) {
        EXPECT_GE(leg.altitude_m, kLowest_m);
        EXPECT_LE(leg.altitude_m, kHighest_m);
        EXPECT_GE(leg.pitch_deg, kLeastPitch_deg);
        EXPECT_LE(leg.pitch_deg, kMostPitch_deg);
        EXPECT_LE(std::abs(leg.roll_deg), kMostRoll_deg);
        EXPECT_LT(leg.floor_seed, 1U << 31U);
    }
}

TEST(Flight, HasEachAltitudeAboutAsOften) {
    std::array<int, 10> images{};
    for (const Leg& leg : flight(kSeed, 50)) {
        const double share = (leg.altitude_m - kLowest_m) / (kHighest_m - kLowest_m);
        ++images.at(std::min<std::size_t>(9, static_cast<std::size_t>(10.0 * share)));
    }
    // Of 50 points of a golden rotation, a tenth holds 5, give or take their discrepancy.
    constexpr int kDiscrepancy = 2;
    for (const int count : images) EXPECT_NEAR(count, 5, kDiscrepancy);
}

TEST(Flight, IsWhatTheNavigationSays) {
    const std::vector<Leg> legs = flight(kSeed, 20);
    std::istringstream lines(navigation(legs, ".tif"));
    // Three decimals read back are the nearest double; what was flown came by another way there.
    constexpr double kLastBit = 1e-12;
    for (const Leg& leg : legs) {
        std::string name;
        double altitude_m = 0.0;
        double pitch_deg = 0.0;
        double roll_deg = 0.0;
        lines >> name >> altitude_m >> pitch_deg >> roll_deg;
        EXPECT_EQ(name, leg.name + ".tif");
        EXPECT_NEAR(altitude_m, leg.altitude_m, kLastBit);
        EXPECT_NEAR(pitch_deg, leg.pitch_deg, kLastBit);
        EXPECT_NEAR(roll_deg, leg.roll_deg, kLastBit);
    }
}

TEST(Flight, IsMeasuredWithTheErrorsOfInstruments) {
    constexpr int kLegs = 4000;
    const std::vector<Leg> legs = flight(kSeed, kLegs);
    const std::vector<Leg> measured = as_measured(legs, kSeed);
    double altitude = 0.0;
    double pitch = 0.0;
    double roll = 0.0;
    double bias = 0.0;
    for (std::size_t i = 0; i < legs.size(); ++i) {
        altitude += std::pow(measured[i].altitude_m - legs[i].altitude_m, 2) / kLegs;
        pitch += std::pow(measured[i].pitch_deg - legs[i].pitch_deg, 2) / kLegs;
        roll += std::pow(measured[i].roll_deg - legs[i].roll_deg, 2) / kLegs;
        bias += (measured[i].altitude_m - legs[i].altitude_m) / kLegs;
    }
    // Four standard deviations of a standard deviation of 4000, and of a mean.
    const double tolerance = 4.0 / std::sqrt(2.0 * kLegs);
    EXPECT_NEAR(std::sqrt(altitude) / kAltimeterError_m, 1.0, tolerance);
    EXPECT_NEAR(std::sqrt(pitch) / kAttitudeError_deg, 1.0, tolerance);
    EXPECT_NEAR(std::sqrt(roll) / kAttitudeError_deg, 1.0, tolerance);
    EXPECT_NEAR(bias / kAltimeterError_m, 0.0, 4.0 / std::sqrt(kLegs));
}

TEST(Flight, LaysTheChartInTheFirstFiveAndThenEveryTenth) {
    std::string charts;
    for (const Leg& leg : flight(kSeed, 30)) {
        if (leg.has_chart) charts += std::to_string(leg.image) + " ";
    }
    EXPECT_EQ(charts, "1 2 3 4 5 10 20 30 ");
}

}  // namespace
}  // namespace aphotic::survey::flight_test
