// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic observe and aphotic baseline on small surveys, as a user runs them.
#include "support/absurd_images.h"
#include "support/command_test.h"
#include "support/exr_file.h"
#include "support/has.h"
#include "support/scene_text.h"
#include "support/tiff.h"
#include "survey/images/raw_image.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
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

// Light that falls off to the right, a little more in blue.
float light(std::size_t pixel, std::size_t channel) {
    const double x = (static_cast<double>(pixel % kWidth_px) + 0.5) / kWidth_px;
    return static_cast<float>(100.0 * (1.0 - (0.4 + 0.1 * static_cast<double>(channel)) * x));
}

class Survey : public CommandTest {
  protected:
    [[nodiscard]] Plane channel(const std::string& name) const {
        return read_exr(path("map.exr"), {name});
    }

    // The light times a factor of the image.
    void write_image(const std::string& name, float factor) {
        Plane samples;
        for (std::size_t c = 0; c < kRgb.size(); ++c) {
            for (std::size_t i = 0; i < kPixels; ++i) samples.push_back(factor * light(i, c));
        }
        fs::create_directories(path("raw"));
        write_exr(path("raw/" + name + ".exr"), kWidth_px, samples);
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
    static Arguments observe(const Arguments& options) {
        Arguments arguments("observe raw --nav nav.csv -o map.exr");
        if (std::ranges::find(options, "--altitude") == options.end()) arguments += "--altitude 2";
        return arguments + options;
    }
};
using CommandObserve = Survey;
using CommandBaseline = Survey;

TEST_F(CommandObserve, AnAttitudeThatNobodyToldIsUnknown) {
    write_survey();
    write_file(path("nav.csv"),
               "image,altitude_m,roll_deg\na.exr,2,3\nb.exr,2,1\nc.exr,2,2\nhigh.exr,3,0\n");
    done(observe({}), "pitch unknown, roll 2.00 deg");
    EXPECT_TRUE(json_by(observe("--json"))["pitch_deg"].is_null());
}

// What these make of poses is NavigationFile's concern.
TEST_F(CommandObserve, TakesWhatAltitudesAreAndTheMountingFromARig) {
    write_survey();
    const std::string rig =
        replaced(scene_text("habcam.toml"), "[sled]\n", "[sled]\naltitude_is = \"plumb\"\n");
    write_file(path("mounted.toml"),
               replaced(rig,
                        "[camera]\n",
                        "[camera]\nposition_m = [0, 0, 1]\norientation_deg = [0, -30, 0]\n"));
    const auto navigation = json_by(observe("--rig mounted.toml --within 9 --json"))["navigation"];
    EXPECT_EQ(navigation["altitude_is"], "plumb");
    EXPECT_EQ(navigation["orientation_deg"].size(), 3U);
}

TEST_F(CommandObserve, MedianAndTrimmedMeanOfBandsAreThoseOfTheWhole) {
    write_survey();
    for (const std::string method : {"median", "trimmed"}) {
        // A few hundred bytes: bands of 83 samples, which end within rows and channels.
        for (const std::string memory : {"1000", "0.001"}) {
            done(observe(fmt::format("--method {} --trim 0.4 --memory {}", method, memory)));
            const Plane red = channel("R");
            for (std::size_t i = 0; i < kPixels; ++i)
                ASSERT_NEAR(red[i], light(i, 0), 100.0 * kFloat) << method << memory;
        }
    }
}

// One pattern under three exposures: with each divided by its mean they are one image.
TEST_F(CommandObserve, NormalisedImagesAreTheirPatternAlone) {
    write_survey();
    done(observe("--normalise"));
    const Plane error = channel("stderr.G");
    for (const float e : error) ASSERT_NEAR(e, 0.0, kFloat);
    double sum = 0.0;
    for (const std::string& name : kRgb) {
        for (const float sample : channel(name)) sum += sample;
    }
    EXPECT_NEAR(sum / (3.0 * kPixels), 1.0, kFloat);
}

TEST_F(CommandObserve, SitesOfAMosaicHoldTheirOwnChannel) {
    fs::create_directories(path("raw"));
    Plane mosaic;
    for (std::size_t i = 0; i < kPixels; ++i)
        mosaic.push_back(5.0F + static_cast<float>(i % 2 + 2 * (i / kWidth_px % 2)));
    write_exr(path("raw/one.exr"), kWidth_px, mosaic, {"Y"});
    write_exr(path("raw/two.exr"), kWidth_px, mosaic, {"Y"});
    write_file(path("nav.csv"), "one 2.0 0 0\ntwo 2.05 0 0\n");
    done(observe("--bayer RGGB --black-level 5"));
    const Plane green = channel("G");
    const Plane count = channel("count.G");
    EXPECT_TRUE(std::isnan(green[0]));
    EXPECT_EQ(count[0], 0.0F);
    EXPECT_EQ(green[1], 1.0F);
    EXPECT_EQ(green[kWidth_px], 2.0F);
    EXPECT_EQ(count[1], 2.0F);
    done(observe("--bayer RGGB --demosaic"));
    EXPECT_FALSE(std::isnan(channel("G")[0]));
    EXPECT_EQ(channel("count.G")[0], 0.0F) << "filled in, not observed";
    EXPECT_EQ(aphotic(observe({})).status, 2) << "one channel, and no mosaic named";
}

// Among them headers that ask for gigabytes: each costs itself alone, and no time.
TEST_F(Survey, BadImagesAreSaidSkippedAndCostNoOther) {
    write_survey();
    write_image("stray", 1.0F);
    done(observe("--allow-skipped 1"));
    fs::rename(path("map.exr"), path("light.exr"));
    std::map<std::string, std::string> bad = absurd_images(kWidth_px, kHeight_px);
    bad["broken.png"] = "no picture";
    std::string lines = text_of("nav.csv") + "small.exr,2,0,0\n";
    for (const auto& [name, bytes] : bad) {
        write_file(path("raw/" + name), bytes);
        lines += name + ",2,0,0\n";
    }
    write_exr(path("raw/small.exr"), 4, Plane(3 * 16, 1.0F));
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
        const CommandResult result = done(command, "", kAnswerIsNo);
        const std::string about = result.line + result.err;
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
            EXPECT_EQ(channel("count.R")[0], 3.0F);
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
            return Arguments(own + " --json --bayer " + pattern + (is_strict ? " --strict" : ""));
        };
        refused(told("GBRG", true), "bayer");
        const CommandResult wrong = done(told("GBRG", false));
        const nlohmann::json json = nlohmann::json::parse(wrong.out)["looks_wrong"];
        ASSERT_EQ(json.size(), 2U) << json.dump();
        EXPECT_EQ(json[0]["about"], "white-level");
        EXPECT_EQ(json[1]["about"], "bayer");
        EXPECT_TRUE(
            has(wrong.err, "aphotic: looks wrong: bayer: the two sites that GBRG makes green"));
        EXPECT_EQ(json_by(told("RGGB", false))["looks_wrong"].size(), 1U);
        fs::remove(path("map.exr"));
        fs::remove_all(path("out"));
    }
}

