// SPDX-License-Identifier: BSD-3-Clause
//
// Numbers in text: of files, of options, of what another program prints. All of our text has the
// decimal point, and so it is read, whatever locale the host of our libraries has set: strtod,
// stod, streams and their kin would take 12.5 for 12 where people write 12,5. scripts/banned lets
// nothing read numbers but std::from_chars, which knows no locale. Blanks and a leading + are not
// part of a number.
#pragma once

#include <fmt/format.h>

#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace aphotic {

// The number that a text begins with, which is left at what follows. None where it begins with
// none, and the text stays, or with one that the type cannot hold, which is passed over.
template <typename Number>
[[nodiscard]] std::optional<Number> read_leading_number(std::string_view& text) {
    Number number{};
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return fault == std::errc{} ? std::optional(number) : std::nullopt;
}

// The number that a text is, all of it. nan and inf are numbers.
template <typename Number>
[[nodiscard]] std::optional<Number> read_number(std::string_view text) {
    const std::optional<Number> number = read_leading_number<Number>(text);
    return text.empty() ? number : std::nullopt;
}

// The double next to a value's first significant digits, so that it is printed with no more:
// 120 for 120.00000000000001.
[[nodiscard]] inline double rounded_to_digits(double value, int digits) {
    return read_number<double>(fmt::format("{:.{}g}", value, digits)).value_or(value);
}

}  // namespace aphotic
