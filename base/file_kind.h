// SPDX-License-Identifier: BSD-3-Clause
//
// What a file is that was given in the place of text, by its first bytes: "a PNG image", "a zip
// archive, such as .xlsx or .npz". So a message can say more than that the text makes no sense.
#pragma once

#include <string_view>

namespace aphotic {

// Empty: none that is known.
[[nodiscard]] std::string_view binary_kind(std::string_view bytes);

}  // namespace aphotic
