// SPDX-License-Identifier: BSD-3-Clause
#include "sweep/sweep_file.h"

#include "base/error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace aphotic::sweep_file_test {
namespace {

const std::string kHead = "command = \"trace\"\nrig = \"rig.toml\"\n";

SweepFile parsed(const std::string& text) {
    return parse_sweep_file(kHead + text, "sweep.toml");
}

std::vector<double> numbers_of(const std::vector<SweepPoint>& points, std::size_t key) {
    std::vector<double> numbers;
    for (const SweepPoint& point : points) numbers.push_back(std::get<double>(point.at(key)));
    return numbers;
}

std::vector<double> range(const std::string& range) {
    return numbers_of(points_of(parsed("[[vary]]\nkey = \"k\"\nrange = " + range)), 0);
}

TEST(SweepFile, CombinesEachValueWithEach) {
    const std::vector<SweepPoint> points = points_of(parsed(R"(
[[vary]]
key = "water.multiple"
values = [0.5, 1]
[[vary]]
key = "strobe.fore.spectrum"
values = ["xenon-flash", "led"]
[[vary]]
key = "strobe.fore.position_m"
values = [[0, 0, 1], [0, 1, 0], [1, 0, 0]]
)"));
    ASSERT_EQ(points.size(), 2U * 2U * 3U);
    EXPECT_EQ(std::set<SweepPoint>(points.begin(), points.end()).size(), points.size());
    // The last key changes first.
    EXPECT_EQ(words_of(points[0][2]), "0 0 1");
    EXPECT_EQ(words_of(points[1][2]), "0 1 0");
    EXPECT_EQ(words_of(points[3][1]), "led");
    EXPECT_EQ(words_of(points[5][0]), "0.5");
    EXPECT_EQ(words_of(points[6][0]), "1");
}

TEST(SweepFile, WithoutKeysIsOnePoint) {
    EXPECT_EQ(points_of(parsed("")).size(), 1U);
}

TEST(SweepFile, RangeHasBothEndsAndTheDigitsOfItsSteps) {
    EXPECT_EQ(range("[20, 30, 5]"), (std::vector<double>{20, 25, 30}));
    EXPECT_EQ(range("[0.1, 0.4, 0.1]"), (std::vector<double>{0.1, 0.2, 0.3, 0.4}));
    EXPECT_EQ(range("[-0.3, 0.3, 0.1]"),
              (std::vector<double>{-0.3, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3}));
    EXPECT_EQ(range("[3, 1, -1]"), (std::vector<double>{3, 2, 1}));
    EXPECT_EQ(range("[7, 7, 1]"), (std::vector<double>{7}));
    EXPECT_EQ(range("[1e-12, 3e-12, 1e-12]"), (std::vector<double>{1e-12, 2e-12, 3e-12}));
}

std::string hypercube(int samples, int seed) {
    return "samples = " + std::to_string(samples) + "\nseed = " + std::to_string(seed) + R"(
[[vary]]
key = "a"
between = [-2, 2]
[[vary]]
key = "b"
values = [1, 2]
[[vary]]
key = "c"
between = [10, 11]
)";
}

// What makes it a Latin hypercube.
TEST(SweepFile, HypercubeHasOnePointInEachPartOfEachKey) {
    constexpr int kSamples = 24;
    for (int seed = 0; seed < 20; ++seed) {
        const std::vector<SweepPoint> points = points_of(parsed(hypercube(kSamples, seed)));
        ASSERT_EQ(points.size(), 2U * kSamples);
        for (std::size_t first : {std::size_t{0}, std::size_t{kSamples}}) {
            std::set<int> of_a;
            std::set<int> of_c;
            for (std::size_t i = first; i < first + kSamples; ++i) {
                const double a = std::get<double>(points[i][0]);
                const double c = std::get<double>(points[i][2]);
                of_a.insert(static_cast<int>(std::floor((a + 2.0) / 4.0 * kSamples)));
                of_c.insert(static_cast<int>(std::floor((c - 10.0) * kSamples)));
            }
            EXPECT_EQ(of_a.size(), kSamples) << "seed " << seed;
            EXPECT_EQ(of_c.size(), kSamples) << "seed " << seed;
            EXPECT_EQ(*of_a.begin(), 0);
            EXPECT_EQ(*of_a.rbegin(), kSamples - 1);
        }
    }
}

// Each order of three parts comes as often: 1000 times of 6000, whose standard deviation is
// sqrt(6000 / 6 * 5 / 6) = 29.
TEST(SweepFile, HypercubeTakesEachOrderAlike) {
    constexpr int kDraws = 6000;
    constexpr double kFiveSigma = 5.0 * 29.0;
    std::map<std::vector<bool>, int> counts;
    for (int seed = 0; seed < kDraws; ++seed) {
        const std::vector<SweepPoint> points =
            points_of(parsed("samples = 3\nseed = " + std::to_string(seed) +
                             "\n[[vary]]\nkey = \"a\"\nbetween = [0, 1]\n"));
        const std::vector<double> x = numbers_of(points, 0);
        ++counts[{x[0] < x[1], x[1] < x[2], x[0] < x[2]}];
    }
    ASSERT_EQ(counts.size(), 6U);
    for (const auto& [order, count] : counts) EXPECT_NEAR(count, kDraws / 6.0, kFiveSigma);
}

TEST(SweepFile, TheSeedDecidesTheHypercube) {
    EXPECT_EQ(points_of(parsed(hypercube(5, 3))), points_of(parsed(hypercube(5, 3))));
    EXPECT_NE(points_of(parsed(hypercube(5, 3))), points_of(parsed(hypercube(5, 4))));
}

TEST(SweepFile, SaysWhatIsWrongAndWhatIsAllowed) {
    const std::map<std::string, std::string> wrong{
        {"[[vary]]\nkey = \"a\"\n", "found none of values, range and between; allowed: one"},
        {"[[vary]]\nkey = \"a\"\nvalues = [1]\nrange = [1, 2, 1]\n",
         "found 2 of values, range and between; allowed: one"},
        {"[[vary]]\nkey = \"a\"\nvalues = []\n", "found []; allowed: a list of numbers"},
        {"[[vary]]\nkey = \"a\"\nvalues = [true]\n", "found [true]; allowed: a list of numbers"},
        {"[[vary]]\nkey = \"a\"\nvalues = [nan]\n", "allowed: a list of numbers"},
        {"[[vary]]\nkey = \"a\"\nrange = [1, 2, 0.3]\n", "whose steps end at last"},
        {"[[vary]]\nkey = \"a\"\nrange = [1, 2, 0]\n", "whose steps end at last"},
        {"[[vary]]\nkey = \"a\"\nrange = [1, 2, -1]\n", "whose steps end at last"},
        {"[[vary]]\nkey = \"a\"\nrange = [1, 2]\n", "allowed: an array of 3 numbers"},
        {"[[vary]]\nkey = \"a\"\nrange = [1, 100000, 1]\n", "allowed: up to 20000 values"},
        {"samples = 2\n[[vary]]\nkey = \"a\"\nbetween = [2, 1]\n", "the smaller one first"},
        {"[[vary]]\nkey = \"a\"\nbetween = [1, 2]\n", "vary: found `between` without samples"},
        {"samples = 2\nseed = 1.5\n[[vary]]\nkey = \"a\"\nbetween = [1, 2]\n",
         "a whole number from 0"},
        {"samples = 2\n", "samples: allowed only where a key has `between`"},
        {"seed = 2\n", "seed: allowed only where a key has `between`"},
        {"samples = 2.5\n[[vary]]\nkey = \"a\"\nbetween = [1, 2]\n", "a whole number from 1"},
        {"[[vary]]\nkey = \"a\"\nvalues = [1]\n[[vary]]\nkey = \"a\"\nvalues = [1]\n",
         "found a twice"},
        {"[[vary]]\nkey = \"a\"\nvalues = [1]\nstep = 2\n", "step"},
        {"shares = 2\n", "shares: allowed only for correct"},  // of trace
        {"images = [\"x\"]\n", "images: allowed only for correct and fit"},
        {"cores = 0\n", "a number from 1 to 1024"},
        {"[[vary]]\nkey = \"a\"\nrange = [1, 200, 1]\n[[vary]]\nkey = \"b\"\nrange = [1, 200, "
         "1]\n",
         "found more than 20000 tasks"}};
    for (const auto& [text, part] : wrong) {
        try {
            (void)parsed(text);
            ADD_FAILURE() << "accepted: " << text;
        } catch (const InputError& error) {
            const std::string message = error.what();
            EXPECT_TRUE(message.starts_with("sweep.toml")) << message;
            EXPECT_NE(message.find(part), std::string::npos) << message << "\nof " << text;
        }
    }
    EXPECT_THROW((void)parse_sweep_file("command = \"study\"\nrig = \"r\"\n", "s"), InputError);
    EXPECT_THROW((void)parse_sweep_file("command = \"fit\"\nrig = \"r\"\n", "s"), InputError);
    EXPECT_THROW((void)parse_sweep_file("command = ", "s"), InputError);
}

}  // namespace
}  // namespace aphotic::sweep_file_test
