// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/oplab_export.h"

#include "support/npy.h"
#include "support/scene_rig.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace aphotic::oplab_export_test {
namespace {

constexpr int kWidth_px = 34;
constexpr int kHeight_px = 26;
constexpr std::size_t kPixels = std::size_t{kWidth_px} * kHeight_px;
constexpr double kFloat = 1e-5;  // a few roundings, and maps right to 1e-5

std::vector<double> altitudes() {
    std::vector<double> altitude_m;
    for (int i = 0; i <= 20; ++i) altitude_m.push_back(1.0 + 0.1 * i);
    return altitude_m;
}

class OplabExport : public testing::Test {
  protected:
    void make(const Rig& rig) {
        made_ = export_oplab(folder_.path(),
                             rig,
                             {.altitude_m = altitudes(),
                              .map = {.error = 1e-5, .threads = 2},
                              .progress = [](double) {}});
        for (const double h : altitudes()) {
            Rig there = rig;
            there.sled.altitude_m = h;
            maps_.push_back(
                LightmapMaker(there, paths_of(there, {there.sled}), {}).map(there.sled));
        }
        parameters_ = npy_samples(folder_.path() / "attenuation_parameters.npy");
        gains_ = npy_samples(folder_.path() / "correction_gains.npy");
        mean_ = npy_samples(folder_.path() / "image_corrected_mean.npy");
        deviation_ = npy_samples(folder_.path() / "image_corrected_std.npy");
    }

    [[nodiscard]] double fitted(std::size_t sample, double altitude_m) const {
        const float* part = &parameters_[3 * sample];
        return part[0] * std::exp(part[1] * altitude_m) + part[2];
    }

    TempFolder folder_;
    ExportedOplab made_;
    std::vector<Lightmap> maps_;  // by the maps themselves
    std::vector<float> parameters_;
    std::vector<float> gains_;
    std::vector<float> mean_;
    std::vector<float> deviation_;
};

TEST_F(OplabExport, KeepsItsBoundsAndStatesWhatItLeaves) {
    make(habcam(kWidth_px, kHeight_px));
    ASSERT_EQ(parameters_.size(), 3 * 3 * kPixels);
    double squares = 0.0;
    double off = 0.0;
    double lit = 0.0;
    for (std::size_t i = 0; i < 3 * kPixels; ++i) {
        double least = 1e30;
        double mean = 0.0;
        double left = 0.0;
        for (std::size_t k = 0; k < maps_.size(); ++k) {
            const double light = maps_[k].samples[i];
            least = std::min(least, light);
            mean += light / static_cast<double>(maps_.size());
            left +=
                std::pow(fitted(i, altitudes()[k]) - light, 2) / static_cast<double>(maps_.size());
            if (light > 0.0) ++lit, off += std::abs(fitted(i, altitudes()[k]) / light - 1.0) > 0.1;
        }
        squares += left / (mean * mean);
        EXPECT_GT(parameters_[3 * i], 0.0F);
        EXPECT_LE(parameters_[3 * i + 1], 0.0F);
        EXPECT_GE(parameters_[3 * i + 2], 0.0F);
        EXPECT_LE(parameters_[3 * i + 2], least * (1.0 + kFloat));
        EXPECT_LE(std::sqrt(left) / mean, made_.worst + kFloat);
        EXPECT_NEAR(gains_[i] / fitted(i, 2.0), 1.0, kFloat);
    }
    EXPECT_NEAR(made_.rms, std::sqrt(squares / (3.0 * kPixels)), kFloat);
    constexpr double kAtTheLimit = 1e-3;  // samples that roundings push over it
    EXPECT_NEAR(made_.share_off, off / lit, kAtTheLimit);
}

// (I gain / f - mean) / std 3 % + 30 %, as oplab has it, is 30 % of the floor's reflectance.
TEST_F(OplabExport, MakesOplabDivideByTheLight) {
    make(habcam(kWidth_px, kHeight_px));
    const double h = altitudes()[7];
    for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t pixel = 0; pixel < kPixels; ++pixel) {
            const std::size_t i = c * kPixels + pixel;
            const double image = 1.7 * fitted(i, h);
            const double level = image * gains_[i] / fitted(i, h);
            const double out =
                (level - mean_[3 * pixel + c]) / deviation_[3 * pixel + c] * 0.03 + 0.30;
            ASSERT_NEAR(out, 1.7 * 0.30, 3.0 * kFloat) << i;
        }
    }
}

TEST_F(OplabExport, HasNoZeroWhereThereIsNoLight) {
    Rig rig = habcam(kWidth_px, kHeight_px);
    for (Strobe& strobe : rig.strobes) strobe.power = 0.0;
    make(rig);
    for (std::size_t i = 0; i < 3 * kPixels; ++i) {
        EXPECT_EQ(parameters_[3 * i], 1.0F);
        EXPECT_EQ(parameters_[3 * i + 1], 0.0F);
        EXPECT_EQ(gains_[i], 1.0F);
        EXPECT_EQ(mean_[i], 0.0F);
        EXPECT_EQ(deviation_[i], 1.0F);
    }
    EXPECT_EQ(made_.share_off, 0.0);
}

}  // namespace
}  // namespace aphotic::oplab_export_test
