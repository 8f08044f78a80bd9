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

// The points of a grid's columns or rows are at the places that POV-Ray looks up, with the rays of
// the places that pixels see.
struct Line {
    double at_px;
    double sees_px;
};

// From the first pixel to the last, whose rays POV-Ray all looks up at one place. Rays of
// antialiased pixels are at least an 18th of a pixel from the pixel's borders.
std::vector<Line> lines_along(int pixels, int cells) {
    constexpr double kNoRay = 1.0 / 32.0;
    constexpr double kBeyond = 0.25;
    constexpr double kBeforeFirst = 0.09;  // POV-Ray's table of faces has no entry for u <= -0.1
    const double last = pixels - 1.0;
    std::vector<Line> lines;
    if (pixels > 1) lines.push_back({std::max(0.0, 0.5 - kBeforeFirst * pixels), 0.0});
    for (int i = 0; i <= cells; ++i) {
        const double middle = 0.5 + (last - 1.0) * i / std::max(1, cells);
        lines.push_back({middle, middle});
    }
    if (pixels > 1) lines.push_back({last - kNoRay, last - kNoRay});
    lines.push_back({last - 0.5 * kNoRay, pixels - 0.5});
    lines.push_back({last + kBeyond, pixels - 0.5});
    return lines;
}

struct Grid {
    std::vector<Line> columns;
    std::vector<Line> rows;
    double depth;  // m, for the interpolation of (x, y, m z)

    [[nodiscard]] std::size_t points() const { return columns.size() * rows.size(); }
    [[nodiscard]] std::size_t faces() const { return 2 * (columns.size() - 1) * (rows.size() - 1); }
};

// A grid of square cells. POV-Ray counts from below, so the last row is the image's first.
Grid grid_of_cells(const Camera& camera, int cells) {
    const auto along = [&](int pixels) {
        const double share = double(pixels) / std::max(camera.width_px, camera.height_px);
        return lines_along(pixels,
                           std::min(static_cast<int>(std::ceil(cells * share)), pixels - 2));
    };
    Grid grid{.columns = along(camera.width_px),
              .rows = along(camera.height_px),
              .depth = camera.lens->is_fisheye ? 1.0 : 8.0};
    for (Line& row : grid.rows) {
        row = {.at_px = camera.height_px - row.at_px, .sees_px = camera.height_px - row.sees_px};
    }
    return grid;
}

// The largest error in the middles of the cells' edges and diagonals.
double error_rad(const Camera& camera, const Grid& grid) {
    const Vector3d stretch(1.0, 1.0, grid.depth);
    double worst = 0.0;
    const auto see =
        [&](const Line& column_a, const Line& row_a, const Line& column_b, const Line& row_b) {
            const Vector3d a = direction_in_air(camera, column_a.sees_px, row_a.sees_px);
            const Vector3d b = direction_in_air(camera, column_b.sees_px, row_b.sees_px);
            const Vector3d sum =
                a.cwiseProduct(stretch).normalized() + b.cwiseProduct(stretch).normalized();
            const Vector3d ray = direction_in_air(camera,
                                                  0.5 * (column_a.sees_px + column_b.sees_px),
                                                  0.5 * (row_a.sees_px + row_b.sees_px));
            worst = std::max(worst, (sum.cwiseQuotient(stretch).normalized() - ray).norm());
        };
    for (std::size_t r = 0; r + 1 < grid.rows.size(); ++r) {
        for (std::size_t c = 0; c + 1 < grid.columns.size(); ++c) {
            see(grid.columns[c], grid.rows[r], grid.columns[c + 1], grid.rows[r + 1]);
            see(grid.columns[c], grid.rows[r], grid.columns[c + 1], grid.rows[r]);
            see(grid.columns[c], grid.rows[r], grid.columns[c], grid.rows[r + 1]);
        }
    }
    return worst;
}

Grid grid_of(const Camera& camera) {
    constexpr int kFirstCells = 16;
    // Inside a face, the interpolation of a quadratic errs by up to 4/3 of its error in the middles
    // of the sides.
    constexpr double kOnSidesRad = 0.75 * kRayErrorRad;
    constexpr double kRoom = 1.02;  // errors fall with the square of the cells, within this
    const int longest = std::max(camera.width_px, camera.height_px);
    for (int cells = kFirstCells;;) {
        Grid grid = grid_of_cells(camera, cells);
        const double finer = kRoom * std::sqrt(error_rad(camera, grid) / kOnSidesRad);
        if (finer <= kRoom || cells >= longest) return grid;
        cells = static_cast<int>(std::min<double>(longest, std::ceil(cells * finer)));
    }
}

// Corners are in the order that POV-Ray does not change. In any other order it exchanges the first
// two, but their normals only if these differ by 1e-5.
std::string faces_sdl(const Grid& grid) {
    std::string faces;
    const std::size_t across = grid.columns.size();
    for (std::size_t r = 0; r + 1 < grid.rows.size(); ++r) {
        for (std::size_t c = 0; c + 1 < across; ++c) {
            const std::size_t first = r * across + c;
            const std::size_t last = first + across + 1;
            fmt::format_to(std::back_inserter(faces),
                           ",<{},{},{}>\n,<{},{},{}>\n",
                           first,
                           first + 1,
                           last,
                           first,
                           last,
                           last - 1);
        }
    }
    return faces;
}

}  // namespace

std::uint64_t bytes_of_rays(const Camera& camera) {
    constexpr std::uint64_t kHeader_bytes = 400;
    constexpr std::uint64_t kPoint_bytes = 130;  // two numbers of 5 letters, three of 16, two of 22
    constexpr std::uint64_t kFace_bytes = 30;    // three numbers of 8
    const Grid grid = grid_of(camera);
    return kHeader_bytes + kPoint_bytes * grid.points() + kFace_bytes * grid.faces();
}

std::string camera_rays_sdl(const Camera& camera) {
    const Grid grid = grid_of(camera);
    std::string places;
    std::string normals;
    std::string uvs;
    for (std::size_t r = 0; r < grid.rows.size(); ++r) {
        for (std::size_t c = 0; c < grid.columns.size(); ++c) {
            const Line& column = grid.columns[c];
            const Line& row = grid.rows[r];
            const Vector3d ray = to_povray(direction_in_air(camera, column.sees_px, row.sees_px));
            fmt::format_to(std::back_inserter(places), ",<{},{},0>*1e-12\n", c, r);
            fmt::format_to(std::back_inserter(normals),
                           ",<{:.9g},{:.9g},{:.9g}>\n",
                           ray.x(),
                           ray.y(),
                           grid.depth * ray.z());
            fmt::format_to(std::back_inserter(uvs),
                           ",<{},{}>\n",
                           (column.at_px - 0.5) / camera.width_px,
                           1.0 - (row.at_px - 0.5) / camera.height_px);
        }
    }
    return fmt::format(
        "// The rays of {} x {} pixels at {} x {} points. Written by aphotic.\n"
        "#declare Aphotic_Camera_Rays = mesh2 {{\n"
        "vertex_vectors {{ {}\n{}}}\nnormal_vectors {{ {}\n{}}}\nuv_vectors {{ {}\n{}}}\n"
        "face_indices {{ {}\n{}}}\nscale <1, 1, {}>\n}}\n",
        camera.width_px,
        camera.height_px,
        grid.columns.size(),
        grid.rows.size(),
        grid.points(),
        places,
        grid.points(),
        normals,
        grid.points(),
        uvs,
        grid.faces(),
        faces_sdl(grid),
        grid.depth);
}

}  // namespace aphotic
