// SPDX-License-Identifier: BSD-3-Clause
//
// POV-Ray's own word on the splines that are imported.
#include "spectral/spline_import.h"

#include "base/atomic_file.h"
#include "plugin/povray.h"
#include "plugin/process.h"
#include "support/temp_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <sstream>

namespace aphotic::spline_import_test {
namespace {

constexpr double kPrinted = 1e-6;  // ten decimals are printed; POV-Ray's splines are double
constexpr double kTimeout_s = 60.0;

// Every oddity that POV-Ray allows.
constexpr const char* kSplines = R"(
#declare Plain = spline { linear_spline 380, 0.0123  385, 0.02 /* a /* nested */ one */ 730, 0.9 }
#declare Unsorted = spline { 700 .5, 400, 8.0/20 410 5.e-1 // the end } 5
  550, <0.25, 0.25, 0.25>, 500 1 - 2/4*(0.5 + .5), 420 - 10 * 3, +.125 }
#local Cubic = spline { cubic_spline 380, 0.1 400, 0.3 420, 0.2 440, 0.9 460, 0.1 480, 0.7 }
#declare Natural = spline { natural_spline 380, 0.1 400, 0.3 420, 0.2 440, 0.9 460, 0.1 }
#declare Quadratic = spline { quadratic_spline 380, 0.1 400, 0.3 420, 0.2 440, 0.9 460, 0.1 }
)";

Spectrum curve_of(const SplineSpectrum& spectrum) {
    const std::string csv = spline_table("a.inc", spectrum, CurveRole::Reflectance);
    return curves_of(parse_table("a.csv", csv), CurveRole::Reflectance).front();
}

std::vector<double> answers_of_povray(const std::string& expressions) {
    const TempFolder folder;
    write_file(folder.path() / "ask.pov",
               "#version 3.7;\n" + std::string(kSplines) + "#fopen Answers \"answers\" write\n" +
                   expressions);
    const std::filesystem::path log = folder.path() / "log";
    const ProcessEnd end = run_process({.executable = find_povray("").executable,
                                        .arguments = {"+Iask.pov", "+W1", "+H1", "-F", "-D"},
                                        .folder = folder.path(),
                                        .environment = {{"POVINI", ""}, {"POVINC", ""}},
                                        .log = log},
                                       kTimeout_s);
    EXPECT_TRUE(end.succeeded()) << end.words() << '\n' << read_text_file(log);
    std::istringstream answers(read_text_file(folder.path() / "answers"));
    return {std::istream_iterator<double>(answers), std::istream_iterator<double>()};
}

std::string ask(const std::string& identifier, double lambda_nm) {
    return fmt::format("#write (Answers, str({}({}).x, 0, 10), \"\\n\")\n", identifier, lambda_nm);
}

// Between knots too.
TEST(SplineImport, LinearSplinesAreWhatPovRayComputes) {
    std::string questions;
    std::vector<double> expected;
    for (const SplineSpectrum& spectrum : parse_splines("a.inc", kSplines).spectra) {
        if (!spectrum.is_linear()) continue;
        const Spectrum curve = curve_of(spectrum);
        constexpr double kStep_nm = 3.7;
        for (double nm = curve.range().first_nm; nm <= curve.range().last_nm; nm += kStep_nm) {
            questions += ask(spectrum.identifier, nm);
            expected.push_back(curve.at(nm));
        }
    }
    const std::vector<double> answers = answers_of_povray(questions);
    ASSERT_EQ(answers.size(), expected.size());
    ASSERT_GT(answers.size(), 150U);
    for (std::size_t i = 0; i < answers.size(); ++i) EXPECT_NEAR(answers[i], expected[i], kPrinted);
}

// The ends of a cubic_spline are its tangents.
TEST(SplineImport, OtherSplinesPassThroughTheKnotsThatAreTaken) {
    std::string questions;
    std::vector<double> expected;
    for (const SplineSpectrum& spectrum : parse_splines("a.inc", kSplines).spectra) {
        if (spectrum.is_linear()) continue;
        const std::size_t ends = spectrum.form == "cubic_spline" ? 1 : 0;
        for (std::size_t i = ends; i + ends < spectrum.knots.size(); ++i) {
            questions += ask(spectrum.identifier, spectrum.knots[i].lambda_nm);
            expected.push_back(spectrum.knots[i].value);
        }
    }
    const std::vector<double> answers = answers_of_povray(questions);
    ASSERT_EQ(answers.size(), expected.size());
    ASSERT_EQ(answers.size(), 14U);
    for (std::size_t i = 0; i < answers.size(); ++i) EXPECT_NEAR(answers[i], expected[i], kPrinted);
}

}  // namespace
}  // namespace aphotic::spline_import_test
