// SPDX-License-Identifier: BSD-3-Clause
#include "light/tile_image.h"

namespace aphotic {

std::array<Tile, 4> quarters(const Tile& tile) {
    const int left = (tile.width + 1) / 2;
    const int top = (tile.height + 1) / 2;
    return {{{tile.column, tile.row, left, top},
             {tile.column + left, tile.row, tile.width - left, top},
             {tile.column, tile.row + top, left, tile.height - top},
             {tile.column + left, tile.row + top, tile.width - left, tile.height - top}}};
}

std::vector<Tile> tiles_of(const ImageRows& rows, int tile_px) {
    std::vector<Tile> tiles;
    for (int row = rows.first / tile_px * tile_px; row < rows.first + rows.count; row += tile_px) {
        for (int column = 0; column < rows.width_px; column += tile_px) {
            tiles.push_back({.column = column,
                             .row = row,
                             .width = std::min(tile_px, rows.width_px - column),
                             .height = std::min(tile_px, rows.height_px - row)});
        }
    }
    return tiles;
}

bool is_within(const Tile& tile, const ImageRows& rows) {
    return tile.row >= rows.first && tile.row + tile.height <= rows.first + rows.count;
}

TilePlaneMap plane_in(const ImageRows& rows, std::size_t plane, const Tile& tile) {
    const std::size_t line = plane * static_cast<std::size_t>(rows.count) +
                             static_cast<std::size_t>(tile.row - rows.first);
    float* const first =
        rows.samples + line * static_cast<std::size_t>(rows.width_px) + tile.column;
    TilePlaneMap map(first, tile.height, tile.width, Eigen::OuterStride<>(rows.width_px));
    map.setZero();
    return map;
}

TilePlaneMap plane_of(TilePlane& plane) {
    return {plane.data(), plane.rows(), plane.cols(), Eigen::OuterStride<>(plane.cols())};
}

void copy_rows(const std::vector<TilePlane>& planes, const Tile& tile, const ImageRows& rows) {
    const int first = std::max(tile.row, rows.first);
    const int end = std::min(tile.row + tile.height, rows.first + rows.count);
    for (std::size_t c = 0; c < planes.size(); ++c) {
        for (int row = first; row < end; ++row) {
            const std::size_t line = c * static_cast<std::size_t>(rows.count) +
                                     static_cast<std::size_t>(row - rows.first);
            std::copy_n(
                &planes[c](row - tile.row, 0),
                tile.width,
                rows.samples + line * static_cast<std::size_t>(rows.width_px) + tile.column);
        }
    }
}

}  // namespace aphotic
