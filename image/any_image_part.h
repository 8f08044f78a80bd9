// SPDX-License-Identifier: BSD-3-Clause
//
// The part of the command that links the libraries for all formats except OpenEXR (any_image.h),
// loaded on first use.
#pragma once

namespace aphotic {

// A RunError if the part is missing or of another version.
[[nodiscard]] void* function_of_part(const char* name);

template <typename Function>
[[nodiscard]] Function from_part(const char* name) {
    return reinterpret_cast<Function>(function_of_part(name));
}

}  // namespace aphotic
