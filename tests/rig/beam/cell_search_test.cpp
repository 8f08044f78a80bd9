// SPDX-License-Identifier: BSD-3-Clause
//
// Cells against a plain search, at random numbers, at nodes and beside them.
#include "rig/beam/cell_search.h"

#include "support/random_beam.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace aphotic::cell_search_test {
namespace {

std::size_t searched(const std::vector<double>& nodes, double x) {
    const auto above = std::upper_bound(nodes.begin() + 1, nodes.end() - 1, x);
    return static_cast<std::size_t>(above - nodes.begin()) - 1;
}

TEST(CellSearch, IsAPlainSearch) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        Dice dice(seed);
        std::vector<double> nodes{dice.between(-3.0, 3.0)};
        const int cells = dice.whole(1, 60);
        // Even ones, and some a million times as narrow as others.
        for (int k = 0; k < cells; ++k)
            nodes.push_back(nodes.back() + (seed % 2 == 0 ? 0.1 : dice.over_octaves(1e-6, 1.0)));
        const CellSearch cell(nodes);
        std::vector<double> asked{nodes.front() - 1e9, nodes.back() + 1e9};
        for (const double node : nodes) {
            for (const double x : {node, std::nextafter(node, -1e9), std::nextafter(node, 1e9)})
                asked.push_back(x);
        }
        for (int k = 0; k < 1000; ++k)
            asked.push_back(dice.between(nodes.front() - 0.1, nodes.back() + 0.1));
        for (const double x : asked) ASSERT_EQ(cell(x), searched(nodes, x)) << x;
    }
}

}  // namespace
}  // namespace aphotic::cell_search_test
