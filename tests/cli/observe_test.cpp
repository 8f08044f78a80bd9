// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic observe and aphotic baseline on small surveys, as a user runs them.
#include "image/exr.h"
#include "support/absurd_images.h"
#include "support/command_test.h"
#include "support/has.h"
#include "support/tiff.h"
#include "survey/images/raw_image.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace aphotic::observe_test {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth_px = 20;
constexpr int kHeight_px = 12;
constexpr std::size_t kPixels = kWidth_px * kHeight_px;
constexpr double kFloat = 2e-6;  // a few roundings of a float, relative

using Plane = std::vector<float>;
const std::vector<std::string> kRgb{"R", "G", "B"};

Plane channel_of(const fs::path& file, const std::string& channel) {
    ExrReader exr(file);
    Plane samples(static_cast<std::size_t>(exr.width_px()) *
                  static_cast<std::size_t>(exr.height_px()));
    exr.read_rows(0, exr.height_px(), std::vector<std::string>{channel}, samples);
    return samples;
}

// Light that falls off to the right, a little more in blue.
float light(std::size_t pixel, std::size_t channel) {
    const double x = (static_cast<double>(pixel % kWidth_px) + 0.5) / kWidth_px;
    return static_cast<float>(100.0 * (1.0 - (0.4 + 0.1 * static_cast<double>(channel)) * x));
}

class Survey : public CommandTest {
  protected:
    static void write_exr(const fs::path& file,
                          const std::vector<std::string>& channels,
                          const Plane& samples,
                          int width_px = kWidth_px) {
        const int height_px = static_cast<int>(samples.size() / channels.size()) / width_px;
        ExrWriter exr(file, width_px, height_px, channels, {});
        exr.write_rows(height_px, samples);
        exr.finish();
    }

    // The light times a factor of the image.
    void write_image(const std::string& name, float factor) {
        Plane samples;
        for (std::size_t c = 0; c < kRgb.size(); ++c) {
            for (std::size_t i = 0; i < kPixels; ++i) samples.push_back(factor * light(i, c));
        }
        fs::create_directories(path("raw"));
        write_exr(path("raw") / (name + ".exr"), kRgb, samples);
    }

    // Factors 0.5, 1 and 3 at 2 m, and a tenth of the light higher up.
    void write_survey() {
        write_image("a", 0.5F);
        write_image("b", 1.0F);
        write_image("c", 3.0F);
        write_image("high", 0.1F);
        write_file(path("nav.csv"),
                   "image,altitude_m,pitch_deg,roll_deg\n"
                   "a.exr,1.9,1,0\nb.exr,2.0,2,0\nc.exr,2.1,6,0\nhigh.exr,3.5,0,0\n");
    }
    CommandResult observe(const Arguments& options) {
        Arguments arguments("observe raw --nav nav.csv -o map.exr");
        if (std::ranges::find(options, "--altitude") == options.end()) arguments += "--altitude 2";
        arguments += options;
        return aphotic(arguments);
    }
};
using CommandObserve = Survey;
using CommandBaseline = Survey;

TEST_F(CommandObserve, AnAttitudeThatNobodyToldIsUnknown) {
    write_survey();
    write_file(path("nav.csv"),
               "image,altitude_m,roll_deg\na.exr,2,3\nb.exr,2,1\nc.exr,2,2\nhigh.exr,3,0\n");
    const CommandResult words = observe({});
    EXPECT_EQ(words.status, 0) << words.err;
    EXPECT_TRUE(has(words.out, "pitch unknown, roll 2.00 deg"));
    EXPECT_TRUE(nlohmann::json::parse(observe("--json").out)["pitch_deg"].is_null());
}

// What these make of poses is NavigationFile's concern.
TEST_F(CommandObserve, TakesWhatAltitudesAreAndTheMountingFromARig) {
    write_survey();
    std::string rig = read_text_file(std::string(APHOTIC_SOURCE_DIR) + "/scenes/habcam.toml");
    rig.replace(rig.find("[sled]\n"), 7, "[sled]\naltitude_is = \"plumb\"\n");
    rig.replace(rig.find("[camera]\n"),
                9,
                "[camera]\nposition_m = [0, 0, 1]\norientation_deg = [0, -30, 0]\n");
    write_file(path("mounted.toml"), rig);
    const CommandResult result = observe("--rig mounted.toml --within 9 --json");
    ASSERT_EQ(result.status, 0) << result.err;
    const auto navigation = nlohmann::json::parse(result.out)["navigation"];
    EXPECT_EQ(navigation["altitude_is"], "plumb");
    EXPECT_EQ(navigation["orientation_deg"].size(), 3U);
}

