// SPDX-License-Identifier: BSD-3-Clause
#include "survey/navigation_cell.h"

#include "base/number.h"
#include "base/printable.h"
#include "base/words.h"
#include "rig/photometric_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>

namespace aphotic {
namespace {

// What loggers, databases and spreadsheets write when they know no number, besides NaN itself.
bool is_unknown(std::string_view field) {
    static constexpr std::array<std::string_view, 8> kUnknown{
        "", "-", "na", "n/a", "#n/a", "null", "none", "1.#qnan"};
    return std::ranges::find(kUnknown, lower_case(std::string(field))) != kUnknown.end();
}

// 2,15, as spreadsheets of half of Europe write it.
bool has_decimal_comma(std::string_view field) {
    const std::size_t comma = field.find(',');
    return comma != std::string_view::npos && comma > 0 && comma + 1 < field.size() &&
           field.find_first_not_of("+-0123456789eE,") == std::string_view::npos;
}

}  // namespace

double number_in(ImagePose& pose, std::string_view column, std::string_view field) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    if (is_unknown(field)) return kNone;
    const std::string_view digits = field.starts_with('+') ? field.substr(1) : field;
    if (const auto number = read_number<double>(digits)) return *number;
    if (pose.fault.empty()) {
        pose.fault = fmt::format("{}: found {}; allowed: a number{}",
                                 column,
                                 shown_word(field),
                                 has_decimal_comma(field) ? " with a decimal point" : "");
    }
    return kNone;
}

}  // namespace aphotic
