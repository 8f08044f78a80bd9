// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/spline_import.h"

#include "base/error.h"
#include "support/refusal.h"

#include <gtest/gtest.h>

namespace aphotic::spline_import_test {
namespace {

std::string message_of(const auto& action) {
    return refusal_of([&] { action(); });
}

SplineSpectrum spline_of(const std::string& body) {
    return parse_splines("a.inc", "#declare D_A = spline {" + body + "}").spectra.at(0);
}

std::string error_of(const std::string& text) {
    return message_of([&] { static_cast<void>(parse_splines("a.inc", text)); });
}

std::string body_error(const std::string& body) {
    return error_of("#declare D_A = spline {" + body + "}");
}

std::vector<double> wavelengths_of(const SplineSpectrum& spectrum) {
    std::vector<double> lambda_nm;
    for (const SplineKnot& knot : spectrum.knots) lambda_nm.push_back(knot.lambda_nm);
    return lambda_nm;
}

std::vector<double> values_of(const SplineSpectrum& spectrum) {
    std::vector<double> values;
    for (const SplineKnot& knot : spectrum.knots) values.push_back(knot.value);
    return values;
}

// As such files look: a guard, a title in a comment, debug text, commas here and there.
constexpr const char* kLibrary =
    "// Spectra of things // spline { 1, 2 }\r\n"
    "#ifndef (Things_Inc)\r\n"
    "#declare Things_Inc = version;\r\n"
    "#debug \"see http://example.org /* \\\" */ spline { }\\n\"\r\n"
    "/* old: #declare RS_Clay = spline { 400, 2 } /* nested */ 450 */\r\n"
    "#declare RS_Clay = spline{ linear_spline\r\n"
    " 380, 0.021 // blue\r\n"
    " 400, 0.03,\r\n"
    " 730  .5\r\n"
    "}\r\n"
    "#local RS_Mud_01 =\r\n"
    "  spline { natural_spline 380,<0.1,0.1,0.1>,400,<0.2,0.2>,420 3e-1 440 8.0/20 }\r\n"
    "#declare P = prism { linear_spline 0, 1, 2, <0, 0>, <1, 1> }\r\n"
    "#end\r\n";

TEST(ParseSplines, ReadsALibrary) {
    const SplineFile file = parse_splines("things.inc", kLibrary);
    ASSERT_EQ(file.spectra.size(), 2U);
    EXPECT_EQ(file.spectra[0].identifier, "RS_Clay");
    EXPECT_EQ(file.spectra[0].line, 6U);
    EXPECT_EQ(file.spectra[0].form, "linear_spline");
    EXPECT_EQ(wavelengths_of(file.spectra[0]), (std::vector<double>{380.0, 400.0, 730.0}));
    EXPECT_EQ(values_of(file.spectra[0]), (std::vector<double>{0.021, 0.03, 0.5}));
    EXPECT_EQ(file.spectra[0].knots[2].line, 9U);
    EXPECT_EQ(file.spectra[1].identifier, "RS_Mud_01");
    EXPECT_EQ(file.spectra[1].form, "natural_spline");
    EXPECT_EQ(values_of(file.spectra[1]), (std::vector<double>{0.1, 0.2, 0.3, 0.4}));
    EXPECT_TRUE(file.anonymous_lines.empty());
}

TEST(ParseSplines, ReadsNumbersAsPovRayDoes) {
    EXPECT_EQ(values_of(spline_of("380 .5 390, 5. 400 1e-1 410 2.5E+1 420, +.25 430, -.25")),
              (std::vector<double>{0.5, 5.0, 0.1, 25.0, 0.25, -0.25}));
    EXPECT_EQ(values_of(spline_of("380 1/4*2 390 1 + 2*3 400 (1+2)*3, 410 8-2-1 420, -(-1)")),
              (std::vector<double>{0.5, 7.0, 9.0, 5.0, 1.0}));
    // Without its comma, a sign subtracts.
    EXPECT_EQ(wavelengths_of(spline_of("380 0.1 400 -10 0.2")),
              (std::vector<double>{380.0, 390.0}));
}

// Lines of an old Macintosh.
TEST(ParseSplines, CommentsEndAtACarriageReturn) {
    EXPECT_EQ(values_of(spline_of("400, 0.1 // blue\r 500, 0.2")), (std::vector<double>{0.1, 0.2}));
}

TEST(ParseSplines, SortsKnots) {
    const SplineSpectrum spectrum = spline_of("700, .7 400, .4 550, .55");
    EXPECT_EQ(wavelengths_of(spectrum), (std::vector<double>{400.0, 550.0, 700.0}));
    EXPECT_EQ(values_of(spectrum), (std::vector<double>{0.4, 0.55, 0.7}));
}

TEST(ParseSplines, TakesTheFormOrTheDefault) {
    EXPECT_EQ(spline_of("400, 0 500, 1").form, "linear_spline");
    for (const char* form :
         {"linear_spline", "cubic_spline", "natural_spline", "quadratic_spline"}) {
        const SplineSpectrum spectrum = spline_of(std::string(form) + " 400, 0 500, 1");
        EXPECT_EQ(spectrum.form, form);
        EXPECT_EQ(spectrum.is_linear(), spectrum.form == "linear_spline");
    }
    EXPECT_NE(body_error("akima_spline 400, 0 500, 1").find("found 'akima_spline'"),
              std::string::npos);
}

// SpectralRender: 36 values at 380, 390, ... 730 nm.
TEST(ParseSplines, ReadsArraysOf36) {
    std::string values;
    for (int i = 0; i < 36; ++i) values += std::to_string(i) + "/100, ";
    const std::string text = "#declare D_A = array[36] {" + values + "}\n#declare E = array[36];";
    const SplineFile file = parse_splines("a.inc", text);
    ASSERT_EQ(file.spectra.size(), 1U);
    EXPECT_EQ(file.spectra[0].form, "array[36]");
    EXPECT_EQ(file.spectra[0].knots.front().lambda_nm, 380.0);
    EXPECT_EQ(file.spectra[0].knots.back().lambda_nm, 730.0);
    EXPECT_EQ(file.spectra[0].knots[17].value, 0.17);
    EXPECT_EQ(error_of("\n#declare D_A = array[36] {0.1, 0.2}"),
              "a.inc:2: D_A: found 2 values; allowed: 36");
}

TEST(ParseSplines, TakesOnlyWhatFits) {
    const std::string text =
        "#declare D_A = spline { 400, 0 500, 1 }\n"
        "#declare IOR_A = spline { 0.4, 1.5 0.5, Other }\n"
        "#declare D_B = spline { 400, 0 500, 1 }\n";
    const SplineFile file = parse_splines("a.inc", text, "D_*");
    ASSERT_EQ(file.spectra.size(), 2U);
    EXPECT_EQ(file.spectra[1].identifier, "D_B");
    EXPECT_EQ(message_of([&] { static_cast<void>(parse_splines("a.inc", text, "X*")); }),
              "a.inc: found no spectrum; allowed: #declare NAME = spline { ... } or #declare NAME "
              "= array[36] { ... }, with a NAME that matches 'X*'");
}

TEST(ParseSplines, NotesSplinesWithoutAName) {
    const SplineFile file = parse_splines("a.inc",
                                          "#declare A = spline { 400, 0 500, 1 }\n"
                                          "Light(spline { 380, 0, 730, 0 })\n"
                                          "#declare F = function { spline { 0, 0 1, 1 } }\n");
    EXPECT_EQ(file.spectra.size(), 1U);
    EXPECT_EQ(file.anonymous_lines, (std::vector<std::size_t>{2, 3}));
}

TEST(ParseSplines, RefusesAFileWithout) {
    EXPECT_EQ(error_of("#declare A = 1; sphere { 0, 1 }"),
              "a.inc: found no spectrum; allowed: #declare NAME = spline { ... } or #declare NAME "
              "= array[36] { ... }");
    EXPECT_NE(error_of(""), "nothing was said");
}

TEST(ParseSplines, RefusesVectorsOfUnequalNumbers) {
    EXPECT_EQ(body_error("400, 0.1\n500, <0.1, 0.2, 0.3>"),
              "a.inc:2: D_A: found <0.1, 0.2, 0.3>; allowed: a number, or a vector of 2 to 5 equal "
              "ones");
    EXPECT_NE(body_error("400, <0.1> 500, 1").find("found <0.1>"), std::string::npos);
    EXPECT_NE(body_error("400, <0,0,0,0,0,0> 500, 1").find("2 to 5"), std::string::npos);
}

TEST(ParseSplines, RefusesWavelengthsThatAreNotNanometres) {
    EXPECT_EQ(body_error("0.4, 0.1 0.5, 0.2"),
              "a.inc:1: D_A: found the wavelength 0.4; allowed: 200 to 2500, in nm");
    EXPECT_NE(body_error("4000, 0.1 5000, 0.2").find("wavelength 4000"), std::string::npos);
    EXPECT_NE(body_error("1e999, 0.1 500, 0.2").find("wavelength nan"), std::string::npos);
}

// POV-Ray would take the second in the first one's place.
TEST(ParseSplines, RefusesAWavelengthTwice) {
    EXPECT_EQ(body_error("400, 0.1\n500, 0.2\n\n400.0, 0.1"),
              "a.inc:4: D_A: found a duplicate wavelength 400, first on line 1; allowed: once");
}

TEST(ParseSplines, RefusesWhatOnlyPovRayCanCompute) {
    const std::string allowed =
        "; allowed: numbers, vectors of equal numbers, and + - * / ( ) between numbers";
    EXPECT_EQ(body_error("400, 0.1\n#while (i < 3)"), "a.inc:2: D_A: found '#'" + allowed);
    EXPECT_EQ(body_error("400, Grey 500, 1"), "a.inc:1: D_A: found 'Grey'" + allowed);
    EXPECT_EQ(body_error("D_B 400, 1"), "a.inc:1: D_A: found 'D_B'" + allowed);
    EXPECT_EQ(body_error("400, 0.1,, 500, 1"), "a.inc:1: D_A: found ','" + allowed);
    EXPECT_EQ(body_error("400, <1,1,1> * 2"), "a.inc:1: D_A: found '*'" + allowed);
    EXPECT_EQ(body_error("400, 0.1 500"), "a.inc:1: D_A: found '}'" + allowed);
    EXPECT_EQ(body_error("400, 0.1 500 \xB0"), "a.inc:1: D_A: found the byte 0xB0" + allowed);
    EXPECT_EQ(body_error("400, (0.1 500"), "a.inc:1: D_A: found '500'; allowed: ')'");
    EXPECT_EQ(error_of("#declare A = spline { 400, 1\n"),
              "a.inc:2: A: found the end of the file" + allowed);
    EXPECT_NE(body_error("400, " + std::string(1000000, '(')), "nothing was said");
}

TEST(ParseSplines, RefusesNumbersOutOfRange) {
    EXPECT_EQ(body_error("400, 1/0 500, 1"),
              "a.inc:1: D_A: found a number out of range; allowed: finite");
    EXPECT_EQ(body_error("400, 1e999 500, 1"),
              "a.inc:1: D_A: found a number out of range; allowed: finite");
}

TEST(ParseSplines, RefusesFewerThanTwoKnots) {
    EXPECT_EQ(body_error(""), "a.inc:1: D_A: found 0 knots; a curve needs 2 or more");
    EXPECT_EQ(body_error("400, 1"), "a.inc:1: D_A: found 1 knots; a curve needs 2 or more");
}

TEST(ParseSplines, RefusesTwoSpectraForOneTable) {
    EXPECT_EQ(error_of("#declare D_A = spline { 400, 0 500, 1 }\n"
                       "#declare d_a = spline { 400, 0 500, 1 }"),
              "a.inc:2: d_a: found a second spectrum for d-a.csv, the first is D_A on line 1; "
              "allowed: one");
}

TEST(ParseSplines, RefusesWhatNeverEnds) {
    EXPECT_EQ(error_of("\n/* /* */ spline"),
              "a.inc:2: the comment that begins here is not terminated");
    EXPECT_EQ(error_of("\n#debug \"spline\\\""),
              "a.inc:2: the text that begins here is not terminated");
}

TEST(SplineTableName, IsLowerCaseWithDashes) {
    EXPECT_EQ(spline_table_name("D_Macbeth_01"), "d-macbeth-01.csv");
    EXPECT_EQ(spline_table_name("_Clay"), "clay.csv");
}

TEST(SplineTable, IsATableThatSaysWhereItComesFrom) {
    const SplineFile file = parse_splines("lib/things.inc", kLibrary);
    const std::string clay =
        spline_table("lib/things.inc", file.spectra[0], CurveRole::Reflectance);
    EXPECT_EQ(clay,
              "# title: RS_Clay\n"
              "# source: things.inc, line 6, #declare RS_Clay\n"
              "# obtained: the knots of a linear_spline\n"
              "wavelength_nm,reflectance\n380,0.021\n400,0.03\n730,0.5\n");
    const std::string mud = spline_table("things.inc", file.spectra[1], CurveRole::LampSpectrum);
    EXPECT_NE(mud.find("natural_spline, joined here by straight lines"), std::string::npos) << mud;
    const Table table = parse_table("mud.csv", mud);
    EXPECT_EQ(curves_of(table, CurveRole::LampSpectrum)[0].at(390.0), 0.15000000000000002);
}

TEST(SplineTable, KeepsEveryBit) {
    const double third = 1.0 / 3.0;
    const SplineSpectrum spectrum = spline_of("400, 1/3 500.25, 0.1");
    const Table table =
        parse_table("a.csv", spline_table("a.inc", spectrum, CurveRole::Reflectance));
    EXPECT_EQ(table.rows[0].fields[1], third);
    EXPECT_EQ(table.rows[1].fields[0], 500.25);
}

TEST(SplineTable, RefusesValuesThatTheRoleCannotHave) {
    const auto error = [](const std::string& body, CurveRole role) {
        return message_of([&] { static_cast<void>(spline_table("a.inc", spline_of(body), role)); });
    };
    EXPECT_EQ(error("400, 0.1\n500, 1.01", CurveRole::Reflectance),
              "a.inc:2: D_A: found 1.01 at 500 nm; allowed for reflectance: 0 to 1");
    EXPECT_EQ(error("400, 0.1\n500, -0.01", CurveRole::Reflectance),
              "a.inc:2: D_A: found -0.01 at 500 nm; allowed for reflectance: 0 to 1");
    EXPECT_EQ(error("400, 50\n500, -0.01", CurveRole::LampSpectrum),
              "a.inc:2: D_A: found -0.01 at 500 nm; allowed for lamp spectrum: 0 or more");
    EXPECT_EQ(error("400, 50\n500, 0", CurveRole::LampSpectrum), "nothing was said");
}

TEST(SplineTable, RefusesAFileNameThatCannotStandInATable) {
    const SplineSpectrum spectrum = spline_of("400, 0 500, 1");
    EXPECT_THROW(static_cast<void>(spline_table("caf\xE9.inc", spectrum, CurveRole::Reflectance)),
                 InputError);
}

}  // namespace
}  // namespace aphotic::spline_import_test
