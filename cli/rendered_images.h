// SPDX-License-Identifier: BSD-3-Clause
//
// A finished render's images, prepared for comparison with the reference.
#pragma once

#include "spectral/light_family.h"
#include "spectral/manifest.h"
#include "validation/validation.h"

#include <filesystem>

namespace aphotic::cli {

// Throws InputError if the reference tracer made one of them, which would be compared with itself.
void require_rendered(const std::filesystem::path& folder);

// family: of the rendered plan, for the shifts of frames shared behind a port.
[[nodiscard]] RenderedImages images_in(const std::filesystem::path& folder,
                                       const Rig& rig,
                                       const Manifest& manifest,
                                       const LightFamily& family);

}  // namespace aphotic::cli
