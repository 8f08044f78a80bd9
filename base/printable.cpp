// SPDX-License-Identifier: BSD-3-Clause
#include "base/printable.h"

#include <fmt/format.h>

namespace aphotic {
namespace {

// The number of bytes of the control character at the front of a text, or 0. Those beyond ASCII are
// two bytes of UTF-8: 0xC2, then 0x80 to 0x9F.
std::size_t control_length(std::string_view text) {
    const auto byte = static_cast<unsigned char>(text[0]);
    if (byte < 0x20 || byte == 0x7F) return 1;
    const auto next = static_cast<unsigned char>(text.size() > 1 ? text[1] : 0);
    return byte == 0xC2 && next >= 0x80 && next < 0xA0 ? 2 : 0;
}

// The last place up to `place` that lies between two UTF-8 characters.
std::size_t boundary_before(std::string_view text, std::size_t place) {
    constexpr std::size_t kMostBehindFirst = 3;
    for (std::size_t back = 0; back <= kMostBehindFirst && back < place; ++back) {
        if ((static_cast<unsigned char>(text[place - back]) & 0xC0U) != 0x80U) return place - back;
    }
    return place;
}

// Start and end of a longer text, with `most` bytes in all.
std::string without_middle(std::string_view text, std::size_t most) {
    if (text.size() <= most) return std::string(text);
    const std::size_t head = boundary_before(text, most / 2);
    const std::size_t tail = boundary_before(text, text.size() - most / 2);
    return fmt::format(
        "{} ... [{} bytes] ... {}", text.substr(0, head), tail - head, text.substr(tail));
}

}  // namespace

std::string printable(std::string_view text, std::string_view keep) {
    std::string result;
    while (!text.empty()) {
        const std::size_t length = control_length(text);
        if (length == 0 || keep.find(text[0]) != std::string_view::npos) {
            result += text[0];
            text.remove_prefix(1);
            continue;
        }
        result += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[length - 1]));
        text.remove_prefix(length);
    }
    return result;
}

bool has_control_characters(std::string_view text) {
    for (; !text.empty(); text.remove_prefix(1)) {
        if (control_length(text) > 0) return true;
    }
    return false;
}

std::string excerpt(std::string_view text) {
    if (text.size() <= kMostQuoted_bytes) return printable(text);
    return printable(text.substr(0, boundary_before(text, kMostQuoted_bytes))) + "...";
}

std::string shown_text(std::string_view text) {
    return without_middle(printable(without_middle(text, kMostText_bytes)), kMostText_bytes);
}

std::string whole_message(std::string_view text) {
    return without_middle(printable(without_middle(text, kMostMessage_bytes), "\n\t"),
                          kMostMessage_bytes);
}

}  // namespace aphotic
