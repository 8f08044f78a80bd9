// SPDX-License-Identifier: BSD-3-Clause
//
// A mesh from any text.
#include "fuzz.h"
#include "rig/file/mesh_reader.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    aphotic::expect_result_or_placed_error("mesh.obj", [&] {
        const aphotic::Mesh mesh =
            aphotic::parse_mesh("mesh.obj", aphotic::text_of(data, size), {0.5, -0.25, 2.0});
        for (const auto& corners : mesh.triangles) {
            for (const int corner : corners)
                static_cast<void>(mesh.vertices_m.at(static_cast<std::size_t>(corner)));
        }
    });
    return 0;
}
