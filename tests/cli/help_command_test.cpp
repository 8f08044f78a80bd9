// SPDX-License-Identifier: BSD-3-Clause
#include "support/run_command.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace aphotic::help_command_test
