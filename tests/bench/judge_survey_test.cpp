// SPDX-License-Identifier: BSD-3-Clause
//
// The program `judge`, on a survey of even light that is written here.
#include "base/atomic_file.h"
#include "image/exr.h"
#include "plugin/process.h"
#include "support/png.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <functional>

namespace aphotic::judge_survey_test {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth_px = 30;
constexpr int kHeight_px = 20;

// Light tiles on the left half, dark ones on the right.
float chart_signal(int column) {
    return column < kWidth_px / 2 ? 2.5F : 1.0F;
}

class Judge : public testing::Test {
  protected:
    Judge() {
        for (const char* part : {"card/truth", "truth", "flat", "tilted"}) {
            fs::create_directories(folder_.path() / part);
        }
        for (const char* name : {"000001.exr", "000010.exr"}) {
            put("card/truth", name, [](int) { return 1.0F; });
            put("truth", name, chart_signal);
            put("flat", name, chart_signal);
            put("tilted", name, [](int column) {
                return chart_signal(column) * (column % 2 == 0 ? 1.1F : 0.9F);
            });
        }
    }
    void put(const char* part, const char* name, const std::function<float(int)>& signal) const {
        std::vector<float> samples;
        for (int i = 0; i < 3 * kWidth_px * kHeight_px; ++i)
            samples.push_back(signal(i % kWidth_px));
        ExrWriter writer(folder_.path() / part / name, kWidth_px, kHeight_px, {"R", "G", "B"}, {});
        writer.write_rows(kHeight_px, samples);
        writer.finish();
    }
    int judge(std::vector<std::string> arguments) {
        constexpr double kTimeout_s = 60.0;
        arguments.insert(arguments.begin(), {".", "card"});
        return run_process({.executable = APHOTIC_JUDGE,
                            .arguments = arguments,
                            .folder = folder_.path(),
                            .environment = {},
                            .log = folder_.path() / "log"},
                           kTimeout_s)
            .exit_code;
    }
    [[nodiscard]] std::string said() const { return read_text_file(folder_.path() / "log"); }

    TempFolder folder_;
};

TEST_F(Judge, SaysHowFlatEachCorrectionIs) {
    ASSERT_EQ(judge({"none=flat", "bad=tilted", "--json"}), 0) << said();
    const nlohmann::json scores = nlohmann::json::parse(said());
    constexpr double kFloatError = 1e-6;
    EXPECT_EQ(scores["none"]["images"], 2);
    EXPECT_NEAR(scores["none"]["unevenness"], 0.0, kFloatError);
    EXPECT_NEAR(scores["none"]["tone"], 1.0, kFloatError);
    // Columns 0 to 13 and 16 to 29 are off the tiles' rims; half of each has 1.1, half 0.9.
    EXPECT_NEAR(scores["bad"]["unevenness"].get<double>(), 0.1, kFloatError);
}

TEST_F(Judge, JudgesTheFirstImagesWhenAsked) {
    ASSERT_EQ(judge({"none=flat", "--images", "5", "--json"}), 0) << said();
    EXPECT_EQ(nlohmann::json::parse(said())["none"]["images"], 1);
}

TEST_F(Judge, ShowsImagesSideBySideUnderOneExposureAColumn) {
    ASSERT_EQ(judge({"a=flat", "b=tilted", "--picture", "sheet.png", "--show", "000001,000010"}), 0)
        << said();
    constexpr int kGap_px = 6;
    const DecodedPng sheet = decode_png(read_text_file(folder_.path() / "sheet.png"));
    EXPECT_EQ(sheet.width, 2 * kWidth_px + kGap_px);
    EXPECT_EQ(sheet.height, 2 * kHeight_px + kGap_px);
    // Light tiles are 0.35 in linear light, which sRGB writes as 0.6262 (IEC 61966-2-1), 160 of
    // 255.
    EXPECT_EQ(sheet.pixels[0], 0xA0A0A0U);
}

TEST_F(Judge, RefusesWhatIsNotThere) {
    EXPECT_EQ(judge({"a=nowhere"}), 2);
    EXPECT_NE(said().find("allowed: NAME=DIR"), std::string::npos) << said();
    EXPECT_EQ(judge({"a=flat", "--picture", "sheet.txt"}), 2);
    EXPECT_NE(said().find("allowed: a name that ends in"), std::string::npos) << said();
    fs::remove(folder_.path() / "flat" / "000010.exr");
    EXPECT_EQ(judge({"a=flat"}), 2);
    EXPECT_NE(said().find("flat: found no image 000010"), std::string::npos) << said();
}

}  // namespace
}  // namespace aphotic::judge_survey_test
