// SPDX-License-Identifier: BSD-3-Clause
//
// The part of the command that links the libraries for all formats but OpenEXR (any_image.h),
// loaded when one of its functions is first asked for.
#pragma once

namespace aphotic {

// A RunError when there is no such part, or none of this version.
[[nodiscard]] void* function_of_part(const char* name);

template <typename Function>
[[nodiscard]] Function from_part(const char* name) {
    return reinterpret_cast<Function>(function_of_part(name));
}

}  // namespace aphotic
