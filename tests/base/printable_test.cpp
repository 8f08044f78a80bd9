// SPDX-License-Identifier: BSD-3-Clause
#include "base/printable.h"

#include <gtest/gtest.h>

namespace aphotic::printable_test {
namespace {

using namespace std::string_view_literals;

TEST(Printable, LeavesNothingThatSteersATerminal) {
    EXPECT_EQ(printable("a\x1b[2J\nb\x7f"sv), "a\\x1b[2J\\x0ab\\x7f");
    EXPECT_EQ(printable("\0"sv), "\\x00");
    EXPECT_EQ(printable("CSI in UTF-8: \xC2\x9B"sv), "CSI in UTF-8: \\x9b");
}

TEST(Printable, LeavesOtherTextAsItIs) {
    EXPECT_EQ(printable("K\xC3\xB6ln, \xE2\x88\x92 2 \xC2\xB0 C"),
              "K\xC3\xB6ln, \xE2\x88\x92 2 \xC2\xB0 C");
    EXPECT_EQ(printable("no UTF-8: \xFF\xC2"), "no UTF-8: \xFF\xC2");
    EXPECT_EQ(printable("two\nlines\x1b", "\n"), "two\nlines\\x1b");
}

TEST(HasControlCharacters, KnowsThoseOfAsciiAndThoseBeyond) {
    for (const std::string_view text : {"\n"sv, "a\0b"sv, "\x7f"sv, "a\xC2\x85"sv}) {
        EXPECT_TRUE(has_control_characters(text)) << printable(text);
    }
    for (const std::string_view text : {""sv, "a b"sv, "\xC2\xA0"sv, "K\xC3\xB6ln"sv}) {
        EXPECT_FALSE(has_control_characters(text)) << text;
    }
}

}  // namespace
}  // namespace aphotic::printable_test
