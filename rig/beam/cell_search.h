// SPDX-License-Identifier: BSD-3-Clause
//
// Finds the interval between increasing nodes that contains a number, for many numbers: even bins
// store the interval at their start, and few contain a node past it.
//
//   cell k     from nodes[k] to below nodes[k + 1]
//
// Numbers below the first node are in the first cell, those at or above the last node in the last.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace aphotic {

class CellSearch {
  public:
    CellSearch() = default;
    // Two nodes or more.
    explicit CellSearch(std::vector<double> nodes) : nodes_(std::move(nodes)) {
        constexpr std::size_t kBinsPerCell = 4;
        const std::size_t cells = nodes_.size() - 1;
        const std::size_t bins = kBinsPerCell * cells;
        const double width = (nodes_.back() - nodes_.front()) / static_cast<double>(bins);
        last_bin_ = static_cast<double>(bins - 1);
        bins_per_unit_ = 1.0 / width;
        for (std::size_t bin = 0; bin < bins; ++bin) {
            // A node at the start of a bin, as with evenly spaced nodes, is not inside it.
            constexpr double kRounding = 1e-9;
            const double start = nodes_.front() + (static_cast<double>(bin) + kRounding) * width;
            const auto above = std::upper_bound(nodes_.begin() + 1, nodes_.end() - 1, start);
            cell_of_bin_.push_back(static_cast<std::size_t>(above - nodes_.begin()) - 1);
        }
    }

    [[nodiscard]] std::size_t operator()(double x) const {
        const double bin = std::clamp((x - nodes_.front()) * bins_per_unit_, 0.0, last_bin_);
        std::size_t cell = cell_of_bin_[static_cast<std::size_t>(bin)];
        while (cell + 2 < nodes_.size() && x >= nodes_[cell + 1]) ++cell;
        while (cell > 0 && x < nodes_[cell]) --cell;
        return cell;
    }
    [[nodiscard]] const std::vector<double>& nodes() const { return nodes_; }

  private:
    std::vector<double> nodes_;
    std::vector<std::size_t> cell_of_bin_;
    double bins_per_unit_ = 0.0;
    double last_bin_ = 0.0;
};

}  // namespace aphotic
