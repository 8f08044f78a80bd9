// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic data, as a user runs it.
#include "support/command_test.h"
#include "support/has.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace aphotic::data_test {
namespace {

namespace fs = std::filesystem;

class CommandData : public CommandTest {
  protected:
    static Arguments data(const Arguments& arguments) { return "data" + arguments; }
};

TEST_F(CommandData, ListsEveryTableOnALineOfItsOwn) {
    const CommandResult list = done(data({}));
    for (const std::string& name :
         Arguments("pope-fry-1997 pure-2016 xenon-flash xenon-arc sand green-algae brown-algae "
                   "red-algae nikon-d5100 cie-1931 cie-d65 cie-led-b4 cie-led-b5 bk7 fused-silica "
                   "sapphire pmma polycarbonate quan-fry-1995")) {
        EXPECT_TRUE(has(list.out, std::string("\n") + name + " ")) << name;
    }
}

TEST_F(CommandData, ShowsATableWithItsSource) {
    const CommandResult table = done(data({"pope-fry-1997"}), "8710");
    EXPECT_TRUE(has(table.out, "550"));
    EXPECT_TRUE(has(table.out, "0.0565")) << "Pope and Fry at 550 nm";
}

// What --csv prints is itself a table that a rig can name.
TEST_F(CommandData, CsvCanBeGivenBack) {
    const CommandResult csv = done(data("xenon-flash --csv"));
    EXPECT_TRUE(csv.out.starts_with("wavelength_nm,relative_power\n380,0.00161351\n"))
        << csv.out.substr(0, 80);
    write_file(path("lamp.csv"), csv.out);
    done(data({"lamp.csv"}), "lamp spectrum");
}

TEST_F(CommandData, JsonHoldsTheValues) {
    const auto json = json_by(data("sand --json"));
    EXPECT_EQ(json["name"], "sand");
    EXPECT_EQ(json["values"][0], (std::vector<double>{350.0, 0.223}));
}

TEST_F(CommandData, PlotsAreDrawn) {
    done(data("pope-fry-1997 --plot water.svg"));
    EXPECT_GT(fs::file_size(path("water.svg")), 1000U);
    done(data("bk7 --plot glass.svg"));
    for (const std::string file : {"sand.pdf", "sand.png"}) {
        refused(data(fmt::format("sand --plot {}", file)),
                "--plot: found " + file + "; allowed: a name that ends in .svg");
    }
}

TEST_F(CommandData, UnknownNameNamesTheNearest) {
    refused(data({"pope-fry-1979"}), "pope-fry-1997");
}

}  // namespace
}  // namespace aphotic::data_test
