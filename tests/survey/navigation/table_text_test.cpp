// SPDX-License-Identifier: BSD-3-Clause
//
// Tables taken apart. What is expected follows from RFC 4180, and from the marks of comments.
#include "survey/navigation/table_text.h"

#include "base/error.h"
#include "support/refusal.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

namespace aphotic::table_text_test {
namespace {

using Rows = std::vector<std::vector<std::string>>;

Rows rows_of(std::string_view text, char separator = ',') {
    TableText table("t", text);
    Rows rows;
    while (table.find_row(separator)) rows.push_back(table.take_row(separator).fields);
    return rows;
}

std::string fault_of(std::string_view text, char separator = ',') {
    return refusal_of([&] { return rows_of(text, separator); });
}

TEST(TableText, AnySeparatorPartsFields) {
    const Rows expected{{"a", "", "c d"}, {"1", "2", ""}};
    EXPECT_EQ(rows_of("a,,c d\n1,2,\n"), expected);
    EXPECT_EQ(rows_of("a;; c d \n1;2;\n", ';'), expected);
    EXPECT_EQ(rows_of("a\t\tc d\n1\t2\t\n", '\t'), expected);
    EXPECT_EQ(rows_of("\tb\n", '\t'), (Rows{{"", "b"}}));
    EXPECT_EQ(rows_of("  a \t b\n1   2  \n", kByBlanks), (Rows{{"a", "b"}, {"1", "2"}}));
}

TEST(TableText, LinesEndInAnyWay) {
    const Rows expected{{"a", "b"}, {"1", "2"}};
    for (const char* text : {"a,b\n1,2\n", "a,b\r\n1,2\r\n", "a,b\r1,2\r", "a,b\n\n1,2"})
        EXPECT_EQ(rows_of(text), expected) << text;
}

TEST(TableText, QuotesHoldSeparatorsQuotesAndLineEnds) {
    EXPECT_EQ(rows_of("\"a,\"\"b\"\"\", \"c\nd\" ,\"\"\n1,2,3\n"),
              (Rows{{"a,\"b\"", "c\nd", ""}, {"1", "2", "3"}}));
    EXPECT_EQ(rows_of("\"a b\" 2\n", kByBlanks), (Rows{{"a b", "2"}}));
    TableText table("t", "\"a\r\nb\",1\r\nc,2");
    ASSERT_TRUE(table.find_row(','));
    EXPECT_EQ(table.take_row(',').line, 1U);
    ASSERT_TRUE(table.find_row(','));
    const TextRow last = table.take_row(',');
    EXPECT_EQ(last.line, 3U);
    EXPECT_FALSE(last.has_line_end);
}

// Else one quote too many would swallow the rest of the table.
TEST(TableText, QuotesThatDoNotCloseAreLetters) {
    EXPECT_EQ(rows_of("a,\"open\nb,\"closed\"\n"), (Rows{{"a", "\"open"}, {"b", "closed"}}));
    EXPECT_EQ(rows_of("\"a\" b,2\n"), (Rows{{"\"a\" b", "2"}}));
}

TEST(TableText, CommentsOfAnyMarkArePassedOver) {
    const Rows expected{{"a", "b"}, {"1", "2"}};
    for (const char* mark : {"# x, y", "% x", "// x", "; x", "/* x */", "/* x\n y, z\n*/", "  # x"})
        EXPECT_EQ(rows_of(std::string(mark) + "\na,b\n" + mark + "\n1,2\n"), expected) << mark;
    EXPECT_EQ(rows_of(";x\n", ';'), (Rows{{"", "x"}}));
    EXPECT_EQ(rows_of("/home/a.tif,2\n"), (Rows{{"/home/a.tif", "2"}}));
    EXPECT_EQ(fault_of("a,b\n/* x\n1,2\n"),
              "t:2: found a comment that begins with /* and has no */");
}

TEST(TableText, FieldsHaveLimits) {
    EXPECT_EQ(fault_of(std::string(kMostTableFields, ',')),
              "t:1: found more than 10000 fields in a line");
    EXPECT_EQ(fault_of("a\n" + std::string(kMostFieldBytes + 1, 'x')),
              "t:2: found a field of 65537 characters; allowed: up to 65536");
}

}  // namespace
}  // namespace aphotic::table_text_test
