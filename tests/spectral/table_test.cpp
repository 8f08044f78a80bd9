// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/table.h"

#include "base/error.h"
#include "support/refusal.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <locale>

namespace aphotic::table_test {
namespace {

constexpr const char* kSand = "wavelength_nm,reflectance\n400,0.25\n500,0.5\n";

std::string message_of(const auto& action) {
    return refusal_of([&] { action(); });
}

std::string parse_error(std::string_view text) {
    return message_of([text] { static_cast<void>(parse_table("t.csv", text)); });
}

std::string curve_error(std::string_view text, CurveRole role) {
    return message_of([=] { static_cast<void>(curves_of(parse_table("t.csv", text), role)); });
}

TEST(ParseTable, ReadsMetadataColumnsRowsAndLines) {
    const Table table = parse_table("t.csv",
                                    "# title: Sand: fine\n# just a remark\n\n"
                                    "wavelength_nm,reflectance\n400,0.25\n\n# note\n500,2.5e-1\n");
    EXPECT_EQ(table.name, "t.csv");
    EXPECT_EQ(table.text_of("title"), "Sand: fine");
    EXPECT_EQ(table.text_of("source"), "");
    EXPECT_EQ(table.columns, (std::vector<std::string>{"wavelength_nm", "reflectance"}));
    EXPECT_EQ(table.header_line, 4U);
    ASSERT_EQ(table.rows.size(), 2U);
    EXPECT_EQ(table.rows[0].line, 5U);
    EXPECT_EQ(table.rows[1].line, 8U);
    EXPECT_EQ(table.rows[1].fields, (std::vector<double>{500.0, 0.25}));
}

TEST(ParseTable, PassesOverByteOrderMarkCarriageReturnsAndSpaces) {
    const Table table =
        parse_table("t.csv", "\xEF\xBB\xBFwavelength_nm , reflectance\r\n 400,\t0.25 \r\n500, 0.5");
    EXPECT_EQ(table.columns, (std::vector<std::string>{"wavelength_nm", "reflectance"}));
    ASSERT_EQ(table.rows.size(), 2U);
    EXPECT_EQ(table.rows[1].fields, (std::vector<double>{500.0, 0.5}));
}

struct DecimalComma : std::numpunct<char> {
    [[nodiscard]] char do_decimal_point() const override { return ','; }
};

TEST(ParseTable, ReadsNumbersWhateverTheLocale) {
    const std::locale before = std::locale::global(std::locale({}, new DecimalComma));
    const Table table = parse_table("t.csv", kSand);
    std::locale::global(before);
    EXPECT_EQ(table.rows[0].fields[1], 0.25);
}

TEST(ParseTable, RefusesFieldsThatAreNotNumbers) {
    const std::string head = "wavelength_nm,reflectance\n400,0.25\n";
    const std::string allowed = "'; allowed: a finite decimal number";
    for (const std::string field : {"", "x", "0.5x", "nan", "inf", "1e999", "0x10", "--1"}) {
        EXPECT_EQ(parse_error(head + "500," + field + "\n"),
                  "t.csv:3: reflectance: found '" + field + allowed);
    }
}

TEST(ParseTable, RefusesRowsOfAnotherLength) {
    EXPECT_EQ(parse_error("wavelength_nm,reflectance\n400,0,25\n"),
              "t.csv:2: found 3 fields; allowed: 2, as in the header row");
    EXPECT_EQ(parse_error("wavelength_nm,reflectance\n400\n"),
              "t.csv:2: found 1 fields; allowed: 2, as in the header row");
    EXPECT_EQ(parse_error("wavelength_nm,reflectance\n400,0.25,\n"),
              "t.csv:2: found 3 fields; allowed: 2, as in the header row");
}

TEST(ParseTable, RefusesAMissingOrBrokenHeader) {
    EXPECT_EQ(parse_error(""), "t.csv:1: the file ends without a header row");
    EXPECT_EQ(parse_error("# a\n"), "t.csv:2: the file ends without a header row");
    EXPECT_EQ(parse_error("\n400,0.25\n"),
              "t.csv:2: found '400' where a header row such as wavelength_nm,reflectance is "
              "expected");
    EXPECT_EQ(parse_error("wavelength_nm,\n"), "t.csv:1: found a column without a name");
    EXPECT_EQ(parse_error("wavelength_nm,red,red\n"), "t.csv:1: duplicate column 'red'");
}

TEST(ParseTable, RefusesATableWithoutRows) {
    EXPECT_EQ(parse_error("wavelength_nm,reflectance\n"),
              "t.csv:2: the file ends without a row of numbers");
}

TEST(ParseTable, RefusesWhatIsNotText) {
    const std::string fault = ": found bytes that are not text; allowed: UTF-8";
    EXPECT_EQ(parse_error(std::string_view("a\0b\n", 4)), "t.csv:1" + fault);
    EXPECT_EQ(parse_error("# caf\xE9\n"), "t.csv:1" + fault);  // Latin-1
    EXPECT_EQ(parse_error("# ok\n\x89PNG\r\n"), "t.csv:2" + fault);
    EXPECT_EQ(parse_error("# cut \xC3\n"), "t.csv:1" + fault);
    EXPECT_NO_THROW(static_cast<void>(parse_table(
        "t.csv", std::string("# caf\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x90\x9F\n") + kSand)));
}

TEST(ReadTable, NamesTheFileAndLine) {
    const TempFolder folder;
    const std::filesystem::path file = folder.path() / "a.csv";
    write_file(file, "wavelength_nm,reflectance\n400,?\n");
    EXPECT_EQ(message_of([&] { static_cast<void>(read_table(file)); }),
              file.string() + ":2: reflectance: found '?'; allowed: a finite decimal number");
}

TEST(ReadTable, RefusesFilesThatCannotBeRead) {
    const TempFolder folder;
    const std::filesystem::path none = folder.path() / "none.csv";
    EXPECT_EQ(message_of([&] { static_cast<void>(read_table(none)); }),
              none.string() + ": cannot be read: No such file or directory");
    EXPECT_EQ(message_of([&] { static_cast<void>(read_table(folder.path())); }),
              folder.path().string() + ": cannot be read: it is a folder");
}

TEST(ReadTable, RefusesMoreThan64MiB) {
    const TempFolder folder;
    const std::filesystem::path file = folder.path() / "huge.csv";
    write_file(file, kSand);
    std::filesystem::resize_file(file, (64U << 20U) + 1);  // sparse: no room is taken
    EXPECT_EQ(message_of([&] { static_cast<void>(read_table(file)); }),
              file.string() + ": found more than 64 MiB; allowed: 64 MiB or less");
}

TEST(CurvesOf, NamesASingleCurveByRoleAndTable) {
    const auto curves = curves_of(parse_table("sand", kSand), CurveRole::Reflectance);
    ASSERT_EQ(curves.size(), 1U);
    EXPECT_EQ(curves[0].name(), "reflectance 'sand'");
    EXPECT_EQ(curves[0].at(400.0), 0.25);
    EXPECT_EQ(curves[0].range().last_nm, 500.0);
}

TEST(CurvesOf, NamesEachChannel) {
    const Table table = parse_table("cam", "wavelength_nm,red,green,blue\n400,1,2,3\n500,4,5,6\n");
    const auto curves = curves_of(table, CurveRole::SensorResponse);
    ASSERT_EQ(curves.size(), 3U);
    EXPECT_EQ(curves[0].name(), "sensor response 'cam' (red)");
    EXPECT_EQ(curves[2].at(500.0), 6.0);
}

TEST(CurvesOf, TakesALampInWattsToo) {
    const Table table = parse_table("l", "wavelength_nm,radiant_flux_w_per_nm\n400,1\n500,2\n");
    EXPECT_EQ(curves_of(table, CurveRole::LampSpectrum)[0].at(500.0), 2.0);
}

TEST(CurvesOf, RefusesAHeaderInAnotherUnit) {
    EXPECT_EQ(curve_error("wavelength_um,absorption_per_m\n0.4,1\n", CurveRole::WaterAbsorption),
              "t.csv:1: found the header row wavelength_um,absorption_per_m; allowed for water "
              "absorption: wavelength_nm,absorption_per_m");
    EXPECT_EQ(
        curve_error("# x\nwavelength_nm,absorption_per_cm\n400,1\n", CurveRole::WaterAbsorption),
        "t.csv:2: found the header row wavelength_nm,absorption_per_cm; allowed for water "
        "absorption: wavelength_nm,absorption_per_m");
    EXPECT_EQ(curve_error(kSand, CurveRole::LampSpectrum),
              "t.csv:1: found the header row wavelength_nm,reflectance; allowed for lamp "
              "spectrum: wavelength_nm,relative_power or wavelength_nm,radiant_flux_w_per_nm");
}

// By the column's name, and by what a table says of itself.
TEST(CurvesOf, RefusesDaylightsAttenuation) {
    const std::string why =
        "K_d, the diffuse attenuation of daylight, is neither absorption nor beam attenuation: "
        "docs/reference/water.md";
    for (const char* column : {"Kd_per_m", "K_d", "kd490", "diffuse_attenuation_per_m"}) {
        const std::string header = std::string("wavelength_nm,") + column;
        EXPECT_EQ(curve_error(header + "\n400,0.1\n", CurveRole::WaterAbsorption),
                  std::string("t.csv:1: found the column ") + column +
                      "; allowed for water absorption: wavelength_nm,absorption_per_m. " + why);
    }
    EXPECT_EQ(curve_error("# quantity: diffuse attenuation Kd\nwavelength_nm,absorption_per_m\n"
                          "400,0.1\n500,0.1\n",
                          CurveRole::WaterAbsorption),
              "t.csv:2: found the quantity 'diffuse attenuation Kd' over the column "
              "absorption_per_m; allowed: water absorption. " +
                  why);
    EXPECT_EQ(message_of([] {
                  static_cast<void>(roles_of(parse_table("t.csv", "wavelength_nm,Kd\n400,1\n")));
              }),
              "t.csv:1: found the column Kd; allowed for water absorption: "
              "wavelength_nm,absorption_per_m. " +
                  why);
    // It may be what a was derived from, and no other table is asked.
    EXPECT_EQ(curve_error("# title: a from Kd by Lee\nwavelength_nm,absorption_per_m\n400,0.1\n"
                          "500,0.1\n",
                          CurveRole::WaterAbsorption),
              "nothing was said");
    EXPECT_EQ(curve_error("# quantity: of weekday kdye\nwavelength_nm,absorption_per_m\n400,0.1\n"
                          "500,0.1\n",
                          CurveRole::WaterAbsorption),
              "nothing was said");
}

TEST(CurvesOf, RefusesWavelengthsThatDoNotIncrease) {
    EXPECT_EQ(
        curve_error("wavelength_nm,reflectance\n400,0.1\n\n400,0.2\n", CurveRole::Reflectance),
        "t.csv:4: wavelength_nm: found 400; allowed: above 400, since wavelengths must increase");
    EXPECT_EQ(curve_error("wavelength_nm,reflectance\n0,0.1\n400,0.2\n", CurveRole::Reflectance),
              "t.csv:2: wavelength_nm: found 0; allowed: above 0, since wavelengths must increase");
}

TEST(CurvesOf, RefusesValuesThatTheRoleCannotHave) {
    EXPECT_EQ(
        curve_error("wavelength_nm,absorption_per_m\n400,0\n500,-1\n", CurveRole::WaterAbsorption),
        "t.csv:3: absorption_per_m: found -1; allowed: 0 or more");
    EXPECT_EQ(curve_error("wavelength_nm,reflectance\n400,25\n", CurveRole::Reflectance),
              "t.csv:2: reflectance: found 25; allowed: 0 to 1");
    EXPECT_EQ(
        curve_error("wavelength_nm,red,green,blue\n400,0,1.5,0\n", CurveRole::FilterTransmittance),
        "t.csv:2: green: found 1.5; allowed: 0 to 1");
    EXPECT_EQ(
        curve_error("wavelength_nm,quantum_efficiency\n400,40\n", CurveRole::QuantumEfficiency),
        "t.csv:2: quantum_efficiency: found 40; allowed: 0 to 1");
}

TEST(CurvesOf, RefusesASingleRow) {
    EXPECT_EQ(curve_error("wavelength_nm,reflectance\n400,0.1\n", CurveRole::Reflectance),
              "t.csv:2: found 1 row; a curve needs 2 or more");
}

TEST(RolesOf, FindsWhatTheHeaderFits) {
    EXPECT_EQ(roles_of(parse_table("t.csv", kSand)),
              std::vector<CurveRole>{CurveRole::Reflectance});
    const Table low = parse_table("t.csv", "wavelength_nm,red,green,blue\n400,0,1,1\n500,1,1,0\n");
    EXPECT_EQ(roles_of(low),
              (std::vector<CurveRole>{CurveRole::SensorResponse, CurveRole::FilterTransmittance}));
    const Table high = parse_table("t.csv", "wavelength_nm,red,green,blue\n400,0,1,9\n500,1,1,0\n");
    EXPECT_EQ(roles_of(high), std::vector<CurveRole>{CurveRole::SensorResponse});
}

TEST(RolesOf, RefusesATableThatFitsNone) {
    const std::string unknown = message_of(
        [] { static_cast<void>(roles_of(parse_table("t.csv", "lambda,value\n400,1\n"))); });
    EXPECT_TRUE(
        unknown.starts_with("t.csv:1: found the header row lambda,value; allowed: "
                            "wavelength_nm,absorption_per_m (water absorption), "))
        << unknown;
    EXPECT_EQ(message_of([] {
                  static_cast<void>(
                      roles_of(parse_table("t.csv", "wavelength_nm,reflectance\n400,1\n500,2\n")));
              }),
              "t.csv:3: reflectance: found 2; allowed: 0 to 1");
}

TEST(RoleName, GoesBothWays) {
    for (const CurveRole role : kCurveRoles) EXPECT_EQ(role_named(role_name(role)), role);
    EXPECT_EQ(role_named("glass"), std::nullopt);
}

}  // namespace
}  // namespace aphotic::table_test
