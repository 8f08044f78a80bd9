// SPDX-License-Identifier: BSD-3-Clause
//
// Times as loggers and cameras write them, as seconds since 1970-01-01 00:00 UTC, without leap
// seconds (POSIX): 2024-03-09 12:34:56.789 is 1709987696.789. A double holds them to 0.3
// microseconds.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace aphotic {

struct DateAndTime {
    int year = 0;
    int month = 0;
    int day = 0;
    int hour = 0;
    int minute = 0;
    double second = 0.0;
};

// UTC. Empty if the date or the time of day does not exist.
[[nodiscard]] std::optional<double> unix_time_s(const DateAndTime& time);

// These seconds themselves, below 1e11; or
//
//   2024-03-09 12:34:56.789
//
// with - / or : in the date, or a date such as 09.03.2024, a blank or T before the time, a fraction
// of a second of any length, and at the end nothing or Z for UTC, or an offset from it such as
// +02:00 or -0330. Otherwise empty.
[[nodiscard]] std::optional<double> unix_time_s(std::string_view text);

// 2024-03-09T12:34:56.789Z
[[nodiscard]] std::string utc_text(double unix_time_s);
// 2024:03:09 12:34:56, without the fraction of a second
[[nodiscard]] std::string exif_time(double unix_time_s);

}  // namespace aphotic
