// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/camera_rays.h"

#include "rig/camera/lens.h"
#include "rig/geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

namespace aphotic {

using Eigen::Vector3d;

namespace {

// Along a side of the image: the middles of the first and last pixel, points between them, and one
// beyond each, for POV-Ray takes a pixel that lies in no face to be black.
std::vector<double> points_along(int pixels, int cells) {
    constexpr double kBeyond = 0.25;
    std::vector<double> points{0.5 - kBeyond};
    for (int i = 0; i <= cells; ++i) points.push_back(0.5 + (pixels - 1.0) * i / cells);
    points.push_back(pixels - 0.5 + kBeyond);
    return points;
}

struct Grid {
    std::vector<double> columns;
    std::vector<double> rows;

    [[nodiscard]] std::size_t points() const { return columns.size() * rows.size(); }
    [[nodiscard]] std::size_t faces() const { return 2 * (columns.size() - 1) * (rows.size() - 1); }
};

// By how much the middle between two neighbours is off, at the most.
double error_rad(const Camera& camera, const Grid& grid) {
    double worst = 0.0;
    const auto see = [&](double column_a, double row_a, double column_b, double row_b) {
        const Vector3d between =
            (direction_in_air(camera, column_a, row_a) + direction_in_air(camera, column_b, row_b))
                .normalized();
        const Vector3d ray =
            direction_in_air(camera, 0.5 * (column_a + column_b), 0.5 * (row_a + row_b));
        worst = std::max(worst, (between - ray).norm());
    };
    for (std::size_t r = 0; r + 1 < grid.rows.size(); ++r) {
        for (std::size_t c = 0; c + 1 < grid.columns.size(); ++c) {
            const double left = grid.columns[c];
            const double right = grid.columns[c + 1];
            const double above = grid.rows[r];
            const double below = grid.rows[r + 1];
            see(left, above, right, below);
            see(left, above, right, above);
            see(left, above, left, below);
        }
    }
    return worst;
}

Grid grid_of(const Camera& camera) {
    constexpr int kFirstCells = 16;
    const int most = std::max({1, camera.width_px - 1, camera.height_px - 1});
    for (int cells = kFirstCells;; cells = 2 * cells) {
        // Square cells, along the longer side as many.
        const auto along = [&](int pixels) {
            const double share = double(pixels) / std::max(camera.width_px, camera.height_px);
            return std::clamp(
                static_cast<int>(std::ceil(cells * share)), 1, std::max(1, pixels - 1));
        };
        const Grid grid{.columns = points_along(camera.width_px, along(camera.width_px)),
                        .rows = points_along(camera.height_px, along(camera.height_px))};
        if (cells >= most) return grid;
        const double error = error_rad(camera, grid);
        if (error <= kRayErrorRad) return grid;
    }
}

std::uint64_t bytes_of(const Grid& grid) {
    constexpr std::uint64_t kHeader_bytes = 400;
    constexpr std::uint64_t kPoint_bytes =
        110;                                   // two numbers of 10 letters, three of 16, two of 13
    constexpr std::uint64_t kFace_bytes = 26;  // three numbers of 7
    return kHeader_bytes + kPoint_bytes * grid.points() + kFace_bytes * grid.faces();
}

}  // namespace

std::uint64_t bytes_of_rays(const Camera& camera) {
    return bytes_of(grid_of(camera));
}

std::string camera_rays_sdl(const Camera& camera) {
    const Grid grid = grid_of(camera);
    std::string places;
    std::string normals;
    std::string uvs;
    std::string faces;
    for (const double row : grid.rows) {
        for (const double column : grid.columns) {
            const Vector3d ray = to_povray(direction_in_air(camera, column, row));
            fmt::format_to(std::back_inserter(places), ",<{:.7g}e-9,{:.7g}e-9,0>\n", column, -row);
            fmt::format_to(std::back_inserter(normals),
                           ",<{:.9g},{:.9g},{:.9g}>\n",
                           ray.x(),
                           ray.y(),
                           ray.z());
            fmt::format_to(std::back_inserter(uvs),
                           ",<{:.9g},{:.9g}>\n",
                           (column - 0.5) / camera.width_px,
                           1.0 - (row - 0.5) / camera.height_px);
        }
    }
    const std::size_t across = grid.columns.size();
    for (std::size_t r = 0; r + 1 < grid.rows.size(); ++r) {
        for (std::size_t c = 0; c + 1 < across; ++c) {
            const std::size_t first = r * across + c;
            fmt::format_to(std::back_inserter(faces),
                           ",<{},{},{}>\n,<{},{},{}>\n",
                           first,
                           first + 1,
                           first + across + 1,
                           first,
                           first + across + 1,
                           first + across);
        }
    }
    return fmt::format(
        "// The rays of {} x {} pixels at {} x {} points. Written by aphotic.\n"
        "#declare Aphotic_Camera_Rays = mesh2 {{\n"
        "vertex_vectors {{ {}\n{}}}\nnormal_vectors {{ {}\n{}}}\nuv_vectors {{ {}\n{}}}\n"
        "face_indices {{ {}\n{}}}\n}}\n",
        camera.width_px,
        camera.height_px,
        across,
        grid.rows.size(),
        grid.points(),
        places,
        grid.points(),
        normals,
        grid.points(),
        uvs,
        grid.faces(),
        faces);
}

}  // namespace aphotic
