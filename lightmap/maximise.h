// SPDX-License-Identifier: BSD-3-Clause
//
// Searches for the maximum of a function over the unit cube, by NLopt. The function need not be
// smooth, nor continuous: a minimum over pixels has a crease wherever another pixel becomes the
// darkest.
//
//   Global   controlled random search with local mutation (CRS2-LM; Kaelo and Ali, J. Optim. Theory
//            Appl. 130, 2006): 10 (n + 1) points drawn over the cube, the start among them
//   Local    Nelder and Mead's simplex in subspaces (Sbplx, after Rowan's Subplex, 1990)
//
// Both use only the function's values. The caller keeps the best that it saw. The same seed gives
// the same points, in the same order.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace aphotic {

enum class SearchWay { Global, Local };

struct SearchEffort {
    int evaluations = 1000;   // at most
    double first_step = 0.1;  // of a local search, each way
    std::uint64_t seed = 1;
};

// An exception from value() ends the search and is rethrown.
void maximise(SearchWay way,
              const std::vector<double>& start,
              const SearchEffort& effort,
              const std::function<double(std::span<const double>)>& value);

}  // namespace aphotic
