// SPDX-License-Identifier: BSD-3-Clause
#include "validation/patch_score.h"

#include "base/error.h"
#include "image/exr.h"
#include "support/refusal.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

namespace aphotic::patch_score_test {
namespace {

constexpr int kWidth_px = 8;
constexpr int kHeight_px = 4;
constexpr std::size_t kPixels = std::size_t{kWidth_px} * kHeight_px;
constexpr double kFloat = 1e-6;  // roundings of samples as floats

// Left half: grey of 0.5, which alternates by 10 %. Right half: grey of 0.2 with twice the red.
class PatchScoring : public testing::Test {
  protected:
    PatchScoring() {
        std::vector<float> samples;
        for (std::size_t c = 0; c < 3; ++c) {
            for (std::size_t i = 0; i < kPixels; ++i) {
                const std::size_t column = i % kWidth_px;
                const float even = column % 2 == 0 ? 0.9F : 1.1F;
                samples.push_back(column < 4 ? 0.5F * even : c == 0 ? 0.4F : 0.2F);
            }
        }
        ExrWriter exr(path("a.exr"), kWidth_px, kHeight_px, {"R", "G", "B"}, {});
        exr.write_rows(kHeight_px, samples);
        exr.finish();
    }

    [[nodiscard]] std::string path(const std::string& name) const {
        return (folder_.path() / name).string();
    }

    PatchScores score(const std::string& lines, ComparedScale scale = ComparedScale::None) {
        std::ofstream(path("p.csv")) << "patch,x,y,w,h,reference\n" << lines;
        return score_patches({.image = path("a.exr"), .patches = path("p.csv"), .scale = scale});
    }

    TempFolder folder_;
};

TEST_F(PatchScoring, MeasuresAnglesDifferencesAndUnevenness) {
    const PatchScores scores = score("even,0,0,4,4,0.5\nred,4,0,4,2,grey\nfree,4,2,4,2,\n");
    EXPECT_NEAR(scores.patches[0].signal[1], 0.5, kFloat);
    EXPECT_NEAR(*scores.patches[0].degrees, 0.0, 1e-4);
    EXPECT_NEAR(*scores.patches[0].difference, 0.0, 1e-4);
    // Between 2, 1, 1 and 1, 1, 1.
    const double off = std::acos(4.0 / std::sqrt(18.0)) * 57.295779513;
    EXPECT_NEAR(*scores.patches[1].degrees, off, 1e-4);
    EXPECT_FALSE(scores.patches[1].difference);
    EXPECT_FALSE(scores.patches[2].degrees);
    EXPECT_NEAR(*scores.mean_degrees, off / 2.0, 1e-4);
    EXPECT_NEAR(*scores.median_degrees, off / 2.0, 1e-4);
    // 0.1 on half of the pixels.
    EXPECT_NEAR(scores.unevenness, 0.1 / std::sqrt(2.0), 1e-5);
}

// Two patches of one reference are as uneven as they differ.
TEST_F(PatchScoring, PatchesOfOneReferenceAreOfOneKind) {
    const PatchScores scores = score("a,0,0,1,1,0.5\nb,1,0,1,1,0.5\n");
    EXPECT_NEAR(scores.unevenness, 0.1, 1e-5) << "0.45 and 0.55";
    EXPECT_NEAR(score("a,0,0,1,1,grey\nb,1,0,1,1,grey\n").unevenness, 0.0, 1e-6);
}

TEST_F(PatchScoring, ScalesTakeExposureAndWhiteBalanceAway) {
    const PatchScores whole = score("a,0,0,4,4,0.25\n", ComparedScale::OfImage);
    EXPECT_NEAR(whole.scale[0], 2.0, kFloat);
    EXPECT_NEAR(*whole.patches[0].difference, 0.0, 1e-4);
    const PatchScores each = score("a,4,0,4,4,0.2\n", ComparedScale::OfEachChannel);
    EXPECT_NEAR(each.scale[0], 2.0, kFloat);
    EXPECT_NEAR(each.scale[2], 1.0, kFloat);
    EXPECT_NEAR(*each.patches[0].degrees, 0.0, 1e-4);
    EXPECT_THROW(score("a,0,0,4,4,grey\n", ComparedScale::OfImage), InputError);
    EXPECT_THROW(score("a,0,0,4,4,orange\n", ComparedScale::OfEachChannel), InputError);
}

// A colour beyond sRGB is clipped to 0 in one channel, and is that far off. Grey is never.
TEST_F(PatchScoring, TakesColoursThatLackAChannel) {
    std::vector<float> samples(3 * kPixels, 0.25F);
    std::fill_n(samples.begin(), kPixels, 0.0F);
    ExrWriter exr(path("a.exr"), kWidth_px, kHeight_px, {"R", "G", "B"}, {});
    exr.write_rows(kHeight_px, samples);
    exr.finish();
    const PatchScores scores = score("cyan,0,0,4,4,cyan\n");
    EXPECT_EQ(scores.patches[0].signal[0], 0.0);
    EXPECT_TRUE(std::isfinite(*scores.patches[0].difference));
    EXPECT_EQ(scores.unevenness, 0.0);
    const std::string said = refusal_of([&] { score("grey,0,0,4,4,0.5\n"); });
    EXPECT_EQ(said,
              path("a.exr") +
                  ": the patch 'grey' has a mean R of 0; allowed: above 0, of a "
                  "grey patch");
}

TEST_F(PatchScoring, RefusesPatchesBeyondTheImage) {
    const std::string said = refusal_of([&] { score("a,0,0,4,4,\nb,6,1,3,3,\n"); });
    EXPECT_EQ(said,
              path("p.csv") + ":3: found a patch up to 9, 4; allowed: the image's 8 x 4 pixels");
}

}  // namespace
}  // namespace aphotic::patch_score_test
