// SPDX-License-Identifier: BSD-3-Clause
#include "base/atomic_file.h"
#include "support/run_command.h"

#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>
#include <string>

namespace aphotic::help_command_test {
namespace {

TEST(HelpCommand, PrintsWhatTheOptionDoes) {
    const TempFolder folder;
    const auto out = [&](const std::vector<std::string>& arguments) {
        const CommandResult run = run_aphotic(folder.path(), arguments);
        EXPECT_EQ(run.status, 0) << run.err;
        EXPECT_EQ(run.err, "");
        return run.out;
    };
    EXPECT_NE(out({"--help"}), "");
    EXPECT_EQ(out({"help"}), out({"--help"}));
    for (const char* command : {"render", "plan", "data", "help"})
        EXPECT_EQ(out({"help", command}), out({command, "--help"}));
}

// Words of an option that is gone would stay in cli/options.toml unseen; one without words is found
// by any use of its command.
TEST(HelpCommand, SaysAllThatTheTableOfOptionsHas) {
    const TempFolder folder;
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
        const std::string help = run_aphotic(folder.path(), {command, "--help"}).out;
        for (const std::string& name : names)
            EXPECT_NE(help.find(name), std::string::npos) << command << " " << name;
        all += help;
    }
    for (const std::string& name : of_all) EXPECT_NE(all.find(name), std::string::npos) << name;
}

}  // namespace
}  // namespace aphotic::help_command_test
