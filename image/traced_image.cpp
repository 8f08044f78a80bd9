// SPDX-License-Identifier: BSD-3-Clause
#include "image/traced_image.h"

#include "base/error.h"
#include "image/exr.h"

namespace aphotic {

bool is_traced(const std::filesystem::path& image) {
    if (!std::filesystem::exists(image)) return false;
    try {
        return ExrReader(image).attribute(kRendererAttribute) == kReferenceTracer;
    } catch (const RunError&) {
        return false;
    }
}

}  // namespace aphotic
