// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers in text: in files, in options, in other programs' output. All of our text uses the
// decimal point, whatever locale the host of our libraries has set: strtod, stod, streams and the
// like would read 12.5 as 12 in a locale with a decimal comma. scripts/banned allows only
// std::from_chars, which ignores the locale. Blanks and a leading + are not part of a number.
#pragma once

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace aphotic {

// Reads the number at the front of a text and advances the text past it. Empty if there is no
// number, which leaves the text as it is, or if the type cannot hold it, which skips it.
template <typename Number>
[[nodiscard]] std::optional<Number> read_leading_number(std::string_view& text) {
    Number number{};
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return fault == std::errc{} ? std::optional(number) : std::nullopt;
}

// The number if the whole text is one. nan and inf are numbers.
template <typename Number>
[[nodiscard]] std::optional<Number> read_number(std::string_view text) {
    const std::optional<Number> number = read_leading_number<Number>(text);
    return text.empty() ? number : std::nullopt;
}

// In other programs' files, which may write a leading +.
[[nodiscard]] inline std::optional<double> finite_number(std::string_view word) {
    if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
    const auto number = read_number<double>(word);
    return number && std::isfinite(*number) ? number : std::nullopt;
}

// The double nearest to a value's first significant digits, so that it prints with no more: 120 for
// 120.00000000000001.
[[nodiscard]] inline double rounded_to_digits(double value, int digits) {
    return read_number<double>(fmt::format("{:.{}g}", value, digits)).value_or(value);
}

}  // namespace aphotic
