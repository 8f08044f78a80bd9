// SPDX-License-Identifier: BSD-3-Clause
//
// A survey in coastal water: what the reference traced, veil included, over floors of known
// reflectance, `correct` makes flat and right at every altitude; and not when it leaves the veil
// in.
#include "image/exr.h"
#include "support/has.h"
#include "support/run_command.h"
#include "support/scene_text.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace aphotic::veil_survey_test {
namespace {

namespace fs = std::filesystem;

constexpr std::array kAltitudes{"1.5", "2.0", "3.0"};
// The aim of the survey's proof, of flatness and of colour.
constexpr double kFlat = 0.02;
// What the maps promise besides: measured is under 2e-4.
constexpr double kRight = 1e-3;

std::string rig_over(int percent, const std::string& altitude_m) {
    return with(
        read_text_file(APHOTIC_SOURCE_DIR "/tests/cli/coastal_survey.toml"),
        {{"altitude_m", altitude_m}, {"reflectance", fmt::format("\"grey{}.csv\"", percent)}});
}

class VeilSurvey : public testing::Test {
  protected:
    // Traced once, which takes most of the time.
    static void SetUpTestSuite() {
        survey_ = std::make_unique<TempFolder>();
        for (const int percent : {18, 30, 45}) {
            const double rho = percent / 100.0;
            write_file(folder() / fmt::format("grey{}.csv", percent),
                       fmt::format("wavelength_nm,reflectance\n300,{}\n900,{}\n", rho, rho));
            const fs::path images = folder() / std::to_string(percent);
            fs::create_directory(images);
            std::string navigation = "image,altitude_m\n";
            for (const char* altitude_m : kAltitudes) {
                write_file(folder() / "rig.toml", rig_over(percent, altitude_m));
                expect_done("trace rig.toml -o traced");
                fs::rename(folder() / "traced" / "image.exr",
                           images / fmt::format("at-{}.exr", altitude_m));
                fs::remove_all(folder() / "traced");
                navigation += fmt::format("at-{},{}\n", altitude_m, altitude_m);
            }
            write_file(folder() / "nav.csv", navigation);
        }
        write_file(folder() / "rig.toml", rig_over(30, "2.0"));
    }
    static void TearDownTestSuite() { survey_.reset(); }
    void SetUp() override {
        for (const int percent : {18, 30, 45}) fs::remove_all(folder() / result(percent));
    }

    static const fs::path& folder() { return survey_->path(); }

    static void expect_done(const Arguments& arguments) {
        const CommandResult run = run_aphotic(folder(), arguments);
        ASSERT_EQ(run.status, 0) << run.err;
    }

    static Arguments correction(int percent) {
        return fmt::format(
            "correct {} --rig rig.toml --nav nav.csv --format exr -o {}", percent, result(percent));
    }

    // The survey over the rig's own floor has the gain, the charts take it.
    static void correct(int percent, const Arguments& more) {
        expect_done(correction(percent) + (percent == 30 ? "" : "--gain-from " + result(30)) +
                    more);
    }

    static std::string result(int percent) { return fmt::format("corrected-{}", percent); }

    // Over the altitudes, the worst of unevenness and of departure from the reflectance.
    struct Off {
        double uneven = 0.0;
        double level = 0.0;
    };
    Off judge(int percent) {
        Off off;
        for (const char* altitude_m : kAltitudes) {
            ExrReader reader(folder() / result(percent) / fmt::format("at-{}.exr", altitude_m));
            for (const char* channel : {"R", "G", "B"}) {
                const std::vector<float> samples = reader.planes(std::vector<std::string>{channel});
                double sum = 0.0;
                double squares = 0.0;
                for (const float sample : samples) {
                    sum += sample;
                    squares += static_cast<double>(sample) * sample;
                }
                const double mean = sum / static_cast<double>(samples.size());
                const double variance = squares / static_cast<double>(samples.size()) - mean * mean;
                off.uneven = std::max(off.uneven, std::sqrt(std::max(0.0, variance)) / mean);
                off.level = std::max(off.level, std::abs(mean / (percent / 100.0) - 1.0));
            }
        }
        RecordProperty(fmt::format("uneven_{}", percent), std::to_string(off.uneven));
        RecordProperty(fmt::format("level_{}", percent), std::to_string(off.level));
        return off;
    }

  private:
    static inline std::unique_ptr<TempFolder> survey_;
};

TEST_F(VeilSurvey, ChartsAreFlatAndOfTheirReflectance) {
    for (const int percent : {30, 18, 45}) {
        correct(percent, {});
        const Off off = judge(percent);
        EXPECT_LT(off.uneven, kRight) << percent;
        EXPECT_LT(off.level, kRight) << percent;
    }
}

TEST_F(VeilSurvey, WithTheVeilLeftInTheyAreNot) {
    for (const int percent : {30, 18, 45}) {
        correct(percent, "--no-veil");
        const Off off = judge(percent);
        EXPECT_GT(off.uneven, kFlat) << percent;
        EXPECT_GT(off.level, kFlat) << percent;
    }
}

// Results of one kind are not continued as the other.
TEST_F(VeilSurvey, ARunWithoutIsAnother) {
    correct(30, "--no-veil");
    const CommandResult again = run_aphotic(folder(), correction(30));
    EXPECT_TRUE(has(again.out, "3 images corrected")) << again.err;
}

// A map's promise counts it, and a correction to another is another.
TEST_F(VeilSurvey, HasTheToleranceThatWasAskedFor) {
    constexpr double kRounding = 1e-12;
    const auto promise = [](const std::string& more) {
        const CommandResult run =
            run_aphotic(folder(), "lightmap rig.toml -o map.exr --json " + more);
        return nlohmann::json::parse(run.out).at("promise").at("error").get<double>();
    };
    EXPECT_NEAR(promise("--tolerance 0.01") - promise("--tolerance 0.002"), 0.008, kRounding);
    EXPECT_NEAR(promise("--tolerance 0.0001"), promise(""), kRounding);

    const auto images_corrected = [](const std::string& tolerance) {
        return run_aphotic(folder(), correction(30) + ("--tolerance " + tolerance)).out;
    };
    EXPECT_TRUE(has(images_corrected("0.01"), "3 images corrected"));
    EXPECT_FALSE(has(images_corrected("0.01"), "3 images corrected"));
    EXPECT_TRUE(has(images_corrected("0.001"), "3 images corrected"));
    // 0.001 is a correction's own.
    EXPECT_FALSE(has(run_aphotic(folder(), correction(30)).out, "3 images corrected"));
}

}  // namespace
}  // namespace aphotic::veil_survey_test
