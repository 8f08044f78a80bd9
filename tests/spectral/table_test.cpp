// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/table.h"

#include "base/error.h"
#include "support/mistakes.h"
#include "support/refusal.h"
#include "support/temp_folder.h"

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

// It may be what a was derived from, and no other table is asked.
TEST(CurvesOf, TakesAbsorptionThatNamesDaylightsAttenuation) {
    for (const std::string comment : {"# title: a from Kd by Lee", "# quantity: of weekday kdye"})
        EXPECT_EQ(curve_error(comment + "\nwavelength_nm,absorption_per_m\n400,0.1\n500,0.1\n",
                              CurveRole::WaterAbsorption),
                  kAccepted);
}

TEST(Tables, MistakesAreNamedByLineWhatWasFoundAndWhatIsAllowed) {
    for (const Mistake& mistake : mistakes_in("spectral/mistakes/tables.txt", 24)) {
        SCOPED_TRACE(testing::PrintToString(mistake));
        const auto& parts = mistake.parts;
        const std::string table = parts.empty() ? "" : parts[0].text + "\n";
        EXPECT_EQ(parts.size() > 1 ? curve_error(table, role_named(parts[1].text).value())
                                   : parse_error(table),
                  "t.csv:" + mistake.message);
    }
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
    const std::string daylight = message_of(
        [] { static_cast<void>(roles_of(parse_table("t.csv", "wavelength_nm,Kd\n400,1\n"))); });
    EXPECT_EQ(
        daylight,
        "t.csv:1: found the column Kd; allowed for water absorption: "
        "wavelength_nm,absorption_per_m. K_d, the diffuse attenuation of daylight, is neither "
        "absorption nor beam attenuation: docs/reference/water.md");
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
