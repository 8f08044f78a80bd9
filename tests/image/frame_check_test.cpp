// SPDX-License-Identifier: BSD-3-Clause
#include "image/frame_check.h"

#include "base/error.h"
#include "image/exr.h"
#include "support/refusal.h"
#include "tests/support/temp_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace aphotic::frame_check_test {
namespace {

namespace fs = std::filesystem;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

constexpr int kWidth = 5;
constexpr int kHeight = 150;  // more than any block of rows, and no multiple of 16 or 64

// All 1, but for one sample.
void write_frame(const fs::path& file,
                 std::size_t channel,
                 std::size_t row,
                 std::size_t column,
                 float sample,
                 const std::vector<std::string>& channels = {"R", "G", "B"}) {
    constexpr std::size_t kPlane = std::size_t{kWidth} * kHeight;
    std::vector<float> samples(channels.size() * kPlane, 1.0F);
    samples[channel * kPlane + row * kWidth + column] = sample;
    ExrWriter out(file, kWidth, kHeight, channels, {});
    out.write_rows(kHeight, samples);
    out.finish();
}

TEST(CheckSamples, AllowsZeroToBelowTheLargestHalf) {
    const std::vector good{0.0F, -0.0F, 1e-7F, 65503.0F};
    EXPECT_NO_THROW(check_samples("f.exr", "R", good, 4, 0));
    EXPECT_NO_THROW(check_samples("f.exr", "R", {}, 4, 0));
}

struct BadSample {
    float value;
    const char* words;
};

constexpr BadSample kBadSamples[]{{kNan, "nan"},
                                  {-kNan, "-nan"},
                                  {kInf, "inf"},
                                  {-kInf, "-inf"},
                                  {-1.0F, "-1"},
                                  {65504.0F, "65504"}};

TEST(CheckSamples, NamesTheFileTheChannelAndThePixel) {
    for (const BadSample& bad : kBadSamples) {
        std::vector<float> samples(12, 1.0F);
        samples[6] = bad.value;  // of rows of four: row 1, column 2
        EXPECT_EQ(run_error_of([&] { check_samples("f.exr", "G", samples, 4, 10); }),
                  std::string("f.exr: channel G is ") + bad.words +
                      " at column 2, row 11; allowed: 0 to below 65504");
    }
}

TEST(CheckSamples, NamesTheFirstBadPixel) {
    const std::vector samples{1.0F, kInf, kNan};
    EXPECT_EQ(run_error_of([&] { check_samples("f.exr", "R", samples, 3, 0); }),
              "f.exr: channel R is inf at column 1, row 0; allowed: 0 to below 65504");
}

TEST(CheckSize, SaysWhatWasFoundAndWhatIsWanted) {
    EXPECT_NO_THROW(check_size("f.exr", 4, 3, 4, 3));
    EXPECT_EQ(run_error_of([] { check_size("f.exr", 4, 3, 3, 4); }),
              "f.exr: found 4 x 3 pixels; allowed: 3 x 4");
    EXPECT_EQ(run_error_of([] { check_size("f.exr", 4, 3, 4, 5); }),
              "f.exr: found 4 x 3 pixels; allowed: 4 x 5");
}

TEST(CheckFrame, FindsABadSampleAnywhere) {
    const TempFolder folder;
    const fs::path file = folder.path() / "frame.exr";
    const std::vector<std::string> channels{"R", "G", "B"};
    for (std::size_t c = 0; c < channels.size(); ++c) {
        for (const std::size_t row : {0U, 63U, 64U, 128U, 149U}) {
            write_frame(file, c, row, kWidth - 1, kNan);
            EXPECT_EQ(run_error_of([&] { check_frame(file, kWidth, kHeight); }),
                      file.string() + ": channel " + channels[c] + " is nan at column 4, row " +
                          std::to_string(row) + "; allowed: 0 to below 65504");
        }
    }
    write_frame(file, 0, 0, 0, 65503.0F);
    EXPECT_NO_THROW(check_frame(file, kWidth, kHeight));
}

TEST(CheckFrame, WantsItsSizeAndItsChannels) {
    const TempFolder folder;
    const fs::path file = folder.path() / "frame.exr";
    write_frame(file, 0, 0, 0, 1.0F);
    EXPECT_EQ(run_error_of([&] { check_frame(file, kHeight, kWidth); }),
              file.string() + ": found 5 x 150 pixels; allowed: 150 x 5");
    write_frame(file, 0, 0, 0, 1.0F, {"R", "G"});
    EXPECT_EQ(run_error_of([&] { check_frame(file, kWidth, kHeight); }),
              file.string() + ": has no channel B");
}

}  // namespace
}  // namespace aphotic::frame_check_test
