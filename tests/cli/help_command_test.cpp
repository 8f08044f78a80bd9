// SPDX-License-Identifier: BSD-3-Clause
#include "support/command_test.h"
#include "support/has.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>
#include <string>

namespace aphotic::help_command_test {
namespace {

using HelpCommand = CommandTest;

TEST_F(HelpCommand, PrintsWhatTheOptionDoes) {
    const auto out = [&](const Arguments& arguments) {
        const CommandResult run = done(arguments);
        EXPECT_EQ(run.err, "");
        return run.out;
    };
    EXPECT_NE(out("--help"), "");
    EXPECT_EQ(out({"help"}), out("--help"));
    for (const char* command : {"render", "plan", "data", "help"})
        EXPECT_EQ(out({"help", command}), out(fmt::format("{} --help", command)));
}

// Words of an option that is gone would stay in cli/options.toml unseen; one without words is found
// by any use of its command.
TEST_F(HelpCommand, SaysAllThatTheTableOfOptionsHas) {
    const std::string table = read_text_file(std::string(APHOTIC_SOURCE_DIR) + "/cli/options.toml");
    const std::regex entry(R"re(\[(\w+)\."(--[a-z-]+)"\]\n)re");
    std::map<std::string, std::set<std::string>> options;
    for (auto at = std::sregex_iterator(table.begin(), table.end(), entry);
         at != std::sregex_iterator();
         ++at)
        options[(*at)[1]].insert((*at)[2]);
    const std::set<std::string> of_all = options["shared"];
    options.erase("shared");
    EXPECT_GT(options.size(), 15U);
    std::string all;
    for (const auto& [command, names] : options) {
        const std::string help = aphotic(command + " --help").out;
        for (const std::string& name : names) EXPECT_TRUE(has(help, name)) << command;
        all += help;
    }
    for (const std::string& name : of_all) EXPECT_TRUE(has(all, name));
}

}  // namespace
}  // namespace aphotic::help_command_test
