// SPDX-License-Identifier: BSD-3-Clause
#include "support/command_test.h"

#include <gtest/gtest.h>

namespace aphotic::unknown_word_test {
namespace {

struct Mistake {
    Arguments arguments;
    std::string said;
};

using UnknownWord = CommandTest;

TEST_F(UnknownWord, IsNamedWithTheOneThatWasMeant) {
    for (const Mistake& mistake : std::vector<Mistake>{
             {"rendr rig.toml --tolerance 1",
              "aphotic: found rendr; no such command: did you mean render?\n"},
             {{"frobnicate"}, "aphotic: found frobnicate; no such command; --help lists them\n"},
             {"plan rig.toml --tolerence 1",
              "aphotic plan: found --tolerence; no such option: did you mean --tolerance?\n"},
             {"plan rig.toml --tolerence=1",
              "aphotic plan: found --tolerence; no such option: did you mean --tolerance?\n"},
             {"render rig.toml --outptu out",
              "aphotic render: found --outptu; no such option: did you mean --output?\n"},
             {"plan rig.toml --xyzzy",
              "aphotic plan: found --xyzzy; no such option; --help lists them\n"},
             {{"--versoin"}, "aphotic: found --versoin; no such option: did you mean --version?\n"},
             {{"help", "pln"},
              "aphotic: help: found pln; no such command: did you mean plan?\n"}}) {
        const CommandResult run = aphotic(mistake.arguments);
        EXPECT_EQ(run.status, 2) << mistake.said;
        EXPECT_EQ(run.err, mistake.said);
        EXPECT_EQ(run.out, "");
    }
}

}  // namespace
}  // namespace aphotic::unknown_word_test
