// SPDX-License-Identifier: BSD-3-Clause
//
// Many pieces of work side by side, their results taken in order: what comes of them does not
// depend on how many there are at once.
#pragma once

#include "base/error.h"

#include <algorithm>
#include <cstddef>
#include <deque>
#include <future>

namespace aphotic {

// work(i), in threads, for i from 0 to count - 1, `jobs` of them begun ahead; use(i, its result)
// here, in order. What either of them finds wrong with its input goes to skip(i, what), and the
// others go on. Any other failure ends it all.
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
