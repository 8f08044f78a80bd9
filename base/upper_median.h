// SPDX-License-Identifier: BSD-3-Clause
//
// Of n numbers in order the one of rank n/2, counted from 0: the median, of an even count the upper
// of the two in the middle. NaN of none.
#pragma once

#include <algorithm>
#include <iterator>
#include <limits>
#include <vector>

namespace aphotic {

// Leaves the numbers in another order.
template <typename T>
[[nodiscard]] T upper_median(std::vector<T>& numbers) {
    if (numbers.empty()) return std::numeric_limits<T>::quiet_NaN();
    const auto middle = numbers.begin() + std::ssize(numbers) / 2;
    std::ranges::nth_element(numbers, middle);
    return *middle;
}

}  // namespace aphotic
