// SPDX-License-Identifier: BSD-3-Clause
#include "survey/time_text.h"

#include "base/csv.h"
#include "base/number.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>

namespace aphotic {
namespace {

constexpr double kMinute_s = 60.0;
constexpr double kHour_s = 3600.0;

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

// Takes a text apart from its beginning.
class Reader {
  public:
    explicit Reader(std::string_view text) : rest_(text) {}

    [[nodiscard]] bool is_at_end() const { return rest_.empty(); }

    // One of these characters, or a null character.
    char one_of(std::string_view characters) {
        if (rest_.empty() || characters.find(rest_.front()) == std::string_view::npos) return '\0';
        const char found = rest_.front();
        rest_.remove_prefix(1);
        return found;
    }

    // A whole number of so many digits.
    std::optional<int> number(std::size_t digits) {
        int value = 0;
        if (rest_.size() < digits) return std::nullopt;
        for (std::size_t i = 0; i < digits; ++i) {
            if (!is_digit(rest_[i])) return std::nullopt;
            value = 10 * value + (rest_[i] - '0');
        }
        rest_.remove_prefix(digits);
        return value;
    }

    // What follows a decimal point, from 0 to 1.
    std::optional<double> fraction() {
        std::size_t digits = 0;
        while (digits < rest_.size() && is_digit(rest_[digits])) ++digits;
        if (digits == 0) return std::nullopt;
        const std::string text = "0." + std::string(rest_.substr(0, digits));
        rest_.remove_prefix(digits);
        return read_number<double>(text);
    }

  private:
    std::string_view rest_;
};

// "", "Z", "+02:00", "-0330": seconds ahead of UTC.
std::optional<double> offset_at(Reader& text) {
    text.one_of(" ");
    if (text.is_at_end() || text.one_of("Zz") != '\0') return 0.0;
    const char sign = text.one_of("+-");
    if (sign == '\0') return std::nullopt;
    const auto hours = text.number(2);
    text.one_of(":");
    const auto minutes = text.number(2);
    if (!hours || !minutes || *hours > 14 || *minutes > 59) return std::nullopt;
    const double ahead_s = *hours * kHour_s + *minutes * kMinute_s;
    return sign == '-' ? -ahead_s : ahead_s;
}

struct CalendarDate {
    std::optional<int> year{};
    std::optional<int> month{};
    std::optional<int> day{};
};

// 2024-03-09, or 09.03.2024: between points the day comes first everywhere. Without a year it is
// none.
CalendarDate date_at(Reader& text) {
    CalendarDate date{.year = text.number(4)};
    const bool is_year_first = date.year.has_value();
    if (!is_year_first) date.day = text.number(2);
    const char mark = text.one_of(is_year_first ? "-/:" : ".");
    date.month = text.number(2);
    if (mark == '\0' || text.one_of({&mark, 1}) == '\0') return {};
    (is_year_first ? date.day : date.year) = text.number(is_year_first ? 2 : 4);
    return date;
}

std::optional<double> calendar_time_s(Reader text) {
    const auto [year, month, day] = date_at(text);
    if (text.one_of(" T") == '\0') return std::nullopt;
    const auto hour = text.number(2);
    if (text.one_of(":") == '\0') return std::nullopt;
    const auto minute = text.number(2);
    if (text.one_of(":") == '\0') return std::nullopt;
    const auto second = text.number(2);
    if (!year || !month || !day || !hour || !minute || !second) return std::nullopt;
    double part_s = 0.0;
    if (text.one_of(".,") != '\0') {
        const auto fraction = text.fraction();
        if (!fraction) return std::nullopt;
        part_s = *fraction;
    }
    const auto ahead_s = offset_at(text);
    if (!ahead_s || !text.is_at_end()) return std::nullopt;
    const auto time_s = unix_time_s({.year = *year,
                                     .month = *month,
                                     .day = *day,
                                     .hour = *hour,
                                     .minute = *minute,
                                     .second = *second + part_s});
    return time_s ? std::optional(*time_s - *ahead_s) : std::nullopt;
}

std::optional<double> seconds_in(std::string_view text) {
    constexpr double kMost_s = 1e11;  // more are milliseconds
    const auto seconds = read_number<double>(text);
    return seconds && std::abs(*seconds) < kMost_s ? seconds : std::nullopt;
}

}  // namespace

std::optional<double> unix_time_s(const DateAndTime& time) {
    using namespace std::chrono;
    const year_month_day date{year(time.year),
                              month(static_cast<unsigned>(time.month)),
                              day(static_cast<unsigned>(time.day))};
    // A leap second is the first of the next minute, as POSIX has it.
    const bool is_of_clock = time.hour >= 0 && time.hour < 24 && time.minute >= 0 &&
                             time.minute < 60 && time.second >= 0.0 && time.second < 61.0;
    if (!date.ok() || !is_of_clock) return std::nullopt;
    const auto days_s = static_cast<double>(seconds(sys_days(date).time_since_epoch()).count());
    return days_s + time.hour * kHour_s + time.minute * kMinute_s + time.second;
}

std::optional<double> unix_time_s(std::string_view text) {
    const std::string_view content = trimmed(text);
    if (const auto seconds = seconds_in(content)) return seconds;
    return calendar_time_s(Reader(content));
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

}  // namespace aphotic
