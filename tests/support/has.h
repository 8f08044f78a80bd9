// SPDX-License-Identifier: BSD-3-Clause
//
// Whether a text has these words in it: EXPECT_TRUE(has(run.err, "allowed: ")) shows the text.
#pragma once

#include <gtest/gtest.h>

#include <string_view>

namespace aphotic {

inline testing::AssertionResult has(std::string_view text, std::string_view words) {
    const bool is_there = text.find(words) != std::string_view::npos;
    return (is_there ? testing::AssertionSuccess() : testing::AssertionFailure())
           << "'" << words << "' in:\n"
           << text << "\n";
}

}  // namespace aphotic
