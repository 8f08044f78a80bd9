// SPDX-License-Identifier: BSD-3-Clause
#include "validation/traced_images.h"

#include "image/exr.h"
#include "image/row_blocks.h"

#include <algorithm>

namespace aphotic {

CameraImage write_traced_images(const Tracer& tracer,
                                const TraceOptions& options,
                                const std::filesystem::path& folder,
                                const std::string& version,
                                const std::optional<ManifestModel>& model,
                                const std::function<void(double)>& progress) {
    const Camera& camera = tracer.rig().camera;
    ExrAttributes attributes{{"aphotic:version", version},
                             {"aphotic:rig_title", tracer.rig().title},
                             {"aphotic:rig_sha256", tracer.rig().digest},
                             {kRendererAttribute, kReferenceTracer}};
    if (model) attributes.emplace_back(kModelErrorAttribute, attribute_of(*model));
    OutputImages images(folder, camera.width_px, camera.height_px, options.planes_nm, attributes);
    const int block = traced_rows(camera.width_px, tracer.planes(), options.threads);
    for (int row = 0; row < camera.height_px; row += block) {
        const int rows = std::min(block, camera.height_px - row);
        const std::vector<double> samples = tracer.rows(row, rows);
        images.write_rows(rows, {samples.begin(), samples.end()});
        progress(static_cast<double>(row + rows) / camera.height_px);
    }
    return images.finish();
}

}  // namespace aphotic
