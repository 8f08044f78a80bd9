// SPDX-License-Identifier: BSD-3-Clause
//
// Raw files that the test writes by Adobe's specification of DNG, number for number.
#include "image/raw_file.h"

#include "base/error.h"
#include "support/dng.h"
#include "support/effort.h"
#include "support/has.h"
#include "support/refusal.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace aphotic::raw_file_test {
namespace {

constexpr std::uint32_t kWidth = 64;  // LibRaw reads none that is much smaller
constexpr std::uint32_t kHeight = 48;

std::vector<std::uint16_t> some_numbers(std::size_t count) {
    std::vector<std::uint16_t> numbers;
    for (std::size_t i = 0; i < count; ++i)
        numbers.push_back(static_cast<std::uint16_t>(100 + i * 37 % 3900));
    return numbers;
}

Dng small_dng() {
    return {.width = kWidth,
            .height = kHeight,
            .samples = some_numbers(std::size_t{kWidth} * kHeight),
            .black = {64},
            .white = 4095};
}

class RawFileTest : public testing::Test {
  protected:
    [[nodiscard]] RawFile opened(const Dng& dng) const {
        write_file(file_, dng_of(dng));
        return open_raw_file(file_);
    }

    TempFolder folder_;
    std::filesystem::path file_ = folder_.path() / "a.dng";
};

TEST_F(RawFileTest, HasTheSensorsOwnNumbersPatternAndLevels) {
    const std::map<std::string, std::vector<std::uint8_t>> patterns{{"RGGB", {0, 1, 1, 2}},
                                                                    {"BGGR", {2, 1, 1, 0}},
                                                                    {"GRBG", {1, 0, 2, 1}},
                                                                    {"GBRG", {1, 2, 0, 1}}};
    for (const auto& [name, sites] : patterns) {
        Dng dng = small_dng();
        dng.pattern = sites;
        const RawFile raw = opened(dng);
        EXPECT_EQ(raw.pattern, name);
        EXPECT_EQ(raw.width_px, static_cast<int>(kWidth));
        EXPECT_EQ(raw.height_px, static_cast<int>(kHeight));
        EXPECT_EQ(raw.black, 64.0);
        EXPECT_EQ(raw.white, 4095.0);
        EXPECT_EQ(raw.samples(), std::vector<float>(dng.samples.begin(), dng.samples.end()));
    }
}

// The rim is covered; the pattern begins where the active area does.
TEST_F(RawFileTest, LeavesTheCoveredRimOut) {
    Dng dng = small_dng();
    dng.active_area = {2, 4, 42, 60};
    const RawFile raw = opened(dng);
    EXPECT_EQ(raw.width_px, 56);
    EXPECT_EQ(raw.height_px, 40);
    EXPECT_EQ(raw.pattern, "RGGB");
    const std::vector<float> samples = raw.samples();
    EXPECT_EQ(samples[0], dng.samples[2 * kWidth + 4]);
    EXPECT_EQ(samples.back(), dng.samples[41 * kWidth + 59]);
}

// Over the least black, every site's number is its light.
TEST_F(RawFileTest, BlacksOfSitesThatDifferBecomeOne) {
    Dng dng = small_dng();
    dng.black = {60, 64, 65, 70};
    const RawFile raw = opened(dng);
    EXPECT_EQ(raw.black, 60.0);
    EXPECT_EQ(raw.white, 4095.0 - 10.0);
    const std::vector<float> samples = raw.samples();
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const std::size_t site = i / kWidth % 2 * 2 + i % kWidth % 2;
        EXPECT_EQ(samples[i] - 60.0F, static_cast<float>(dng.samples[i] - dng.black[site])) << i;
    }
}

TEST_F(RawFileTest, ALinearDngHasThreePlanes) {
    Dng dng = small_dng();
    dng.colours = 3;
    dng.pattern = {};
    dng.black = {};
    dng.samples = some_numbers(std::size_t{3} * kWidth * kHeight);
    const RawFile raw = opened(dng);
    EXPECT_EQ(raw.pattern, "none");
    const std::vector<float> planes = raw.samples();
    const std::size_t pixels = std::size_t{kWidth} * kHeight;
    ASSERT_EQ(planes.size(), 3 * pixels);
    for (std::size_t i = 0; i < planes.size(); ++i)
        EXPECT_EQ(planes[i], dng.samples[i % pixels * 3 + i / pixels]) << i;
}

TEST_F(RawFileTest, WhatIsCutAnywhereIsRefusedOrHasAllItsNumbers) {
    constexpr std::size_t kCuts = std::max(cases(60), 20);
    const Dng dng = small_dng();
    const std::string bytes = dng_of(dng);
    const std::vector<float> whole(dng.samples.begin(), dng.samples.end());
    std::size_t refused = 0;
    for (std::size_t cut = 0; cut < kCuts; ++cut) {
        write_file(file_, bytes.substr(0, (bytes.size() - 1) * cut / (kCuts - 1)));
        try {
            EXPECT_EQ(open_raw_file(file_).samples(), whole) << cut;
        } catch (const InputError& error) {
            EXPECT_TRUE(
                std::string(error.what()).starts_with(file_.string() + ": cannot be read: "))
                << error.what();
            ++refused;
        }
    }
    EXPECT_EQ(refused, kCuts);
}

TEST_F(RawFileTest, OtherMosaicsAreRefused) {
    Dng dng = small_dng();
    dng.pattern = {0, 2, 1, 1};
    const std::string said = refusal_of([&] { return opened(dng); });
    EXPECT_TRUE(has(said, "allowed: RGGB, BGGR, GRBG, GBRG"));
}

}  // namespace
}  // namespace aphotic::raw_file_test
