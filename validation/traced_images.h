// SPDX-License-Identifier: BSD-3-Clause
//
// The reference tracer's images in a folder, with the names of a render's: image.exr, and
// spectral.exr with the tracer's planes. Their metadata names the tracer.
#pragma once

#include "image/output_images.h"
#include "spectral/manifest.h"
#include "validation/tracer.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace aphotic {

// options: the tracer's. progress: share of the rows. Returns the camera's signal.
[[nodiscard]] CameraImage write_traced_images(const Tracer& tracer,
                                              const TraceOptions& options,
                                              const std::filesystem::path& folder,
                                              const std::string& version,
                                              const std::optional<ManifestModel>& model,
                                              const std::function<void(double)>& progress);

}  // namespace aphotic
