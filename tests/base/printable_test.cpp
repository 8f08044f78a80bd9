// SPDX-License-Identifier: BSD-3-Clause
#include "base/printable.h"

#include "base/error.h"
#include "support/has.h"

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

TEST(Printable, AValueThatIsQuotedHasAnEnd) {
    EXPECT_EQ(excerpt("short\n"), "short\\x0a");
    EXPECT_EQ(excerpt(std::string(kMostQuoted_bytes, 'a')), std::string(kMostQuoted_bytes, 'a'));
    EXPECT_EQ(excerpt(std::string(1'000'000, 'a')), std::string(kMostQuoted_bytes, 'a') + "...");
    // No letter is cut in two.
    std::string text = "a";
    for (int i = 0; i < 1000; ++i) text += "\xC3\xB6";
    EXPECT_EQ(excerpt(text), text.substr(0, kMostQuoted_bytes - 1) + "...");
}

// The file comes first and the cause last.
TEST(Printable, AMessageHasAnEnd) {
    const std::string message =
        whole_message("rig.toml: found " + std::string(20'000'000, '\x1b') + "\nthe cause");
    EXPECT_LT(message.size(), kMostMessage_bytes + 100);
    EXPECT_TRUE(message.starts_with("rig.toml: found \\x1b")) << message.substr(0, 30);
    EXPECT_TRUE(message.ends_with("\\x1b\nthe cause")) << message.substr(message.size() - 30);
    EXPECT_TRUE(has(message, " bytes] "));
}

TEST(Printable, FailuresSteerNoTerminalAndEnd) {
    const std::string name = "\x1b[2J\r\n.toml";
    const std::string cell(6'000'000, 'x');
    const InputError error("{}: {} is '{}'", name, std::string_view("\a"), cell);
    const std::string said = error.what();
    EXPECT_TRUE(said.starts_with("\\x1b[2J\\x0d\\x0a.toml: \\x07 is 'xxx")) << said.substr(0, 50);
    EXPECT_LT(said.size(), kMostMessage_bytes);
    // Lines of our own stay, and so do those of a failure within.
    EXPECT_STREQ(RunError("{}:\n{}", 1, InputError("two\nlines").what()).what(), "1:\ntwo\nlines");
    EXPECT_STREQ(InputError("plain\x07").what(), "plain\\x07");
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
