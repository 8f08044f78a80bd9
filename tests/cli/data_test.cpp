// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic data, as a user runs it.
#include "support/run_command.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace aphotic {
namespace {

namespace fs = std::filesystem;

constexpr int kBadInput = 2;

class CommandData : public testing::Test {
  protected:
    CommandResult data(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), "data");
        return run_aphotic(folder_.path(), arguments);
    }

    TempFolder folder_;
};

TEST_F(CommandData, ListsEveryTableOnALineOfItsOwn) {
    const CommandResult list = data({});
    ASSERT_EQ(list.status, 0) << list.err;
    for (const char* name : {"pope-fry-1997",
                             "pure-2016",
                             "xenon-flash",
                             "xenon-arc",
                             "sand",
                             "green-algae",
                             "brown-algae",
                             "red-algae",
                             "nikon-d5100",
                             "cie-1931",
                             "cie-d65",
                             "bk7",
                             "fused-silica",
                             "sapphire",
                             "pmma",
                             "polycarbonate",
                             "quan-fry-1995"}) {
        EXPECT_NE(list.out.find(std::string("\n") + name + " "), std::string::npos) << name;
    }
}

TEST_F(CommandData, ShowsATableWithItsSource) {
    const CommandResult table = data({"pope-fry-1997"});
    ASSERT_EQ(table.status, 0) << table.err;
    EXPECT_NE(table.out.find("8710"), std::string::npos) << "the citation's first page";
    EXPECT_NE(table.out.find("550"), std::string::npos);
    EXPECT_NE(table.out.find("0.0565"), std::string::npos) << "Pope and Fry at 550 nm";
}

// What --csv prints is itself a table that a rig can name.
TEST_F(CommandData, CsvCanBeGivenBack) {
    const CommandResult csv = data({"xenon-flash", "--csv"});
    ASSERT_EQ(csv.status, 0);
    EXPECT_TRUE(csv.out.starts_with("wavelength_nm,relative_power\n380,0.00161351\n"))
        << csv.out.substr(0, 80);
    write_file(folder_.path() / "lamp.csv", csv.out);
    const CommandResult checked = data({"lamp.csv"});
    EXPECT_EQ(checked.status, 0) << checked.err;
    EXPECT_NE(checked.out.find("lamp spectrum"), std::string::npos) << checked.out;
}

TEST_F(CommandData, JsonHoldsTheValues) {
    const CommandResult run = data({"sand", "--json"});
    ASSERT_EQ(run.status, 0) << run.err;
    const auto json = nlohmann::json::parse(run.out);
    EXPECT_EQ(json["name"], "sand");
    EXPECT_EQ(json["values"][0], (std::vector<double>{350.0, 0.223}));
}

TEST_F(CommandData, PlotsAreDrawn) {
    for (const char* file : {"water.png", "water.svg"}) {
        const CommandResult run = data({"pope-fry-1997", "--plot", file});
        EXPECT_EQ(run.status, 0) << run.err;
        EXPECT_GT(fs::file_size(folder_.path() / file), 1000U) << file;
    }
    EXPECT_EQ(data({"bk7", "--plot", "glass.svg"}).status, 0);
    EXPECT_EQ(data({"sand", "--plot", "sand.pdf"}).status, kBadInput);
    EXPECT_FALSE(fs::exists(folder_.path() / "sand.pdf"));
}

TEST_F(CommandData, UnknownNameNamesTheNearest) {
    const CommandResult run = data({"pope-fry-1979"});
    EXPECT_EQ(run.status, kBadInput);
    EXPECT_NE(run.err.find("pope-fry-1997"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace aphotic
