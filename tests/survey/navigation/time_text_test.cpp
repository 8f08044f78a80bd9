// SPDX-License-Identifier: BSD-3-Clause
//
// Times as text, against the seconds that GNU date has for them: date -u -d TEXT +%s.%N
#include "survey/navigation/time_text.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace aphotic::time_text_test {
namespace {

constexpr double kDouble_s = 5e-7;  // the step of a double around 1.7e9 is 2.4e-7

TEST(TimeText, IsWhatDateSays) {
    const std::vector<std::pair<std::string, double>> times{
        {"1970-01-01 00:00:00", 0.0},
        {"2000-02-29 23:59:59", 951868799.0},
        {"2012-06-23 17:15:52.346", 1340471752.346},
        {"2024-03-09 12:34:56.789", 1709987696.789},
        {"2024-03-09T12:34:56.789Z", 1709987696.789},
        {"2024-03-09T12:34:56Z", 1709987696.0},
        {"2024-03-09 12:34:56 Z", 1709987696.0},
        {"2024/03/09 12:34:56.789", 1709987696.789},  // HabCam's log
        {"2024:03:09 12:34:56.789", 1709987696.789},  // EXIF
        {"2024-03-09 12:34:56,5", 1709987696.5},
        {"2024-03-09T12:34:56+02:00", 1709980496.0},
        {"2024-03-09T12:34:56.25-0330", 1710000296.25},
        {" 2024-03-09 12:34:56 ", 1709987696.0},
        {"1709987696.789", 1709987696.789},
        {"1709987696", 1709987696.0},
        {"-1.5", -1.5},
        {"1969-12-31T23:59:58.5Z", -1.5}};
    for (const auto& [text, wanted_s] : times) {
        const auto found_s = unix_time_s(text);
        ASSERT_TRUE(found_s.has_value()) << text;
        EXPECT_NEAR(*found_s, wanted_s, kDouble_s) << text;
    }
}

TEST(TimeText, WhatNoCalendarAndNoClockHasIsNone) {
    for (const char* text : {"",
                             "noon",
                             "None",
                             "nan",
                             "inf",
                             "1709987696789",  // milliseconds
                             "2024-03-09",
                             "12:34:56",
                             "2023-02-29 12:34:56",
                             "2024-13-09 12:34:56",
                             "2024-00-09 12:34:56",
                             "2024-03-32 12:34:56",
                             "2024-03-09 24:34:56",
                             "2024-03-09 12:60:56",
                             "2024-03-09 12:34:61",
                             "2024-03-09 12:34",
                             "2024-03/09 12:34:56",
                             "2024-03-09 12:34:56.",
                             "2024-03-09 12:34:56 UTC+1",
                             "2024-03-09 12:34:56+2",
                             "2024-03-09 12:34:56+25:00",
                             "24-03-09 12:34:56",
                             "2024-3-9 12:34:56"}) {
        EXPECT_FALSE(unix_time_s(text).has_value()) << text;
    }
}

TEST(TimeText, IsWrittenInUtcToTheMillisecond) {
    EXPECT_EQ(utc_text(1709987696.789), "2024-03-09T12:34:56.789Z");
    EXPECT_EQ(utc_text(951868799.9996), "2000-03-01T00:00:00.000Z");
    EXPECT_EQ(utc_text(-1.5), "1969-12-31T23:59:58.500Z");
}

}  // namespace
}  // namespace aphotic::time_text_test
