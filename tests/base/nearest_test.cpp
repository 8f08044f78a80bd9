// SPDX-License-Identifier: BSD-3-Clause
#include "base/nearest.h"

#include <gtest/gtest.h>

#include <vector>

namespace aphotic::nearest_test {
namespace {

const std::vector<std::string> kKnown{"altitude_m", "pitch_deg", "roll_deg", "sand"};

TEST(NearestName, FindsAMisspeltName) {
    EXPECT_EQ(nearest_name("altitud_m", kKnown), "altitude_m");
    EXPECT_EQ(nearest_name("altitude", kKnown), "altitude_m");
    EXPECT_EQ(nearest_name("rol_dgg", kKnown), "roll_deg");
}

TEST(NearestName, PassesOverLetterCase) {
    EXPECT_EQ(nearest_name("SAND", kKnown), "sand");
}

TEST(NearestName, IsEmptyWhenNothingIsNear) {
    EXPECT_EQ(nearest_name("xenon", kKnown), "");
    EXPECT_EQ(nearest_name("", kKnown), "");
    EXPECT_EQ(nearest_name("sand", {}), "");
}

TEST(NearestName, IsEmptyAtHalfTheLength) {
    EXPECT_EQ(nearest_name("saXX", kKnown), "");      // distance 2 of 4
    EXPECT_EQ(nearest_name("sanX", kKnown), "sand");  // distance 1 of 4
}

TEST(NearestName, TakesTheFirstOfEquals) {
    const std::vector<std::string> known{"cab", "car"};
    EXPECT_EQ(nearest_name("cat", known), "cab");
}

TEST(NearestName, UnitLeftOffIsFound) {
    const std::vector<std::string> known{"salt", "salinity_psu", "range_nm"};
    EXPECT_EQ(nearest_name("salinity", known), "salinity_psu");
    EXPECT_EQ(nearest_name("range", known), "range_nm");
}

}  // namespace
}  // namespace aphotic::nearest_test
