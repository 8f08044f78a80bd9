// SPDX-License-Identifier: BSD-3-Clause
//
// The element of rank n/2 among n sorted numbers, counted from 0: the median, or the upper of the
// two middle ones if n is even. NaN for none.
#pragma once

#include <algorithm>
#include <iterator>
#include <limits>
#include <vector>

namespace aphotic {

// Reorders the numbers.
template <typename T>
[[nodiscard]] T upper_median(std::vector<T>& numbers) {
    if (numbers.empty()) return std::numeric_limits<T>::quiet_NaN();
    const auto middle = numbers.begin() + std::ssize(numbers) / 2;
    std::ranges::nth_element(numbers, middle);
    return *middle;
}

}  // namespace aphotic
