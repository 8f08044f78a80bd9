// SPDX-License-Identifier: BSD-3-Clause
//
// Detects images made by the reference tracer instead of POV-Ray, from the text attribute
// aphotic:renderer of its OpenEXR images. Compared with the reference, they would be compared with
// themselves.
#pragma once

#include <filesystem>

namespace aphotic {

inline constexpr const char* kRendererAttribute = "aphotic:renderer";
inline constexpr const char* kReferenceTracer = "reference tracer";

// False if there is no such file or it cannot be read, which others report.
[[nodiscard]] bool is_traced(const std::filesystem::path& image);

}  // namespace aphotic
