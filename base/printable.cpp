// SPDX-License-Identifier: BSD-3-Clause
#include "base/printable.h"

#include <fmt/format.h>

#include <cstddef>

namespace aphotic {
namespace {

// The bytes of the control character at the front of a text, 0 when there is none. Those beyond
// ASCII are two bytes of UTF-8: 0xC2, then 0x80 to 0x9F.
std::size_t control_length(std::string_view text) {
    const auto byte = static_cast<unsigned char>(text[0]);
    if (byte < 0x20 || byte == 0x7F) return 1;
    const auto next = static_cast<unsigned char>(text.size() > 1 ? text[1] : 0);
    return byte == 0xC2 && next >= 0x80 && next < 0xA0 ? 2 : 0;
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

}  // namespace aphotic
