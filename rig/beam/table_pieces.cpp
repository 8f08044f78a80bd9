// SPDX-License-Identifier: BSD-3-Clause
#include "rig/beam/table_pieces.h"

#include <Eigen/QR>

#include <cstddef>
#include <optional>

namespace aphotic {
namespace {

using Eigen::Index;

TablePiece straight(const BeamTable& table, std::size_t first, std::size_t last) {
    const double start = table.intensity[first];
    return {.first_rad = table.vertical_rad[first],
            .last_rad = table.vertical_rad[last],
            .c = {start, table.intensity[last] - start, 0.0, 0.0}};
}

// Fitted at the nodes and midway between them.
std::optional<TablePiece> cubic(const BeamTable& table,
                                std::size_t first,
                                std::size_t last,
                                double most_off) {
    TablePiece piece = straight(table, first, last);
    const auto places = static_cast<Index>(2 * (last - first) + 1);
    Eigen::MatrixX4d powers(places, 4);
    Eigen::VectorXd values(places);
    for (Index k = 0; k < places; ++k) {
        const std::size_t below = first + static_cast<std::size_t>(k / 2);
        const std::size_t above = first + static_cast<std::size_t>((k + 1) / 2);
        const double V = 0.5 * (table.vertical_rad[below] + table.vertical_rad[above]);
        const double x = (V - piece.first_rad) / (piece.last_rad - piece.first_rad);
        powers.row(k) << 1.0, x, x * x, x * x * x;
        values(k) = 0.5 * (table.intensity[below] + table.intensity[above]);
    }
    const Eigen::Vector4d c = powers.colPivHouseholderQr().solve(values);
    if (!((powers * c - values).cwiseAbs().maxCoeff() <= most_off)) return std::nullopt;
    piece.c = {c(0), c(1), c(2), c(3)};
    return piece;
}

}  // namespace

std::vector<TablePiece> pieces_of(const BeamTable& table, double off) {
    const double most_off = off * largest_intensity(table);
    const std::size_t end = table.vertical_rad.size();
    std::vector<TablePiece> pieces;
    for (std::size_t first = 0; first + 1 < end;) {
        std::size_t last = first + 1;
        TablePiece piece = straight(table, first, last);
        while (off > 0.0 && last + 1 < end) {
            const auto longer = cubic(table, first, last + 1, most_off);
            if (!longer) break;
            piece = *longer;
            ++last;
        }
        pieces.push_back(piece);
        first = last;
    }
    return pieces;
}

}  // namespace aphotic
