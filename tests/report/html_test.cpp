// SPDX-License-Identifier: BSD-3-Clause
#include "report/html.h"

#include <gtest/gtest.h>

#include <limits>

namespace aphotic::html_test {
namespace {

TEST(Escaped, LeavesNothingThatMarkupIsMadeOf) {
    EXPECT_EQ(escaped("<script>alert(\"a\" & 'b')</script>"),
              "&lt;script&gt;alert(&quot;a&quot; &amp; &#39;b&#39;)&lt;/script&gt;");
}

TEST(Escaped, ReplacesControlCharacters) {
    EXPECT_EQ(escaped("a\nb\tc"), "a b c");
    EXPECT_EQ(escaped(std::string_view("a\0b\x1b\x7f", 5)), "a�b��");
    EXPECT_EQ(escaped("\xC2\x85|\xC2\xA0"), "�|\xC2\xA0") << "U+0085, and a blank as it is";
}

TEST(Escaped, KeepsOtherLanguages) {
    EXPECT_EQ(escaped("Öre 深海"), "Öre 深海");
}

TEST(Scientific, HasThreeDigits) {
    const std::string times = "\xC2\xA0×\xC2\xA0";
    EXPECT_EQ(scientific(4.6e-4), "4.60" + times + "10⁻⁴");
    EXPECT_EQ(scientific(-1.234e12), "−1.23" + times + "10¹²");
    EXPECT_EQ(scientific(9.999e-5), "1.00" + times + "10⁻⁴") << "rounded before the exponent";
    EXPECT_EQ(scientific(0.01), "0.0100");
    EXPECT_EQ(scientific(0.8134), "0.813");
    EXPECT_EQ(scientific(999.4), "999");
    EXPECT_EQ(scientific(999.6), "1.00" + times + "10³");
}

TEST(Scientific, SaysWhatIsNotFinite) {
    EXPECT_EQ(scientific(0.0), "0");
    EXPECT_EQ(scientific(std::numeric_limits<double>::infinity()), "∞");
    EXPECT_EQ(scientific(-std::numeric_limits<double>::infinity()), "−∞");
    EXPECT_EQ(scientific(std::numeric_limits<double>::quiet_NaN()), "not a number");
}

TEST(Plain, DropsWhatRoundingLeft) {
    EXPECT_EQ(plain(26.000000000000004), "26");
    EXPECT_EQ(plain(-0.5), "−0.5");
    EXPECT_EQ(plain(-0.0), "0");
}

TEST(Counted, SetsThousandsApart) {
    EXPECT_EQ(grouped_count(1, "frame"), "1 frame");
    EXPECT_EQ(grouped_count(0, "frame"), "0 frames");
    EXPECT_EQ(grouped(999), "999");
    EXPECT_EQ(grouped(1392640),
              "1\xE2\x80\xAF"
              "392\xE2\x80\xAF"
              "640");
}

}  // namespace
}  // namespace aphotic::html_test
