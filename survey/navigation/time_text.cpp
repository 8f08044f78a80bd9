// SPDX-License-Identifier: BSD-3-Clause
#include "survey/navigation/time_text.h"

#include "base/csv.h"
#include "base/number.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <regex>

namespace aphotic {
namespace {

constexpr double kMinute_s = 60.0;
constexpr double kHour_s = 3600.0;

// 2024-03-09, or 09.03.2024, since dates with points begin with the day; a time; a fraction of a
// second; Z or hours and minutes ahead of UTC.
std::optional<double> calendar_time_s(std::string_view text) {
    constexpr std::size_t kMostLetters = 100;  // including digits
    static const std::regex kTime(
        "(?:([0-9]{4})([-/:])([0-9]{2})\\2([0-9]{2})|([0-9]{2})\\.([0-9]{2})\\.([0-9]{4}))[ T]"
        "([0-9]{2}):([0-9]{2}):([0-9]{2})(?:[.,]([0-9]+))?"
        " ?(?:[Zz]|([+-])([0-9]{2}):?([0-9]{2}))?");
    std::match_results<std::string_view::const_iterator> found;
    if (text.size() > kMostLetters || !std::regex_match(text.begin(), text.end(), found, kTime))
        return std::nullopt;
    const auto number = [&](std::size_t group) {
        return read_number<int>(found[group].str()).value_or(0);
    };
    const bool is_year_first = found[1].matched;
    const int hours_ahead = number(13);
    const int minutes_ahead = number(14);
    if (hours_ahead > 14 || minutes_ahead > 59) return std::nullopt;
    const double part_s = read_number<double>("0." + found[11].str()).value_or(0.0);
    const auto time_s = unix_time_s({.year = number(is_year_first ? 1 : 7),
                                     .month = number(is_year_first ? 3 : 6),
                                     .day = number(is_year_first ? 4 : 5),
                                     .hour = number(8),
                                     .minute = number(9),
                                     .second = number(10) + part_s});
    if (!time_s) return std::nullopt;
    const double ahead_s = hours_ahead * kHour_s + minutes_ahead * kMinute_s;
    return found[12].str() == "-" ? *time_s + ahead_s : *time_s - ahead_s;
}

std::optional<double> seconds_in(std::string_view text) {
    constexpr double kMost_s = 1e11;  // larger numbers are milliseconds
    const auto seconds = read_number<double>(text);
    return seconds && std::abs(*seconds) < kMost_s ? seconds : std::nullopt;
}

}  // namespace

std::optional<double> unix_time_s(const DateAndTime& time) {
    using namespace std::chrono;
    const year_month_day date{year(time.year),
                              month(static_cast<unsigned>(time.month)),
                              day(static_cast<unsigned>(time.day))};
    // A leap second is the first of the next minute, as in POSIX.
    const bool is_of_clock = time.hour >= 0 && time.hour < 24 && time.minute >= 0 &&
                             time.minute < 60 && time.second >= 0.0 && time.second < 61.0;
    if (!date.ok() || !is_of_clock) return std::nullopt;
    const auto days_s = static_cast<double>(seconds(sys_days(date).time_since_epoch()).count());
    return days_s + time.hour * kHour_s + time.minute * kMinute_s + time.second;
}

std::optional<double> unix_time_s(std::string_view text) {
    const std::string_view content = trimmed(text);
    if (const auto seconds = seconds_in(content)) return seconds;
    return calendar_time_s(content);
}

std::string utc_text(double unix_time_s) {
    using namespace std::chrono;
    const sys_time<milliseconds> time(
        milliseconds(static_cast<std::int64_t>(std::llround(unix_time_s * 1000.0))));
    const auto midnight = floor<days>(time);
    const year_month_day date(midnight);
    const hh_mm_ss clock(time - midnight);
    return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}Z",
                       static_cast<int>(date.year()),
                       static_cast<unsigned>(date.month()),
                       static_cast<unsigned>(date.day()),
                       clock.hours().count(),
                       clock.minutes().count(),
                       clock.seconds().count(),
                       clock.subseconds().count());
}

std::string exif_time(double unix_time_s) {
    constexpr std::size_t kToTheSecond = 19;
    std::string text = utc_text(std::floor(unix_time_s)).substr(0, kToTheSecond);
    std::ranges::replace(text, '-', ':');
    std::ranges::replace(text, 'T', ' ');
    return text;
}

}  // namespace aphotic
