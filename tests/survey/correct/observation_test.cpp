// SPDX-License-Identifier: BSD-3-Clause
//
// A survey averaged at one altitude, as a program without our command does it.
#include "survey/correct/observation.h"

#include "base/error.h"
#include "support/raw_survey.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace aphotic::observation_test {
namespace {

constexpr double kFloats = 1e-6;

class ObservedSurvey : public testing::Test {
  protected:
    RawSurvey raw_;
    ObservationOptions options_{.altitude_m = 2.0};
};

// 0.5, 1 and 3: mean 1.5, squares 1 + 0.25 + 2.25 about it, over n (n - 1) = 6.
TEST_F(ObservedSurvey, AMeanOfThreeAndItsError) {
    const Observation observation = observe(raw_.survey(), options_, {});
    EXPECT_EQ(observation.images, 3U);
    EXPECT_EQ(observation.outside, 1U);
    EXPECT_NEAR(observation.sled.pitch_rad, 0.3, kFloats);
    const std::vector<float> light = RawSurvey::light();
    ASSERT_EQ(observation.planes.size(), 3 * light.size());
    for (std::size_t i = 0; i < light.size(); ++i) {
        EXPECT_NEAR(observation.planes[i], 1.5 * light[i], 4 * kFloats);
        EXPECT_EQ(observation.planes[light.size() + i], 3.0F);
        EXPECT_NEAR(
            observation.planes[2 * light.size() + i], std::sqrt(3.5 / 6.0) * light[i], 4 * kFloats);
    }
}

// Memory for one sample of each image at a time, or for all.
TEST_F(ObservedSurvey, RanksDoNotDependOnMemory) {
    const std::vector<float> light = RawSurvey::light();
    for (const Average average : {Average::Median, Average::Trimmed}) {
        options_.average = average;
        options_.trim = 0.4;  // leaves the middle one of three
        for (const double memory_mb : {1000.0, 1e-5}) {
            options_.memory_mb = memory_mb;
            const Observation observation = observe(raw_.survey(), options_, {});
            for (std::size_t i = 0; i < light.size(); ++i) {
                EXPECT_EQ(observation.planes[i], light[i]);
                EXPECT_EQ(observation.planes[light.size() + i], 3.0F);
            }
        }
    }
}

TEST_F(ObservedSurvey, WhatNobodyToldIsUnknown) {
    Survey survey = raw_.survey();
    survey.navigation = Navigation(
        "track", {{.image = "b", .sled = {2.0, 0.0, 0.1}}}, {.pitch = false, .roll = true});
    std::vector<std::string> heard;
    RunWatch watch;
    watch.skipped = [&](const Skipped& one) { heard.push_back(one.image); };
    const Observation observation = observe(survey, options_, watch);
    EXPECT_EQ(heard.size(), 3U);
    const nlohmann::ordered_json json = to_json(observation, "map.exr");
    EXPECT_EQ(json["map"], "map.exr");
    EXPECT_EQ(json["images"], 1);
    EXPECT_TRUE(std::isnan(json["pitch_deg"].get<double>()));
    EXPECT_NEAR(json["roll_deg"].get<double>(), 5.729578, kFloats);
    EXPECT_EQ(json["skipped"].size(), 3U);
}

TEST_F(ObservedSurvey, WritesItsPlanesByName) {
    const Observation observation = observe(raw_.survey(), options_, {});
    write_observation(raw_.path("map.exr"), observation);
    const std::vector<float> blue = RawSurvey::samples_of(raw_.path("map.exr"), {"stderr.B"});
    EXPECT_EQ(blue,
              std::vector<float>(observation.planes.end() - RawSurvey::kPixels_of_plane,
                                 observation.planes.end()));
    EXPECT_EQ(ExrReader(raw_.path("map.exr")).attribute("aphotic:images"), "3");
}

TEST_F(ObservedSurvey, NoImageIsAnError) {
    options_.altitude_m = 2.8;
    EXPECT_THROW(static_cast<void>(observe(raw_.survey(), options_, {})), InputError);
}

}  // namespace
}  // namespace aphotic::observation_test
