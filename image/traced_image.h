// SPDX-License-Identifier: BSD-3-Clause
//
// Which images the reference tracer made, and not POV-Ray: it says so in the text attribute
// aphotic:renderer of its OpenEXR images. Held against the reference, they would be held against
// themselves.
#pragma once

#include <filesystem>

namespace aphotic {

inline constexpr const char* kRendererAttribute = "aphotic:renderer";
inline constexpr const char* kReferenceTracer = "reference tracer";

// False if there is no such file or it cannot be read: reporting that is up to others.
[[nodiscard]] bool is_traced(const std::filesystem::path& image);

}  // namespace aphotic
