// SPDX-License-Identifier: BSD-3-Clause
#include "base/number.h"

#include "support/comma_locale.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

namespace aphotic::number_test {
namespace {

TEST(Number, IsAllOfItsText) {
    EXPECT_EQ(read_number<double>("12.5"), 12.5);
    EXPECT_EQ(read_number<double>("-1e-3"), -0.001);
    EXPECT_EQ(read_number<int>("-7"), -7);
    for (const char* text : {"", " 1", "1 ", "1,5", "+1", "1.5x", "0x10", "1e400", "."})
        EXPECT_FALSE(read_number<double>(text)) << text;
    for (const char* text : {"1.5", "300", "-1", ""})
        EXPECT_FALSE(read_number<std::uint8_t>(text)) << text;
    EXPECT_TRUE(std::isnan(read_number<double>("nan").value()));
    EXPECT_EQ(read_number<double>("inf"), std::numeric_limits<double>::infinity());
}

TEST(Number, LeavesWhatFollowsIt) {
    std::string_view text = "12.5,3";
    EXPECT_EQ(read_leading_number<double>(text), 12.5);
    EXPECT_EQ(text, ",3");
    EXPECT_FALSE(read_leading_number<double>(text));
    EXPECT_EQ(text, ",3");
    // One that no double holds is passed over, or who reads on would never come to an end.
    text = "1e400 m";
    EXPECT_FALSE(read_leading_number<double>(text));
    EXPECT_EQ(text, " m");
}

TEST(Number, IsRoundedToDigits) {
    EXPECT_EQ(rounded_to_digits(120.00000000000001, 12), 120.0);
    EXPECT_EQ(rounded_to_digits(0.1 + 0.2, 12), 0.3);
    EXPECT_EQ(rounded_to_digits(-1234.5678, 3), -1230.0);
}

TEST(Number, HasItsPointWhereTheHostWritesCommas) {
    const CommaLocale commas;
    EXPECT_EQ(read_number<double>("12.5"), 12.5);
    EXPECT_FALSE(read_number<double>("12,5"));
    EXPECT_EQ(rounded_to_digits(12.5, 12), 12.5);
    if (!commas.has_c()) GTEST_SKIP() << "no locale with commas for the C library";
    EXPECT_EQ(std::strtod("12.5", nullptr), 12.0) << "the locale has no commas";
}

}  // namespace
}  // namespace aphotic::number_test
