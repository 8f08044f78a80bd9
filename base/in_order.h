// SPDX-License-Identifier: BSD-3-Clause
//
// Parallel pieces of work whose results are used in order, so that the outcome does not depend on
// the number of threads.
#pragma once

#include "base/error.h"

#include <algorithm>
#include <cstddef>
#include <deque>
#include <future>

namespace aphotic {

// Runs work(i) in threads for i from 0 to count - 1, at most `jobs` ahead, and calls use(i, its
// result) here, in order. An InputError of either goes to skip(i, what) and the others continue.
// Any other failure ends everything.
template <typename Work, typename Use, typename Skip>
void in_order(std::size_t count, int jobs, const Work& work, const Use& use, const Skip& skip) {
    std::deque<decltype(std::async(std::launch::async, work, std::size_t{0}))> ahead;
    std::size_t begun = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t wanted = std::min(count, i + static_cast<std::size_t>(jobs));
        for (; begun < wanted; ++begun)
            ahead.push_back(std::async(std::launch::async, work, begun));
        try {
            use(i, ahead.front().get());
        } catch (const InputError& error) {
            skip(i, error.what());
        }
        ahead.pop_front();
    }
}

}  // namespace aphotic
