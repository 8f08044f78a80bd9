// SPDX-License-Identifier: BSD-3-Clause
#include "spectral/colour_difference.h"

#include "base/atomic_file.h"
#include "base/csv.h"
#include "spectral/colour_chart.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace aphotic::colour_difference_test {
namespace {

const std::filesystem::path kRoot = APHOTIC_SOURCE_DIR;

// Columns of a table, by the first.
std::map<double, std::vector<double>> table(const std::filesystem::path& file) {
    std::map<double, std::vector<double>> rows;
    bool is_header = true;
    for_each_line(read_text_file(file), [&](std::size_t, std::string_view line) {
        if (trimmed(line).empty() || line.starts_with('#')) return;
        if (is_header) {
            is_header = false;
            return;
        }
        std::vector<double> numbers;
        for (const std::string_view field : comma_fields(line))
            numbers.push_back(std::stod(std::string(field)));
        rows[numbers[0]] = {numbers.begin() + 1, numbers.end()};
    });
    return rows;
}

constexpr double kLastDigit = 1e-4;  // of the table

TEST(ColourDifference, IsThePublishedOne) {
    const auto pairs = table(kRoot / "tests/spectral/ciede2000.csv");
    ASSERT_EQ(pairs.size(), 34U);
    for (const auto& [pair, numbers] : pairs) {
        const Lab one{numbers.at(0), numbers.at(1), numbers.at(2)};
        const Lab other{numbers.at(3), numbers.at(4), numbers.at(5)};
        EXPECT_NEAR(ciede2000(one, other), numbers.at(6), kLastDigit) << "pair " << pair;
        EXPECT_NEAR(ciede2000(other, one), numbers.at(6), kLastDigit) << "pair " << pair;
        EXPECT_EQ(ciede2000(one, one), 0.0);
    }
}

// The primaries as commonly tabulated from the standard's four digits.
TEST(ColourDifference, KnowsTheColoursOfSrgb) {
    constexpr double kTable = 0.03;  // tables have a white of other last digits
    const auto expect = [](const std::array<double, 3>& rgb, const Lab& lab) {
        const Lab found = lab_of_srgb(rgb);
        EXPECT_NEAR(found.L, lab.L, kTable);
        EXPECT_NEAR(found.a, lab.a, kTable);
        EXPECT_NEAR(found.b, lab.b, kTable);
    };
    expect({1.0, 1.0, 1.0}, {100.0, 0.0, 0.0});
    expect({0.0, 0.0, 0.0}, {0.0, 0.0, 0.0});
    expect({1.0, 0.0, 0.0}, {53.24, 80.09, 67.20});
    expect({0.0, 1.0, 0.0}, {87.73, -86.18, 83.18});
    expect({0.0, 0.0, 1.0}, {32.30, 79.19, -107.86});
    expect({0.18, 0.18, 0.18}, {49.50, 0.0, 0.0});
    EXPECT_NEAR(lightness_of(0.18), 49.50, kTable);
    for (const double L : {0.0, 3.0, 8.0, 9.0, 50.0, 100.0})
        EXPECT_NEAR(lightness_of(luminance_of(L)), L, 1e-12);
    EXPECT_NEAR(srgb_decoded(0.5), 0.21404, 1e-5);
    EXPECT_NEAR(srgb_decoded(0.04), 0.04 / 12.92, 1e-12);
}

TEST(ColourDifference, MeasuresTheAngleFromGrey) {
    EXPECT_EQ(degrees_from_grey({0.3, 0.3, 0.3}), 0.0);
    EXPECT_NEAR(degrees_from_grey({7.0, 0.0, 0.0}), 54.7356, kLastDigit) << "acos(1/sqrt(3))";
    EXPECT_NEAR(degrees_from_grey({1.0, 1.0, 0.0}), 35.2644, kLastDigit) << "acos(sqrt(2/3))";
    EXPECT_NEAR(
        degrees_from_grey({1.0, 1.0, 1.0 + 3e-9}), 3e-9 * std::sqrt(2.0) / 3.0 * 57.29578, 1e-12);
    EXPECT_TRUE(std::isnan(degrees_from_grey({0.0, 0.0, 0.0})));
}

TEST(ColourChart, IsTheColourOfItsReflectances) {
    const auto observer = table(kRoot / "spectral/data/cie-1931.csv");
    const auto light = table(kRoot / "spectral/data/cie-d65.csv");
    std::vector<std::filesystem::path> files;
    for (const auto& entry :
         std::filesystem::directory_iterator(kRoot / "scenes/user/chart/patches"))
        files.push_back(entry.path());
    std::ranges::sort(files);
    ASSERT_EQ(files.size(), kChartPatches.size());
    for (std::size_t i = 0; i < files.size(); ++i) {
        EXPECT_EQ(files[i].stem().string().substr(3), kChartPatches[i].name);
        const auto patch = table(files[i]);
        std::array<double, 3> sum{};
        std::array<double, 3> white{};
        for (double nm = 380.0; nm <= 780.0; nm += 5.0) {
            for (std::size_t k = 0; k < 3; ++k) {
                const double part = observer.at(nm)[k] * light.at(nm)[0];
                white[k] += part;
                sum[k] += part * patch.at(nm)[0];
            }
        }
        const auto f = [&](std::size_t k) { return std::cbrt(sum[k] / white[k]); };
        constexpr double kDigits = 1e-3;  // as the header has them
        EXPECT_NEAR(kChartPatches[i].lab.L, 116.0 * f(1) - 16.0, kDigits) << i;
        EXPECT_NEAR(kChartPatches[i].lab.a, 500.0 * (f(0) - f(1)), kDigits) << i;
        EXPECT_NEAR(kChartPatches[i].lab.b, 200.0 * (f(1) - f(2)), kDigits) << i;
    }
    EXPECT_EQ(kChartPatches[kFirstGreyPatch].name, "white");
}

}  // namespace
}  // namespace aphotic::colour_difference_test
