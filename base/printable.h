// SPDX-License-Identifier: BSD-3-Clause
//
// Text from outside, for a message of one line: a control character, which could break the line or
// steer a terminal, stands as \x1b. Other bytes, UTF-8 or not, stay as they are.
#pragma once

#include <string>
#include <string_view>

namespace aphotic {

// keep: control characters that may stay.
[[nodiscard]] std::string printable(std::string_view text, std::string_view keep = {});

// U+0000 to U+001F, U+007F to U+009F.
[[nodiscard]] bool has_control_characters(std::string_view text);

}  // namespace aphotic
