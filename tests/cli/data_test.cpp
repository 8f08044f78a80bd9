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

constexpr const char* kSplines =
    "#declare D_Clay_01 = spline { linear_spline 380, 0.021 // blue\n"
    "  400, 0.03, 730 .5 }\n"
    "#declare D_Mud = spline { cubic_spline 380, 0.1 400, 0.2 500, 0.3 730, 0.4 }\n";

TEST_F(CommandData, MakesTablesOfSplines) {
    write_file(path("things.inc"), kSplines);
    const CommandResult run = done(data("--from-spline things.inc -o tables"));
    EXPECT_EQ(run.out,
              "wrote tables/d-clay-01.csv: D_Clay_01, 380 to 730 nm, 3 rows\n"
              "wrote tables/d-mud.csv: D_Mud, 380 to 730 nm, 4 rows\n");
    EXPECT_EQ(
        run.err,
        "aphotic: things.inc:3: D_Mud is a cubic_spline: its knots are joined by straight lines\n");
    const auto json = json_by(data("tables/d-clay-01.csv --json"));
    EXPECT_EQ(json["role"], "reflectance");
    EXPECT_EQ(json["values"][1], (std::vector<double>{400.0, 0.03}));
    EXPECT_EQ(json["metadata"]["source"], "things.inc, line 1, #declare D_Clay_01");
}

TEST_F(CommandData, SplinesGoToThisFolderAsLampsWhenAsked) {
    write_file(path("lamp.inc"), "#declare ES_Lamp = spline { 400, 0.5 700, 4.1 }");
    const auto json = json_by(data("--from-spline lamp.inc --role lamp --json"));
    EXPECT_EQ(json[0]["file"], "./es-lamp.csv");
    EXPECT_EQ(json[0]["range_nm"], (std::vector<double>{400.0, 700.0}));
    EXPECT_TRUE(has(aphotic(data({"es-lamp.csv"})).out, "lamp spectrum"));
}

TEST_F(CommandData, WritesNoTableUnlessAllCanBe) {
    write_file(path("a.inc"),
               std::string(kSplines) + "#declare IOR_Water = spline { 400, 1.34 700, 1.33 }\n");
    refused(data("--from-spline a.inc -o tables"),
            "a.inc:4: IOR_Water: found 1.34 at 400 nm; allowed for "
            "reflectance: 0 to 1");
    done(data("--from-spline a.inc -o tables --only D_Clay*"));
    EXPECT_TRUE(fs::exists(path("tables/d-clay-01.csv")));
    EXPECT_FALSE(fs::exists(path("tables/d-mud.csv")));
}

TEST_F(CommandData, OverwritesNoTableUnlessToldTo) {
    write_file(path("a.inc"), kSplines);
    write_file(path("d-mud.csv"), "mine");
    refused(data("--from-spline a.inc"),
            "d-mud.csv: found a file of this name; allowed: none, unless "
            "--force is given");
    EXPECT_EQ(text_of("d-mud.csv"), "mine");
    EXPECT_FALSE(fs::exists(path("d-clay-01.csv")));
    done(data("--from-spline a.inc --force"));
    EXPECT_NE(text_of("d-mud.csv"), "mine");
}

TEST_F(CommandData, SplineOptionsNeedASplineFile) {
    EXPECT_EQ(aphotic(data("sand --role lamp")).status, kBadInput);
    EXPECT_EQ(aphotic(data("sand --from-spline a.inc")).status, kBadInput);
    EXPECT_EQ(aphotic(data("--from-spline none.inc")).status, kBadInput);
    write_file(path("a.inc"), kSplines);
    EXPECT_EQ(aphotic(data("--from-spline a.inc --role paint")).status, kBadInput);
}

TEST_F(CommandData, UnknownNameNamesTheNearest) {
    refused(data({"pope-fry-1979"}), "pope-fry-1997");
}

}  // namespace
}  // namespace aphotic::data_test