TEST_F(CommandObserve, WritesNoMapOfNoImage) {
    write_survey();
    refused("observe raw --nav nav.csv -o map.exr --altitude 2.8", "the nearest is 0.7 m off");
    fs::remove_all(path("raw"));
    fs::create_directories(path("raw"));
    write_file(path("raw/a.tif"), tiff_of({1, 2, 3, 4}, 2, 2, ""));
    refused(observe({}),
            "the only image examined cannot be read; a: found one channel and no --bayer");
}

TEST_F(CommandBaseline, TakesANavigation) {
    write_survey();
    EXPECT_EQ(json_by("baseline binned-polynomial raw -o out --nav nav.csv --json")["corrected"],
              4);
}

TEST_F(CommandBaseline, RefusesWhatItCannotDo) {
    write_survey();
    EXPECT_EQ(aphotic("baseline magic raw -o out").status, 2);
    for (const char* name : {"binned-polynomial", "altitude-exponential"}) {
        refused(fmt::format("baseline {} raw -o out", name), "--nav");
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
    const CommandResult result = done(arguments);
    const nlohmann::json notes = json_in("out/baseline.json");
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
        return json_by(
            fmt::format("baseline homomorphic raw -o out --bayer RGGB --white-level 4095 "
                        "--format {} --mask --compression none --json",
                        format));
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
