// SPDX-License-Identifier: BSD-3-Clause
#include "base/parallel.h"

#include <gtest/gtest.h>

#include <barrier>
#include <numeric>
#include <stdexcept>

namespace aphotic::parallel_test {
namespace {

TEST(ParallelFor, DoesEachPieceOnce) {
    constexpr std::size_t kPieces = 1000;
    for (const std::size_t threads : {1U, 2U, 7U}) {
        std::vector<int> done(kPieces);
        parallel_for(kPieces, threads, [&](std::size_t i, std::size_t) { ++done[i]; });
        EXPECT_EQ(done, std::vector<int>(kPieces, 1)) << threads;
    }
}

TEST(ParallelFor, OfNothingDoesNothing) {
    parallel_for(0, 3, [](std::size_t, std::size_t) { FAIL(); });
}

// Neither passes the barrier alone.
TEST(ParallelFor, WorksSideBySideAndTellsTheThread) {
    std::barrier both(2);
    std::vector<int> pieces_of(2);
    parallel_for(2, 2, [&](std::size_t, std::size_t thread) {
        both.arrive_and_wait();
        ++pieces_of[thread];
    });
    EXPECT_EQ(pieces_of, (std::vector<int>{1, 1}));
}

TEST(ParallelFor, WhatAPieceThrowsEndsAllAndComesOut) {
    constexpr std::size_t kPieces = 100000;
    for (const std::size_t threads : {1U, 4U}) {
        std::vector<int> done(kPieces);
        EXPECT_THROW(parallel_for(kPieces,
                                  threads,
                                  [&](std::size_t i, std::size_t) {
                                      if (i == 10) throw std::runtime_error("the eleventh");
                                      ++done[i];
                                  }),
                     std::runtime_error);
        EXPECT_EQ(done[10], 0);
        EXPECT_EQ(std::accumulate(done.begin(), done.begin() + 10, 0), 10);
        if (threads > 1) continue;
        EXPECT_EQ(std::accumulate(done.begin() + 10, done.end(), 0), 0);
    }
}

}  // namespace
}  // namespace aphotic::parallel_test