TEST_F(CommandObserve, MedianAndTrimmedMeanOfBandsAreThoseOfTheWhole) {
    write_survey();
    for (const std::string method : {"median", "trimmed"}) {
        // A few hundred bytes: bands of 83 samples, which end within rows and channels.
        for (const std::string memory : {"1000", "0.001"}) {
            ASSERT_EQ(
                observe(fmt::format("--method {} --trim 0.4 --memory {}", method, memory)).status,
                0);
            const Plane red = channel_of(path("map.exr"), "R");
            for (std::size_t i = 0; i < kPixels; ++i)
                ASSERT_NEAR(red[i], light(i, 0), 100.0 * kFloat) << method << memory;
        }
    }
}

// One pattern under three exposures: with each divided by its mean they are one image.
TEST_F(CommandObserve, NormalisedImagesAreTheirPatternAlone) {
    write_survey();
    ASSERT_EQ(observe("--normalise").status, 0);
    const Plane error = channel_of(path("map.exr"), "stderr.G");
    for (const float e : error) ASSERT_NEAR(e, 0.0, kFloat);
    double sum = 0.0;
    for (const std::string& channel : kRgb) {
        for (const float sample : channel_of(path("map.exr"), channel)) sum += sample;
    }
    EXPECT_NEAR(sum / (3.0 * kPixels), 1.0, kFloat);
}

TEST_F(CommandObserve, SitesOfAMosaicHoldTheirOwnChannel) {
    fs::create_directories(path("raw"));
    Plane mosaic;
    for (std::size_t i = 0; i < kPixels; ++i)
        mosaic.push_back(5.0F + static_cast<float>(i % 2 + 2 * (i / kWidth_px % 2)));
    write_exr(path("raw/one.exr"), {"Y"}, mosaic);
    write_exr(path("raw/two.exr"), {"Y"}, mosaic);
    write_file(path("nav.csv"), "one 2.0 0 0\ntwo 2.05 0 0\n");
    ASSERT_EQ(observe("--bayer RGGB --black-level 5").status, 0);
    const Plane green = channel_of(path("map.exr"), "G");
    const Plane count = channel_of(path("map.exr"), "count.G");
    EXPECT_TRUE(std::isnan(green[0]));
    EXPECT_EQ(count[0], 0.0F);
    EXPECT_EQ(green[1], 1.0F);
    EXPECT_EQ(green[kWidth_px], 2.0F);
    EXPECT_EQ(count[1], 2.0F);
    ASSERT_EQ(observe("--bayer RGGB --demosaic").status, 0);
    EXPECT_FALSE(std::isnan(channel_of(path("map.exr"), "G")[0]));
    EXPECT_EQ(channel_of(path("map.exr"), "count.G")[0], 0.0F) << "filled in, not observed";
    EXPECT_EQ(observe({}).status, 2) << "one channel, and no mosaic named";
}

