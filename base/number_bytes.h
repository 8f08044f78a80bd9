// SPDX-License-Identifier: BSD-3-Clause
//
// A number of a binary file, from its bytes, in the byte order of both the files and this machine:
// little-endian. The bytes need no alignment.
#pragma once

#include <bit>
#include <cstring>

namespace aphotic {

static_assert(std::endian::native == std::endian::little);

template <typename Number, typename As>
[[nodiscard]] As number_at(const void* bytes) {
    Number number{};
    std::memcpy(&number, bytes, sizeof number);
    return static_cast<As>(number);
}

}  // namespace aphotic
