// SPDX-License-Identifier: BSD-3-Clause
//
// Independent pieces of work, taken by threads as they become free.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace aphotic {

// Runs work(i, thread) once for each i below `count`, in threads 0 to threads - 1; the caller is
// thread 0. The order is unspecified: results do not depend on `threads` if each piece has its own
// place for them. After a piece throws, no other starts, and the exception is rethrown when all
// threads have ended.
template <class Work>
void parallel_for(std::size_t count, std::size_t threads, const Work& work) {
    std::atomic<std::size_t> next = 0;
    std::mutex mutex;
    std::exception_ptr fault;
    const auto take = [&](std::size_t thread) {
        try {
            for (std::size_t i = next++; i < count; i = next++) work(i, thread);
        } catch (...) {
            next = count;
            const std::scoped_lock lock(mutex);
            if (!fault) fault = std::current_exception();
        }
    };
    {
        std::vector<std::jthread> others;
        for (std::size_t t = 1; t < std::min(threads, count); ++t) others.emplace_back(take, t);
        take(0);
    }
    if (fault) std::rethrow_exception(fault);
}

}  // namespace aphotic
