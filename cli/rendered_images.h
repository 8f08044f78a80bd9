// SPDX-License-Identifier: BSD-3-Clause
//
// A finished render's images, as the reference is to see them.
#pragma once

#include "spectral/light_family.h"
#include "spectral/manifest.h"
#include "validation/validation.h"

#include <filesystem>

namespace aphotic::cli {

// Throws InputError when the reference tracer made one of them: it would be held against itself.
void require_rendered(const std::filesystem::path& folder);

// family: of the plan that was rendered, for what frames shared behind a port may shift.
[[nodiscard]] RenderedImages images_in(const std::filesystem::path& folder,
                                       const Rig& rig,
                                       const Manifest& manifest,
                                       const LightFamily& family);

}  // namespace aphotic::cli