// Among them headers that ask for gigabytes: each costs itself alone, and no time.
TEST_F(Survey, BadImagesAreSaidSkippedAndCostNoOther) {
    write_survey();
    write_image("stray", 1.0F);
    ASSERT_EQ(observe("--allow-skipped 1").status, 0);
    fs::rename(path("map.exr"), path("light.exr"));
    std::map<std::string, std::string> bad = absurd_images(kWidth_px, kHeight_px);
    bad["broken.png"] = "no picture";
    std::string lines = text_of("nav.csv") + "small.exr,2,0,0\n";
    for (const auto& [name, bytes] : bad) {
        write_file(path("raw/" + name), bytes);
        lines += name + ",2,0,0\n";
    }
    write_exr(path("raw/small.exr"), kRgb, Plane(3 * 16, 1.0F), 4);
    write_file(path("nav.csv"), lines);
    struct Case {
        Arguments command;
        std::string count;
        int good;
    };
    for (auto& [command, count, good] : std::vector<Case>{
             {"observe raw --altitude 2 -o map.exr --nav nav.csv", "images", 3},
             {"observe raw --altitude 2 -o map.exr --nav nav.csv --method median", "images", 3},
             {"baseline homomorphic raw -o out", "corrected", 5},
             {"baseline log-polynomial raw -o out", "corrected", 5},
             {"correct raw --map light.exr -o done", "corrected", 5}}) {
        command += "--json";
        const CommandResult result = aphotic(command);
        const std::string about = testing::PrintToString(command) + result.err;
        EXPECT_EQ(result.status, 1) << about;
        const nlohmann::json json = nlohmann::json::parse(result.out);
        EXPECT_EQ(json[count], good) << about;
        EXPECT_EQ(json["skipped"].size(), bad.size() + 1 + (good == 3 ? 1 : 0)) << about;
        for (const nlohmann::json& one : json["skipped"]) {
            const std::string why = one["why"];
            EXPECT_TRUE(has(result.err, one["image"].get<std::string>() + ": " + why + "; skipped"))
                << about;
            for (const char* words : {"alloc", "memory", "vector"}) EXPECT_FALSE(has(why, words));
        }
        EXPECT_FALSE(has(result.err, "libpng")) << about;
        if (good == 3) {
            EXPECT_EQ(channel_of(path("map.exr"), "count.R")[0], 3.0F);
        } else {
            EXPECT_TRUE(
                fs::exists(path(command[0] == "correct" ? "done/high.tif" : "out/high.exr")));
        }
    }
}

// A mosaic whose green sites are the other two, and a sensor that is saturated at 1000.
TEST_F(CommandObserve, WhatLooksWrongIsToldAndByStrictAnEnd) {
    fs::create_directories(path("raw"));
    std::vector<std::uint16_t> mosaic;
    for (int i = 0; i < static_cast<int>(kPixels); ++i) {
        const int channel = channel_at(Mosaic::Rggb, i % kWidth_px, i / kWidth_px);
        const int number = 300 + 200 * channel + i;
        mosaic.push_back(static_cast<std::uint16_t>(std::min(number, 700)));
    }
    write_file(path("raw/a.tif"), tiff_of(mosaic, kWidth_px, kHeight_px, ""));
    write_file(path("nav.csv"), "image,altitude_m\na,2\n");
    for (const std::string command : {"observe", "baseline"}) {
        const auto told = [&](const std::string& pattern, bool is_strict) {
            const std::string own = command == "observe"
                                        ? "observe raw --nav nav.csv -o map.exr --altitude 2"
                                        : "baseline homomorphic raw -o out";
            return aphotic(own + " --json --bayer " + pattern + (is_strict ? " --strict" : ""));
        };
        const CommandResult strict = told("GBRG", true);
        EXPECT_EQ(strict.status, 2) << strict.out;
        EXPECT_FALSE(fs::exists(path("map.exr")) || fs::exists(path("out"))) << command;
        const CommandResult wrong = told("GBRG", false);
        EXPECT_EQ(wrong.status, 0) << wrong.err;
        const nlohmann::json json = nlohmann::json::parse(wrong.out)["looks_wrong"];
        ASSERT_EQ(json.size(), 2U) << json.dump();
        EXPECT_EQ(json[0]["about"], "white-level");
        EXPECT_EQ(json[1]["about"], "bayer");
        EXPECT_TRUE(
            has(wrong.err, "aphotic: looks wrong: bayer: the two sites that GBRG makes green"));
        const CommandResult right = told("RGGB", false);
        EXPECT_EQ(nlohmann::json::parse(right.out)["looks_wrong"].size(), 1U) << right.err;
        fs::remove(path("map.exr"));
        fs::remove_all(path("out"));
    }
}

