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

constexpr int kBadInput = 2;

class CommandData : public CommandTest {
  protected:
    CommandResult data(const Arguments& arguments) { return aphotic("data" + arguments); }
};

TEST_F(CommandData, ListsEveryTableOnALineOfItsOwn) {
    const CommandResult list = data({});
    ASSERT_EQ(list.status, 0) << list.err;
    for (const std::string& name :
         Arguments("pope-fry-1997 pure-2016 xenon-flash xenon-arc sand green-algae brown-algae "
                   "red-algae nikon-d5100 cie-1931 cie-d65 cie-led-b4 cie-led-b5 bk7 fused-silica "
                   "sapphire pmma polycarbonate quan-fry-1995")) {
        EXPECT_TRUE(has(list.out, std::string("\n") + name + " ")) << name;
    }
}

TEST_F(CommandData, ShowsATableWithItsSource) {
    const CommandResult table = data({"pope-fry-1997"});
    ASSERT_EQ(table.status, 0) << table.err;
    EXPECT_TRUE(has(table.out, "8710")) << "the citation's first page";
    EXPECT_TRUE(has(table.out, "550"));
    EXPECT_TRUE(has(table.out, "0.0565")) << "Pope and Fry at 550 nm";
}

// What --csv prints is itself a table that a rig can name.
TEST_F(CommandData, CsvCanBeGivenBack) {
    const CommandResult csv = data("xenon-flash --csv");
    ASSERT_EQ(csv.status, 0);
    EXPECT_TRUE(csv.out.starts_with("wavelength_nm,relative_power\n380,0.00161351\n"))
        << csv.out.substr(0, 80);
    write_file(path("lamp.csv"), csv.out);
    const CommandResult checked = data({"lamp.csv"});
    EXPECT_EQ(checked.status, 0) << checked.err;
    EXPECT_TRUE(has(checked.out, "lamp spectrum"));
}

TEST_F(CommandData, JsonHoldsTheValues) {
    const CommandResult run = data("sand --json");
    ASSERT_EQ(run.status, 0) << run.err;
    const auto json = nlohmann::json::parse(run.out);
    EXPECT_EQ(json["name"], "sand");
    EXPECT_EQ(json["values"][0], (std::vector<double>{350.0, 0.223}));
}

TEST_F(CommandData, PlotsAreDrawn) {
    const CommandResult run = data("pope-fry-1997 --plot water.svg");
    EXPECT_EQ(run.status, 0) << run.err;
    EXPECT_GT(fs::file_size(path("water.svg")), 1000U);
    EXPECT_EQ(data("bk7 --plot glass.svg").status, 0);
    for (const std::string file : {"sand.pdf", "sand.png"}) {
        const CommandResult refused = data(fmt::format("sand --plot {}", file));
        EXPECT_EQ(refused.status, kBadInput);
        EXPECT_TRUE(
            has(refused.err, "--plot: found " + file + "; allowed: a name that ends in .svg"));
        EXPECT_FALSE(fs::exists(path(file)));
    }
}

constexpr const char* kSplines =
    "#declare D_Clay_01 = spline { linear_spline 380, 0.021 // blue\n"
    "  400, 0.03, 730 .5 }\n"
    "#declare D_Mud = spline { cubic_spline 380, 0.1 400, 0.2 500, 0.3 730, 0.4 }\n";

TEST_F(CommandData, MakesTablesOfSplines) {
    write_file(path("things.inc"), kSplines);
    const CommandResult run = data("--from-spline things.inc -o tables");
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_EQ(run.out,
              "wrote tables/d-clay-01.csv: D_Clay_01, 380 to 730 nm, 3 rows\n"
              "wrote tables/d-mud.csv: D_Mud, 380 to 730 nm, 4 rows\n");
    EXPECT_EQ(run.err,
              "aphotic: things.inc:3: D_Mud is a cubic_spline: its knots are taken, and joined by "
              "straight lines\n");
    const CommandResult checked = data("tables/d-clay-01.csv --json");
    ASSERT_EQ(checked.status, 0) << checked.err;
    const auto json = nlohmann::json::parse(checked.out);
    EXPECT_EQ(json["role"], "reflectance");
    EXPECT_EQ(json["values"][1], (std::vector<double>{400.0, 0.03}));
    EXPECT_EQ(json["metadata"]["source"], "things.inc, line 1, #declare D_Clay_01");
}

TEST_F(CommandData, SplinesGoToThisFolderAsLampsWhenAsked) {
    write_file(path("lamp.inc"), "#declare ES_Lamp = spline { 400, 0.5 700, 4.1 }");
    const CommandResult run = data("--from-spline lamp.inc --role lamp --json");
    ASSERT_EQ(run.status, 0) << run.err;
    const auto json = nlohmann::json::parse(run.out);
    EXPECT_EQ(json[0]["file"], "./es-lamp.csv");
    EXPECT_EQ(json[0]["range_nm"], (std::vector<double>{400.0, 700.0}));
    EXPECT_NE(data({"es-lamp.csv"}).out.find("lamp spectrum"), std::string::npos);
}

TEST_F(CommandData, WritesNoTableUnlessAllCanBe) {
    write_file(path("a.inc"),
               std::string(kSplines) + "#declare IOR_Water = spline { 400, 1.34 700, 1.33 }\n");
    const CommandResult refused = data("--from-spline a.inc -o tables");
    EXPECT_EQ(refused.status, kBadInput);
    EXPECT_TRUE(has(refused.err,
                    "a.inc:4: IOR_Water: found 1.34 at 400 nm; allowed for "
                    "reflectance: 0 to 1"));
    EXPECT_FALSE(fs::exists(path("tables")));
    const CommandResult some = data("--from-spline a.inc -o tables --only D_Clay*");
    EXPECT_EQ(some.status, 0) << some.err;
    EXPECT_TRUE(fs::exists(path("tables/d-clay-01.csv")));
    EXPECT_FALSE(fs::exists(path("tables/d-mud.csv")));
}

TEST_F(CommandData, OverwritesNoTableUnlessToldTo) {
    write_file(path("a.inc"), kSplines);
    write_file(path("d-mud.csv"), "mine");
    const CommandResult refused = data("--from-spline a.inc");
    EXPECT_EQ(refused.status, kBadInput);
    EXPECT_TRUE(has(refused.err,
                    "d-mud.csv: found a file of this name; allowed: none, unless "
                    "--force is given"));
    EXPECT_EQ(text_of("d-mud.csv"), "mine");
    EXPECT_FALSE(fs::exists(path("d-clay-01.csv")));
    EXPECT_EQ(data("--from-spline a.inc --force").status, 0);
    EXPECT_NE(text_of("d-mud.csv"), "mine");
}

TEST_F(CommandData, SplineOptionsNeedASplineFile) {
    EXPECT_EQ(data("sand --role lamp").status, kBadInput);
    EXPECT_EQ(data("sand --from-spline a.inc").status, kBadInput);
    EXPECT_EQ(data("--from-spline none.inc").status, kBadInput);
    write_file(path("a.inc"), kSplines);
    EXPECT_EQ(data("--from-spline a.inc --role paint").status, kBadInput);
}

TEST_F(CommandData, UnknownNameNamesTheNearest) {
    const CommandResult run = data({"pope-fry-1979"});
    EXPECT_EQ(run.status, kBadInput);
    EXPECT_TRUE(has(run.err, "pope-fry-1997"));
}

}  // namespace
}  // namespace aphotic::data_test
