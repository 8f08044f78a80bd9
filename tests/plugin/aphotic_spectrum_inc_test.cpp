// SPDX-License-Identifier: BSD-3-Clause
//
// plugin/include/aphotic_spectrum.inc, by real POV-Ray: the tables that it writes, as we read them.
#include "spectral/table.h"
#include "support/povray_scene.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace aphotic::aphotic_spectrum_inc_test {
namespace {

constexpr double kPrinted = 1e-12;  // the last of twelve decimals

class AphoticSpectrumInc : public testing::Test {
  protected:
    PovRayRun write(const std::string& sdl) {
        const std::string include = "aphotic_spectrum.inc";
        const std::string source = APHOTIC_SOURCE_DIR;
        write_file(folder_.path() / include, read_text_file(source + "/plugin/include/" + include));
        return run_povray(
            folder_.path(), "#version 3.7;\n#include \"" + include + "\"\n" + sdl, 1, 1);
    }
    Spectrum written(const std::string& sdl, CurveRole role = CurveRole::Reflectance) {
        const PovRayRun run = write(sdl);
        EXPECT_TRUE(run.end.succeeded()) << run.said();
        return curves_of(read_table((folder_.path() / "a.csv").string()), role).front();
    }

    TempFolder folder_;
};

TEST_F(AphoticSpectrumInc, ALinearSplineIsItsTable) {
    const std::string knots = " 730, 0.9  380, 0.0123  385, 0.02 ";
    const std::string write = "Aphotic_Write_Spectrum (S, \"reflectance\", \"a.csv\", 380, 730, 5)";
    for (const std::string form : {"", "linear_spline"}) {
        const Spectrum curve = written("#declare S = spline { " + form + knots + "}\n" + write);
        EXPECT_EQ(curve.range().first_nm, 380.0);
        EXPECT_EQ(curve.range().last_nm, 730.0);
        EXPECT_EQ(curve.at(380.0), 0.0123);
        EXPECT_EQ(curve.at(385.0), 0.02);
        EXPECT_EQ(curve.at(730.0), 0.9);
        EXPECT_NEAR(curve.at(501.3), 0.02 + 0.88 * (501.3 - 385.0) / 345.0, kPrinted);
    }
}

// A cubic_spline is Catmull and Rom's: halfway (-a + 9 b + 9 c - d) / 16.
TEST_F(AphoticSpectrumInc, OtherSplinesAreAsPovRayEvaluatesThem) {
    const Spectrum curve = written(
        "#declare S = spline { cubic_spline 380, 0.1 400, 0.3 420, 0.2 440, 0.9 460, 0.1 480, 0.7 "
        "}\nAphotic_Write_Spectrum (S, \"reflectance\", \"a.csv\", 400, 460, 10)");
    EXPECT_EQ(curve.at(400.0), 0.3);
    EXPECT_NEAR(curve.at(410.0), (-0.1 + 9.0 * 0.3 + 9.0 * 0.2 - 0.9) / 16.0, kPrinted);
    EXPECT_EQ(curve.at(440.0), 0.9);
    EXPECT_NEAR(curve.at(450.0), (-0.2 + 9.0 * 0.9 + 9.0 * 0.1 - 0.7) / 16.0, kPrinted);
    EXPECT_EQ(curve.at(460.0), 0.1);
}

// The last step ends at the last wavelength.
TEST_F(AphoticSpectrumInc, TakesFunctionsForLamps) {
    const Spectrum curve = written(
        "#declare F = function (nm) { pow(nm / 100, 2) }\n"
        "Aphotic_Write_Spectrum (F, \"relative_power\", \"a.csv\", 400, 450.5, 0.1 + 24.9)",
        CurveRole::LampSpectrum);
    ASSERT_EQ(curve.lambda_nm().size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
        constexpr std::array kRows_nm{400.0, 425.0, 450.0, 450.5};
        EXPECT_EQ(curve.lambda_nm()[i], kRows_nm.at(i));
        EXPECT_NEAR(curve.values()[i], kRows_nm.at(i) * kRows_nm.at(i) / 1e4, kPrinted);
    }
}

TEST_F(AphoticSpectrumInc, TakesVectorsOfEqualNumbersAlone) {
    const auto spline = [](const std::string& last) {
        return "#declare S = spline { linear_spline 400, <0.5, 0.5, 0.5> 700, " + last +
               " }\nAphotic_Write_Spectrum (S, \"reflectance\", \"a.csv\", 400, 700, 100)";
    };
    EXPECT_NEAR(written(spline("<0.2, 0.2, 0.2>")).at(600.0), 0.3, kPrinted);
    std::filesystem::remove(folder_.path() / "a.csv");
    const PovRayRun run = write(spline("<0.2, 0.8, 0.2>"));
    EXPECT_FALSE(run.end.succeeded());
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "a.csv"));
    EXPECT_NE(run.said().find("Aphotic_Write_Spectrum: found <0.400000, 0.600000, 0.400000> at "
                              "500.000000 nm; allowed: a number, or a vector of equal ones."),
              std::string::npos)
        << run.said();
}

TEST_F(AphoticSpectrumInc, SaysWhatIsAllowed) {
    for (const std::string wrong : {"\"paint\", \"a.csv\", 400, 700, 5",
                                    "\"reflectance\", \"a.csv\", 0.4, 0.7, 0.01",
                                    "\"reflectance\", \"a.csv\", 700, 400, 5",
                                    "\"reflectance\", \"a.csv\", 400, 4000, 5",
                                    "\"reflectance\", \"a.csv\", 400, 700, 0"}) {
        const PovRayRun run = write("#declare S = spline { 400, 0.5 700, 0.2 }\n" +
                                    ("Aphotic_Write_Spectrum (S, " + wrong + ")"));
        EXPECT_FALSE(run.end.succeeded()) << wrong;
        EXPECT_NE(run.said().find("Aphotic_Write_Spectrum: found "), std::string::npos)
            << run.said();
        EXPECT_FALSE(std::filesystem::exists(folder_.path() / "a.csv")) << wrong;
    }
}

}  // namespace
}  // namespace aphotic::aphotic_spectrum_inc_test
