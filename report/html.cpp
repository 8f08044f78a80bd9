// SPDX-License-Identifier: BSD-3-Clause
#include "report/html.h"

#include "base/number.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace aphotic {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD
constexpr std::string_view kMinus = "−";                   // U+2212
constexpr std::string_view kTimes = "\xC2\xA0×\xC2\xA0";   // between non-breaking blanks
constexpr std::string_view kNarrowBlank = "\xE2\x80\xAF";  // U+202F, non-breaking

std::string with_minus(const std::string& number) {
    return number.starts_with('-') ? std::string(kMinus) + number.substr(1) : number;
}

std::string superscript(int number) {
    static constexpr std::array<std::string_view, 10> kDigits{
        "⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string result;
    for (const char digit : fmt::format("{}", number)) {
        if (digit == '-') {
            result += "⁻";
        } else {
            result += kDigits[static_cast<std::size_t>(digit - '0')];
        }
    }
    return result;
}

// The second byte of U+0080 to U+009F, which follow 0xC2 in UTF-8.
bool is_upper_control(unsigned char first, unsigned char second) {
    return first == 0xC2 && second >= 0x80 && second < 0xA0;
}

}  // namespace

std::string escaped(std::string_view text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto byte = static_cast<unsigned char>(text[i]);
        const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : ' ');
        if (byte == '<') {
            result += "&lt;";
        } else if (byte == '>') {
            result += "&gt;";
        } else if (byte == '&') {
            result += "&amp;";
        } else if (byte == '"') {
            result += "&quot;";
        } else if (byte == '\'') {
            result += "&#39;";
        } else if (byte == '\n' || byte == '\t' || byte == '\r') {
            result += ' ';
        } else if (byte < 0x20 || byte == 0x7F) {
            result += kReplacement;
        } else if (is_upper_control(byte, next)) {
            result += kReplacement;
            ++i;
        } else {
            result += text[i];
        }
    }
    return result;
}

std::string scientific(double value) {
    if (std::isnan(value)) return "not a number";
    if (std::isinf(value)) return value > 0.0 ? "∞" : std::string(kMinus) + "∞";
    if (value == 0.0) return "0";
    // Via text, so that 9.999e-5 is rounded to 1.00e-4 before the exponent is read.
    const std::string text = fmt::format("{:.2e}", value);
    const std::size_t split = text.find('e');
    const int exponent = exponent_of(text);
    if (exponent >= -2 && exponent < 3)
        return with_minus(fmt::format("{:.{}f}", value, 2 - exponent));
    return fmt::format(
        "{}{}10{}", with_minus(text.substr(0, split)), kTimes, superscript(exponent));
}

int exponent_of(std::string_view text) {
    std::string_view digits = text.substr(text.find('e') + 1);
    if (digits.starts_with('+')) digits.remove_prefix(1);
    return read_number<int>(digits).value();
}

std::string power_label(double factor, int exponent) {
    if (factor == 1.0) return "10" + superscript(exponent);
    return fmt::format("{}{}10{}", plain(factor), kTimes, superscript(exponent));
}

std::string plain(double value) {
    return with_minus(fmt::format("{:.6g}", value == 0.0 ? 0.0 : value));
}

std::string grouped_count(std::size_t count, std::string_view noun) {
    return fmt::format("{} {}{}", grouped(count), noun, count == 1 ? "" : "s");
}

std::string grouped(std::size_t count) {
    std::string digits = fmt::format("{}", count);
    for (auto i = static_cast<std::ptrdiff_t>(digits.size()) - 3; i > 0; i -= 3)
        digits.insert(static_cast<std::size_t>(i), kNarrowBlank);
    return digits;
}

}  // namespace aphotic
