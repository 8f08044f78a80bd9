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

struct Pair {
    Lab one;
    Lab other;
    double difference;
};

// Table 1 of Sharma, Wu and Dalal (2005).
const std::vector<Pair> kPairs{{{50.0000, 2.6772, -79.7751}, {50.0000, 0.0000, -82.7485}, 2.0425},
                               {{50.0000, 3.1571, -77.2803}, {50.0000, 0.0000, -82.7485}, 2.8615},
                               {{50.0000, 2.8361, -74.0200}, {50.0000, 0.0000, -82.7485}, 3.4412},
                               {{50.0000, -1.3802, -84.2814}, {50.0000, 0.0000, -82.7485}, 1.0000},
                               {{50.0000, -1.1848, -84.8006}, {50.0000, 0.0000, -82.7485}, 1.0000},
                               {{50.0000, -0.9009, -85.5211}, {50.0000, 0.0000, -82.7485}, 1.0000},
                               {{50.0000, 0.0000, 0.0000}, {50.0000, -1.0000, 2.0000}, 2.3669},
                               {{50.0000, -1.0000, 2.0000}, {50.0000, 0.0000, 0.0000}, 2.3669},
                               {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0009}, 7.1792},
                               {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0010}, 7.1792},
                               {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0011}, 7.2195},
                               {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0012}, 7.2195},
                               {{50.0000, -0.0010, 2.4900}, {50.0000, 0.0009, -2.4900}, 4.8045},
                               {{50.0000, -0.0010, 2.4900}, {50.0000, 0.0010, -2.4900}, 4.8045},
                               {{50.0000, -0.0010, 2.4900}, {50.0000, 0.0011, -2.4900}, 4.7461},
                               {{50.0000, 2.5000, 0.0000}, {50.0000, 0.0000, -2.5000}, 4.3065},
                               {{50.0000, 2.5000, 0.0000}, {73.0000, 25.0000, -18.0000}, 27.1492},
                               {{50.0000, 2.5000, 0.0000}, {61.0000, -5.0000, 29.0000}, 22.8977},
                               {{50.0000, 2.5000, 0.0000}, {56.0000, -27.0000, -3.0000}, 31.9030},
                               {{50.0000, 2.5000, 0.0000}, {58.0000, 24.0000, 15.0000}, 19.4535},
                               {{50.0000, 2.5000, 0.0000}, {50.0000, 3.1736, 0.5854}, 1.0000},
                               {{50.0000, 2.5000, 0.0000}, {50.0000, 3.2972, 0.0000}, 1.0000},
                               {{50.0000, 2.5000, 0.0000}, {50.0000, 1.8634, 0.5757}, 1.0000},
                               {{50.0000, 2.5000, 0.0000}, {50.0000, 3.2592, 0.3350}, 1.0000},
                               {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
                               {{63.0109, -31.0961, -5.8663}, {62.8187, -29.7946, -4.0864}, 1.2630},
                               {{61.2901, 3.7196, -5.3901}, {61.4292, 2.2480, -4.9620}, 1.8731},
                               {{35.0831, -44.1164, 3.7933}, {35.0232, -40.0716, 1.5901}, 1.8645},
                               {{22.7233, 20.0904, -46.6940}, {23.0331, 14.9730, -42.5619}, 2.0373},
                               {{36.4612, 47.8580, 18.3852}, {36.2715, 50.5065, 21.2231}, 1.4146},
                               {{90.8027, -2.0831, 1.4410}, {91.1528, -1.6435, 0.0447}, 1.4441},
                               {{90.9257, -0.5406, -0.9208}, {88.6381, -0.8985, -0.7239}, 1.5381},
                               {{6.7747, -0.2908, -2.4247}, {5.8714, -0.0985, -2.2286}, 0.6377},
                               {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082}};

constexpr double kLastDigit = 1e-4;  // of the table

TEST(ColourDifference, IsThePublishedOne) {
    ASSERT_EQ(kPairs.size(), 34U);
    for (std::size_t i = 0; i < kPairs.size(); ++i) {
        const auto& [one, other, difference] = kPairs[i];
        EXPECT_NEAR(ciede2000(one, other), difference, kLastDigit) << "pair " << i + 1;
        EXPECT_NEAR(ciede2000(other, one), difference, kLastDigit) << "pair " << i + 1;
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

// Columns of a table, by wavelength.
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

TEST(ColourChart, IsTheColourOfItsReflectances) {
    const std::filesystem::path root = APHOTIC_SOURCE_DIR;
    const auto observer = table(root / "spectral/data/cie-1931.csv");
    const auto light = table(root / "spectral/data/cie-d65.csv");
    std::vector<std::filesystem::path> files;
    for (const auto& entry :
         std::filesystem::directory_iterator(root / "scenes/user/chart/patches"))
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
