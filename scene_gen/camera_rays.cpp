// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/camera_rays.h"

#include "image/image_size.h"
#include "rig/camera/lens.h"
#include "rig/geometry.h"

#include <fmt/format.h>

#include <iterator>

namespace aphotic {

int rows_above(const Camera& camera) {
    return camera.lens ? kRowsAbove : 0;
}

std::uint64_t bytes_of_rays(const Camera& camera) {
    constexpr std::uint64_t kBytesPerRay = 112;  // three numbers of 15 letters, three of 9
    return kBytesPerRay * size_of(camera.width_px) * size_of(camera.height_px);
}

std::string camera_rays_sdl(const Camera& camera) {
    const long long pixels = static_cast<long long>(camera.width_px) * camera.height_px;
    std::string sdl = fmt::format(
        "// The rays of {} x {} pixels, row by row. Written by aphotic.\n"
        "#declare Aphotic_Camera_Rays = mesh2 {{ vertex_vectors {{ {}\n",
        camera.width_px,
        camera.height_px,
        3 * pixels);
    const auto out = std::back_inserter(sdl);
    for (int row = 0; row < camera.height_px; ++row) {
        for (int column = 0; column < camera.width_px; ++column) {
            const Eigen::Vector3d ray =
                to_povray(direction_in_air(camera, column + 0.5, row + 0.5));
            const double x = ray.x() / ray.z();
            const double y = ray.y() / ray.z();
            fmt::format_to(out,
                           ",<-1,-1,{:.9g}>,<-1,2,{:.9g}>,<2,-1,{:.9g}>\n",
                           x + y,
                           x - 2.0 * y,
                           y - 2.0 * x);
        }
    }
    fmt::format_to(out, "}} face_indices {{ {}\n", pixels);
    for (long long pixel = 0; pixel < pixels; ++pixel) {
        const long long first = 3 * pixel;
        fmt::format_to(out, ",<{},{},{}>\n", first, first + 1, first + 2);
    }
    sdl += "} }\n";
    return sdl;
}

}  // namespace aphotic
