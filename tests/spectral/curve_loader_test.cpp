// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/curve_loader.h"

#include "base/error.h"
#include "spectral/refractive_index.h"
#include "support/refusal.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <set>

namespace aphotic::curve_loader_test {
namespace {

std::string message_of(const auto& action) {
    return refusal_of([&] { action(); });
}

Spectrum built_in(const std::string& name, CurveRole role) {
    return load_curve(name, role, {});
}

TEST(BuiltinTables, AreThoseOfTheManual) {
    std::set<std::string> names;
    for (const BuiltinTable& table : builtin_tables()) names.emplace(table.name);
    EXPECT_EQ(names, (std::set<std::string>{"pope-fry-1997",  "pure-2016",
                                            "xenon-flash",    "xenon-arc",
                                            "sand",           "green-algae",
                                            "brown-algae",    "red-algae",
                                            "nikon-d5100",    "cie-1931",
                                            "cie-d65",        "cie-led-b4",
                                            "cie-led-b5",     "bk7",
                                            "fused-silica",   "sapphire",
                                            "pmma",           "polycarbonate",
                                            "quan-fry-1995",  "jerlov-IB",
                                            "jerlov-II",      "jerlov-III",
                                            "jerlov-1C",      "jerlov-3C",
                                            "jerlov-5C",      "jerlov-I-2015",
                                            "jerlov-IA-2015", "jerlov-IB-2015",
                                            "jerlov-II-2015", "jerlov-III-2015",
                                            "jerlov-1C-2015", "jerlov-3C-2015",
                                            "jerlov-5C-2015", "jerlov-7C-2015",
                                            "jerlov-9C-2015"}));
    EXPECT_EQ(names.size(), builtin_tables().size());
}

TEST(BuiltinTables, StateTheirSourceAndRange) {
    for (const BuiltinTable& builtin : builtin_tables()) {
        SCOPED_TRACE(builtin.name);
        const Table table = builtin_table(builtin.name);
        for (const char* key :
             {"title", "role", "quantity", "unit", "source", "obtained", "uncertainty", "terms"}) {
            EXPECT_NE(table.text_of(key), "") << key;
        }
        EXPECT_GT(stated_range(table).first_nm, 0.0);
        EXPECT_LT(stated_range(table).first_nm, stated_range(table).last_nm);
    }
}

TEST(BuiltinTables, HoldCurvesOverTheRangeThatTheyState) {
    for (const BuiltinTable& builtin : builtin_tables()) {
        SCOPED_TRACE(builtin.name);
        const Table table = builtin_table(builtin.name);
        const auto role = role_named(table.text_of("role"));
        if (!role) continue;  // coefficients
        for (const Spectrum& curve : curves_of(table, *role)) {
            EXPECT_EQ(curve.range().first_nm, stated_range(table).first_nm);
            EXPECT_EQ(curve.range().last_nm, stated_range(table).last_nm);
        }
    }
}

// R. M. Pope and E. S. Fry, Applied Optics 36, 8710 (1997), Table 3 and abstract.
TEST(BuiltinTables, PopeAndFryHaveThePublishedAbsorption) {
    const Spectrum water = built_in("pope-fry-1997", CurveRole::WaterAbsorption);
    EXPECT_EQ(water.at(440.0), 0.00635);
    EXPECT_EQ(water.at(550.0), 0.0565);
    EXPECT_EQ(water.at(600.0), 0.2224);
    EXPECT_EQ(water.at(700.0), 0.624);
}

TEST(BuiltinTables, PopeAndFryHaveTheirMinimumAt418nm) {
    constexpr double kPublishedMinimum_per_m = 0.0044;
    constexpr double kPublishedSigma_per_m = 0.0006;
    const Spectrum water = built_in("pope-fry-1997", CurveRole::WaterAbsorption);
    EXPECT_NEAR(water.at(418.0), kPublishedMinimum_per_m, kPublishedSigma_per_m);
    for (const double value : water.values()) EXPECT_GE(value, water.at(417.5));
}

// Beside Pope & Fry at 400 nm (0.00663), Mason, Cone and Fry (2016) found a third.
TEST(BuiltinTables, Pure2016IsClearerInTheVioletAndTheSameInTheGreen) {
    const Spectrum old = built_in("pope-fry-1997", CurveRole::WaterAbsorption);
    const Spectrum pure = built_in("pure-2016", CurveRole::WaterAbsorption);
    EXPECT_LT(pure.at(400.0), 0.5 * old.at(400.0));
    EXPECT_EQ(pure.at(550.0), old.at(550.0));
    EXPECT_EQ(pure.at(725.0), 1.489);
    EXPECT_EQ(pure.at(730.0), 1.97);
}

// CIE 015: D65 is 100 at 560 nm by definition.
TEST(BuiltinTables, D65Is100At560nm) {
    EXPECT_EQ(built_in("cie-d65", CurveRole::LampSpectrum).at(560.0), 100.0);
}

// CIE 018: ybar peaks at 1 at 555 nm; the columns' sums over 380 to 780 nm by 5 nm.
TEST(BuiltinTables, ColourMatchingFunctionsHaveThePublishedSums) {
    constexpr double kSumRounding = 5e-5;  // the sums are published to four decimals
    constexpr std::array kSums{21.3715, 21.3713, 21.3715};
    const auto curves = load_curves("cie-1931", CurveRole::ColourMatching, {});
    EXPECT_EQ(curves[1].at(555.0), 1.0);
    for (std::size_t i = 0; i < kSums.size(); ++i) {
        double sum = 0.0;
        for (int lambda_nm = 380; lambda_nm <= 780; lambda_nm += 5) sum += curves[i].at(lambda_nm);
        EXPECT_NEAR(sum, kSums[i], kSumRounding);
    }
}

TEST(BuiltinTable, NamesTheNearestAndAllNames) {
    const std::string message =
        message_of([] { static_cast<void>(builtin_table("pope-fry-1979")); });
    EXPECT_TRUE(message.starts_with(
        "no built-in table is named 'pope-fry-1979'; did you mean 'pope-fry-1997'?; allowed: "))
        << message;
    for (const BuiltinTable& table : builtin_tables()) {
        EXPECT_NE(message.find(table.name), std::string::npos) << table.name;
    }
    EXPECT_EQ(message_of([] { static_cast<void>(builtin_table("?")); }).find("mean"),
              std::string::npos);
}

TEST(LoadCurve, RefusesABuiltinOfAnotherRole) {
    EXPECT_EQ(message_of([] { built_in("sand", CurveRole::WaterAbsorption); }),
              "'sand' is a built-in table of role reflectance, not water absorption; allowed: "
              "pope-fry-1997, pure-2016");
    EXPECT_THROW(built_in("bk7", CurveRole::Reflectance), InputError);
}

TEST(LoadCurve, LooksFilesUpInTheBaseFolder) {
    const TempFolder folder;
    write_file(folder.path() / "mud.csv", "wavelength_nm,reflectance\n400,0.1\n700,0.2\n");
    EXPECT_EQ(load_curve("mud.csv", CurveRole::Reflectance, folder.path()).at(700.0), 0.2);
    const std::string absolute = (folder.path() / "mud.csv").string();
    EXPECT_THROW(static_cast<void>(load_curve(absolute, CurveRole::Reflectance, folder.path())),
                 InputError)
        << "a rig that works here alone, or reads what it was not sent with";
    EXPECT_THROW(static_cast<void>(load_curve("none.csv", CurveRole::Reflectance, folder.path())),
                 InputError);
}

// SHA-256 of the text by sha256sum.
TEST(LoadCurve, NotesItsSource) {
    const TempFolder folder;
    write_file(folder.path() / "mud.csv", "wavelength_nm,reflectance\n400,0.1\n700,0.2\n");
    const Spectrum mud = load_curve("mud.csv", CurveRole::Reflectance, folder.path());
    ASSERT_TRUE(mud.source());
    EXPECT_EQ(mud.source()->table, (folder.path() / "mud.csv").string());
    EXPECT_EQ(mud.source()->file_sha256,
              "f673e072d28ac243bc99cc15c9f566b74681ea4226c73130cb9aab65a52e7f08");
    EXPECT_TRUE(mud.source()->is_file());
    EXPECT_EQ(mud.short_name(), "mud.csv");
    const Spectrum sand = load_curve("sand", CurveRole::Reflectance, {});
    ASSERT_TRUE(sand.source());
    EXPECT_EQ(sand.source()->table, "sand");
    EXPECT_FALSE(sand.source()->is_file());
}

TEST(LoadCurve, NeedsNoMetadataInAUsersFile) {
    const TempFolder folder;
    write_file(folder.path() / "a.csv",
               "# role: something else\nwavelength_nm,reflectance\n400,0.1\n700,0.2\n");
    EXPECT_NO_THROW(static_cast<void>(load_curve("a.csv", CurveRole::Reflectance, folder.path())));
}

// The patches of the colour chart that lie beside the scenes.
std::vector<Spectrum> chart_patches() {
    const std::filesystem::path folder =
        std::string(APHOTIC_SOURCE_DIR) + "/scenes/user/chart/patches";
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        files.push_back(entry.path().filename());
    }
    std::sort(files.begin(), files.end());
    std::vector<Spectrum> patches;
    for (const auto& file : files) {
        patches.push_back(load_curve(file.string(), CurveRole::Reflectance, folder));
    }
    return patches;
}

double lightness(double luminance_factor) {
    return 116.0 * std::cbrt(luminance_factor) - 16.0;  // CIE 015, L*
}

TEST(ChartPatches, Are24ReflectancesFrom400To720nm) {
    const std::vector<Spectrum> patches = chart_patches();
    EXPECT_EQ(patches.size(), 24U);
    for (const Spectrum& patch : patches) {
        EXPECT_TRUE(patch.range().contains(400.0) && patch.range().contains(720.0)) << patch.name();
    }
}

// McCamy, Marcus and Davidson (1976) state Y of the chart's last row, white to black, under
// illuminant C; of greys it is the same under D65.
TEST(ChartPatches, GreysAreAsLightAsPublished) {
    constexpr std::array kLuminanceFactors{0.9001, 0.5910, 0.3620, 0.1977, 0.0900, 0.0313};
    constexpr double kBetweenCharts = 1.5;  // of L*, from one chart to another
    const std::vector<Spectrum> patches = chart_patches();
    const Spectrum lamp = built_in("cie-d65", CurveRole::LampSpectrum);
    const Spectrum ybar = load_curves("cie-1931", CurveRole::ColourMatching, {})[1];
    for (std::size_t i = 0; i < kLuminanceFactors.size(); ++i) {
        const Spectrum& patch = patches.at(18 + i);
        double reflected = 0.0;
        double lit = 0.0;
        for (int lambda_nm = 380; lambda_nm <= 780; lambda_nm += 5) {
            const double light = lamp.at(lambda_nm) * ybar.at(lambda_nm);
            lit += light;
            reflected += light * patch.at(lambda_nm);
        }
        EXPECT_NEAR(lightness(reflected / lit), lightness(kLuminanceFactors[i]), kBetweenCharts)
            << patch.name();
    }
}

}  // namespace
}  // namespace aphotic::curve_loader_test
