// SPDX-License-Identifier: BSD-3-Clause
//
// The whole table of extremes through real POV-Ray, at few pixels.
#include "support/run_command.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace aphotic::stress_test {
namespace {

TEST(StressCommand, EveryExtremeComesOutAsTheTableSays) {
    const TempFolder folder;
    const CommandResult run =
        run_aphotic(folder.path(), {"stress", "-o", "out", "--width", "6", "--json"});
    const auto cases = nlohmann::json::parse(run.out);
    EXPECT_GT(cases.size(), 150U);
    for (const auto& one : cases) {
        EXPECT_TRUE(one.at("as_expected").get<bool>()) << one.dump(2);
    }
    EXPECT_EQ(run.status, 0) << run.err;
}

TEST(StressCommand, PartOfTheTableByName) {
    const TempFolder folder;
    const CommandResult run = run_aphotic(
        folder.path(), {"stress", "-o", "out", "--width", "6", "--only", "roll-degrees-45"});
    EXPECT_EQ(run.status, 0) << run.out << run.err;
    EXPECT_NE(run.out.find("1 case, 0 not as expected"), std::string::npos) << run.out;
    EXPECT_NE(read_text_file(folder.path() / "out" / "stress.md").find("| 45 |"),
              std::string::npos);
}

TEST(StressCommand, ANameThatFitsNoCaseIsRefused) {
    const TempFolder folder;
    const CommandResult run =
        run_aphotic(folder.path(), {"stress", "-o", "out", "--only", "no such case"});
    EXPECT_EQ(run.status, 2) << run.out;
    EXPECT_NE(run.err.find("--only: found 'no such case'"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace aphotic::stress_test