TEST_F(CommandObserve, WritesNoMapOfNoImage) {
    write_survey();
    const CommandResult result = aphotic("observe raw --nav nav.csv -o map.exr --altitude 2.8");
    EXPECT_EQ(result.status, 2);
    EXPECT_TRUE(has(result.err, "the nearest is 0.7 m off"));
    EXPECT_FALSE(fs::exists(path("map.exr")));
    fs::remove_all(path("raw"));
    fs::create_directories(path("raw"));
    write_file(path("raw/a.tif"), tiff_of({1, 2, 3, 4}, 2, 2, ""));
    const CommandResult mosaic = observe({});
    EXPECT_EQ(mosaic.status, 2);
    EXPECT_TRUE(
        has(mosaic.err,
            "the only image looked at cannot be read; a: found one channel and no --bayer"));
}

TEST_F(CommandBaseline, TakesANavigation) {
    write_survey();
    const CommandResult result =
        aphotic("baseline binned-polynomial raw -o out --nav nav.csv --json");
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_EQ(nlohmann::json::parse(result.out)["corrected"], 4);
}

TEST_F(CommandBaseline, RefusesWhatItCannotDo) {
    write_survey();
    EXPECT_EQ(aphotic("baseline magic raw -o out").status, 2);
    for (const char* name : {"binned-polynomial", "altitude-exponential"}) {
        const CommandResult blind = aphotic(fmt::format("baseline {} raw -o out", name));
        EXPECT_EQ(blind.status, 2);
        EXPECT_TRUE(has(blind.err, "--nav"));
    }
    EXPECT_EQ(aphotic("baseline homomorphic nowhere -o out").status, 2);
    EXPECT_FALSE(fs::exists(path("out")));
}

TEST_F(CommandBaseline, EveryOptionCountsAndIsNoted) {
    write_survey();
    nlohmann::json wanted{{"sigma", 0.2},
                          {"low", 0.1},
                          {"high", 2.0},
                          {"tiles", 2},
                          {"clip", 4.0},
                          {"order", 3},
                          {"bin_m", 0.5},
                          {"black_level", 0.25}};
    Arguments arguments("baseline homomorphic raw -o out --bin 0.5 --black-level 0.25 --json");
    for (const char* name : {"sigma", "low", "high", "tiles", "clip", "order"}) {
        arguments.push_back("--" + std::string(name));
        arguments.push_back(wanted[name].dump());
    }
    const CommandResult result = aphotic(arguments);
    ASSERT_EQ(result.status, 0) << result.err;
    const nlohmann::json notes = nlohmann::json::parse(text_of("out/baseline.json"));
    EXPECT_EQ(notes, nlohmann::json::parse(result.out));
    for (const auto& [key, value] : wanted.items()) EXPECT_EQ(notes["settings"][key], value) << key;
}

TEST_F(CommandBaseline, WritesTheFormatsOfCorrectAndGoesOnWhereItStopped) {
    fs::create_directories(path("raw"));
    std::vector<std::uint16_t> mosaic(kPixels, 2000);
    mosaic[kPixels / 2] = 4095;
    for (const char* name : {"raw/a.tif", "raw/b.tif"}) {
        write_file(path(name), tiff_of(mosaic, kWidth_px, kHeight_px, "lat=41.5"));
    }
    const auto baseline = [&](const std::string& format) {
        const CommandResult result =
            aphotic(fmt::format("baseline homomorphic raw -o out --bayer RGGB --white-level 4095 "
                                "--format {} --mask --compression none --json",
                                format));
        EXPECT_EQ(result.status, 0) << result.err;
        return nlohmann::json::parse(result.out);
    };
    EXPECT_EQ(baseline("tiff")["corrected"], 2);
    EXPECT_GE(fs::file_size(path("out/a.tif")), 3 * 2 * kPixels) << "not compressed";
    EXPECT_TRUE(has(text_of("out/a.tif"), "lat=41.5"));
    EXPECT_TRUE(fs::exists(path("out/a.mask.png")));
    fs::remove(path("out/b.mask.png"));
    const nlohmann::json again = baseline("tiff");
    EXPECT_EQ(again["kept"], 1);
    EXPECT_EQ(again["corrected"], 1);
    EXPECT_GT(again["doubtful"]["saturated"], 0.0);
    EXPECT_EQ(baseline("exr")["corrected"], 2);
}

}  // namespace
}  // namespace aphotic::observe_test
