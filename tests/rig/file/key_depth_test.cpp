// SPDX-License-Identifier: BSD-3-Clause
#include "rig/file/key_depth.h"

#include "base/error.h"
#include "support/refusal.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <toml++/toml.h>

#include <algorithm>

namespace aphotic::key_depth_test {
namespace {

std::string error_of(const std::string& toml) {
    return refusal_of([&] { require_shallow_keys(toml, "rig.toml"); });
}

std::string refusal(int line) {
    return fmt::format(
        "rig.toml:{0}: found a dotted key of more than {1} parts; allowed: "
        "up to {1}",
        line,
        kMostKeyParts);
}

// a.a.a
std::string key_of(std::size_t parts, const std::string& part = "a", const std::string& dot = ".") {
    std::string key = part;
    for (std::size_t i = 1; i < parts; ++i) key += dot + part;
    return key;
}

const std::string kDeep = key_of(kMostKeyParts + 1);

// That TOML has them as keys at all, its library says.
TEST(KeyDepth, IsCountedWhereverAKeyStands) {
    for (const std::string part : {"a", "'.'", "\".#=\"", "\"\\\"\"", "'\\'", "''", "\"\""}) {
        for (const char* dot : {".", " . ", "\t."}) {
            const std::string most = key_of(kMostKeyParts, part, dot);
            const std::string deep = key_of(kMostKeyParts + 1, part, dot);
            for (const char* form : {"{} = 1",
                                     "\n\n[{}]",
                                     "[[{}]]",
                                     "x = {{ {} = 1 }}",
                                     "x = {{ y = 1.5, {} = 1 }}",
                                     "x = [1, {{ {} = 1 }}]",
                                     "x = 1  # a comment\n{} = 1",
                                     "x = '\"'\n{} = 2",
                                     "x = \"'\\\"\"\n{} = 2",
                                     "x = '''a' '' \"\"\" \\'''\n{} = 2",
                                     "x = {{ y = \"\"\"a\"\"\"\", {} = 1 }}",
                                     "x = {{ y = \"\"\"a\"\"\"\"\", {} = 1 }}",
                                     "x = {{ y = '''a'''', {} = 1 }}",
                                     "x = {{ y = '''a''''', {} = 1 }}",
                                     "x = \"\"\"\n\\\"\"\"\"\n{} = 2"}) {
                const std::string toml = fmt::format(fmt::runtime(form), deep);
                EXPECT_NO_THROW(static_cast<void>(toml::parse(toml))) << toml;
                const auto lines =
                    std::count(toml.begin(), toml.begin() + long(toml.find(deep)), '\n');
                EXPECT_EQ(error_of(toml), refusal(1 + int(lines))) << toml;
                EXPECT_EQ(error_of(fmt::format(fmt::runtime(form), most)), "nothing was said");
            }
        }
    }
}

TEST(KeyDepth, IsNotThatOfTextsCommentsAndNumbers) {
    for (const char* form : {"# {}",
                             "x = 1 # '{}",
                             "x = '{}'",
                             "x = \"{}\"",
                             "x = \"\\\"{}\"",
                             "x = '''\n{}\n'''",
                             "x = \"\"\"\n\\\"\"\" {}\n\"\"\"",
                             "x = \"\"\"{}\"\"\"\"\"",
                             "['{}']",
                             "'{}'.b = 1"}) {
        const std::string toml = fmt::format(fmt::runtime(form), kDeep);
        EXPECT_NO_THROW(static_cast<void>(toml::parse(toml))) << toml;
        EXPECT_EQ(error_of(toml), "nothing was said") << toml;
    }
    std::string numbers = "x = [";
    for (std::size_t i = 0; i <= 2 * kMostKeyParts; ++i) numbers += "1.5, ";
    EXPECT_EQ(error_of(numbers + "]"), "nothing was said");
}

// What is no TOML is the library's to refuse: it stops there, whatever follows.
TEST(KeyDepth, EndsWithTheText) {
    for (const char* toml :
         {"", "x = '", "x = \"\\", "x = \"\"\"\\", "x = '''", "x = \"\"\"\"", "#"})
        EXPECT_EQ(error_of(toml), "nothing was said") << toml;
}

}  // namespace
}  // namespace aphotic::key_depth_test
