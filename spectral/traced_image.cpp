// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/traced_image.h"

#include "spectral/error.h"
#include "spectral/exr.h"

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
