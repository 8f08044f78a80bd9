// SPDX-License-Identifier: BSD-3-Clause
#include "base/json_text.h"

#include "base/error.h"
#include "support/effort.h"
#include "support/has.h"
#include "support/refusal.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>

namespace aphotic::json_text_test {
namespace {

std::string nested(std::size_t depth) {
    return std::string(depth, '[') + std::string(depth, ']');
}

std::string nested_objects(std::size_t depth) {
    std::string text;
    for (std::size_t i = 0; i < depth; ++i) text += "{\"a\":";
    return text + "1" + std::string(depth, '}');
}

std::string error_of(const std::string& text) {
    return refusal_of([&] { return parse_json(text, "notes.json"); });
}

TEST(ParseJson, ReadsWhatIsThere) {
    const nlohmann::json json = parse_json(R"({"b": [1, 2.5, null], "a": {"c": "d"}})", "f");
    EXPECT_EQ(json.at("b").at(1), 2.5);
    EXPECT_TRUE(json.at("b").at(2).is_null());
    EXPECT_EQ(json.at("a").at("c"), "d");
}

TEST(ParseJson, NamesWhatIsNone) {
    for (const char* text : {"", "{", "{\"a\" 1}", "[1] 2", "NaN", "1e999", "\"\xff\""})
        EXPECT_EQ(error_of(text), "notes.json: not valid JSON") << text;
}

TEST(ParseJson, RefusesToNestDeeperThanItsLimit) {
    const auto refusal = [](std::size_t depth) {
        return fmt::format(
            "notes.json: found values nested {} deep; allowed: up to {}", depth, kMostJsonDepth);
    };
    constexpr std::size_t kMost = kMostJsonDepth;
    EXPECT_EQ(error_of(nested(kMost)), "nothing was said");
    EXPECT_EQ(error_of(nested_objects(kMost)), "nothing was said");
    EXPECT_EQ(error_of(nested(kMost + 1)), refusal(kMost + 1));
    EXPECT_EQ(error_of(nested_objects(kMost + 1)), refusal(kMost + 1));
    EXPECT_EQ(error_of(nested(10'000'000)), refusal(10'000'000));
    EXPECT_EQ(error_of("{\"for\\\"mat\\\\\": " + nested(kMost) + "}"), refusal(kMost + 1));
}

TEST(ParseJson, TakesBracketsInTextsForText) {
    const std::string brackets(1000, '[');
    EXPECT_EQ(parse_json("[\"\\\"" + brackets + "\"]", "f").at(0), "\"" + brackets);
}

TEST(WholeNumber, IsOneWithinItsBounds) {
    const nlohmann::json json = parse_json(
        R"({"a": 7, "half": 7.5, "seven": 7.0, "huge": 6.7e122, "most": 18446744073709551615,
            "under": -1, "text": "7"})",
        "f");
    EXPECT_EQ(whole_number_at(json, "a", 1, 7), 7);
    const auto error_at = [&](const std::string& key) -> std::string {
        return refusal_of([&] { return whole_number_at(json, key, 0, 10); });
    };
    for (const auto& [key, found] :
         std::map<std::string, std::string>{{"half", "7.5"},
                                            {"seven", "7.0"},
                                            {"huge", "6.7e+122"},
                                            {"most", "18446744073709551615"},
                                            {"under", "-1"},
                                            {"text", "\"7\""}}) {
        EXPECT_EQ(error_at(key),
                  key + ": found " + found + "; allowed: a whole number from 0 to 10");
    }
    EXPECT_THROW(static_cast<void>(whole_number_at(json, kAccepted)), nlohmann::json::out_of_range);
}

TEST(ParseJson, RefusesAKeyThatStandsTwiceInAnObject) {
    const auto error_of = [](const char* text) -> std::string {
        return refusal_of([&] { return parse_json(text, "f"); });
    };
    EXPECT_EQ(error_of(R"({"a": {"b": 1}, "b": {"b": 2}, "c": [{"b": 1}, {"b": 1}]})"), kAccepted);
    EXPECT_EQ(error_of(R"({"a": {"b": 1, "c": {"b": 1}, "b": 2}})"),
              "f: duplicate key 'b' in an object");
}

// Where each key was held against all before it, a million would take an hour.
TEST(ParseJson, TakesAMillionKeys) {
    constexpr int kKeys = cases(1'000'000);
    std::string text = "{\"first\": 0";
    for (int i = 0; i < kKeys; ++i) text += fmt::format(",\"{}\":{}", i, i);
    const nlohmann::json json = parse_json(text + "}", "f");
    EXPECT_EQ(json.size(), kKeys + 1U);
    EXPECT_EQ(json.at(std::to_string(kKeys - 1)), kKeys - 1);
}

// As it is printed: a title may hold what a terminal obeys.
TEST(JsonText, SteersNoTerminal) {
    const std::string title = "\x1b[2J \x7f \xC2\x9B K\xC3\xB6ln \xC2\xA0";
    const std::string text = json_text({{"title", title}});
    EXPECT_FALSE(has_control_characters(text.substr(0, text.find('\n')))) << text;
    EXPECT_TRUE(has(text, "\\u007f \\u009b K\xC3\xB6ln \xC2\xA0"));
    EXPECT_EQ(parse_json(text, "text").at("title"), title);
}

}  // namespace
}  // namespace aphotic::json_text_test
