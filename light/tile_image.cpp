// SPDX-License-Identifier: BSD-3-Clause
#include "light/tile_image.h"

#include <cassert>

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
    const int end = rows.first + rows.count;
    assert(rows.first % tile_px == 0 && (end % tile_px == 0 || end == rows.height_px));
    for (int row = rows.first; row < end; row += tile_px) {
        for (int column = 0; column < rows.width_px; column += tile_px) {
            tiles.push_back({.column = column,
                             .row = row,
                             .width = std::min(tile_px, rows.width_px - column),
                             .height = std::min(tile_px, rows.height_px - row)});
        }
    }
    return tiles;
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

}  // namespace aphotic
