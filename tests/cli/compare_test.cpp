// SPDX-License-Identifier: BSD-3-Clause
//
// aphotic compare with --scale and --report, as a user runs it.
#include "support/command_test.h"
#include "support/exr_file.h"
#include "support/has.h"
#include "support/page.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <limits>

namespace aphotic::compare_test {
namespace {

constexpr int kWidth_px = 24;
constexpr int kHeight_px = 16;
constexpr std::size_t kPixels = kWidth_px * kHeight_px;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr double kFloat = 1e-6;  // roundings of samples as floats, relative

using Plane = std::vector<float>;
const std::vector<std::string> kRgb{"R", "G", "B"};

class CommandCompare : public CommandTest {
  protected:
    void write(const std::string& name,
               const std::vector<Plane>& planes,
               const std::vector<std::string>& channels = kRgb) {
        Plane samples;
        for (const Plane& plane : planes) samples.insert(samples.end(), plane.begin(), plane.end());
        write_exr(path(name), kWidth_px, samples, channels);
    }

    static Arguments compare(const Arguments& options) { return "compare a.exr b.exr" + options; }

    nlohmann::json json_of(const Arguments& options, int status) {
        return json_by(compare(options + "--json"), status);
    }
};

// Brightest in the middle, as a lamp's light.
Plane pattern(double level) {
    Plane plane;
    for (std::size_t i = 0; i < kPixels; ++i) {
        const double x = static_cast<double>(i % kWidth_px) / kWidth_px - 0.5;
        const double y = static_cast<double>(i / kWidth_px) / kHeight_px - 0.5;
        plane.push_back(static_cast<float>(level * std::exp(-3.0 * (x * x + y * y))));
    }
    return plane;
}

std::vector<Plane> times(std::vector<Plane> planes, std::array<double, 3> factors) {
    for (std::size_t c = 0; c < planes.size(); ++c) {
        for (float& sample : planes[c]) sample = static_cast<float>(sample * factors.at(c));
    }
    return planes;
}

const std::vector<Plane> kReference{pattern(1.0), pattern(2.0), pattern(0.5)};

TEST_F(CommandCompare, ScaleTakesTheExposureAway) {
    write("a.exr", times(kReference, {640.0, 640.0, 640.0}));
    write("b.exr", kReference);
    EXPECT_EQ(aphotic(compare({})).status, kAnswerIsNo) << "no factor is fitted unasked";
    const nlohmann::json json = json_of("--scale", 0);
    EXPECT_EQ(json["scaled"], "image");
    for (const auto& channel : json["channels"])
        EXPECT_NEAR(channel["scale"].get<double>(), 640.0, 640.0 * kFloat);
}

TEST_F(CommandCompare, ScalePerChannelTakesTheColourAwayToo) {
    write("a.exr", times(kReference, {2.0, 3.0, 5.0}));
    write("b.exr", kReference);
    const nlohmann::json one = json_of("--scale", 1);
    // Least squares of planes that are 1, 2 and 0.5 times the same.
    const double wanted = (2.0 * 1.0 + 3.0 * 4.0 + 5.0 * 0.25) / (1.0 + 4.0 + 0.25);
    const nlohmann::json each = json_of("--scale=per-channel", 0);
    for (const auto& channel : one["channels"])
        EXPECT_NEAR(channel["scale"].get<double>(), wanted, wanted * kFloat);
    for (const auto& channel : each["channels"]) {
        const double own = channel["name"] == "R" ? 2.0 : channel["name"] == "G" ? 3.0 : 5.0;
        EXPECT_NEAR(channel["scale"].get<double>(), own, own * kFloat) << channel["name"];
    }
    EXPECT_TRUE(has(aphotic(compare("--scale=per-channel")).out, "/ 5"));
}

// A bent pattern is no factor away.
TEST_F(CommandCompare, ScaleHidesNoOtherDifference) {
    std::vector<Plane> bent = times(kReference, {7.0, 7.0, 7.0});
    for (Plane& plane : bent) {
        for (std::size_t i = 0; i < kPixels / 2; ++i) plane[i] *= 1.01F;
    }
    write("a.exr", bent);
    write("b.exr", kReference);
    EXPECT_EQ(aphotic(compare("--scale --bound 0.004")).status, 1);
    done(compare("--scale --bound 0.011"));
}

TEST_F(CommandCompare, WhatWasNotObservedIsToldAndNotCompared) {
    std::vector<Plane> observed = kReference;
    Plane counts(kPixels, 9.0F);
    for (std::size_t i = 0; i < kPixels; i += 2) {
        observed[0][i] = kNaN;
        counts[i] = 0.0F;
    }
    write("b.exr", kReference);
    write("a.exr", observed);
    EXPECT_EQ(aphotic(compare({})).status, kAnswerIsNo) << "nothing says that it was not observed";

    observed.push_back(counts);
    const std::vector<std::string> channels{"R", "G", "B", "count.R"};
    write("a.exr", observed, channels);
    const nlohmann::json json = json_of("--scale", 0);
    for (const auto& channel : json["channels"]) {
        const std::size_t unobserved = channel["name"] == "R" ? kPixels / 2 : 0;
        EXPECT_EQ(channel["unobserved"], unobserved);
        EXPECT_EQ(channel["compared"], kPixels - unobserved);
    }

    observed[0][1] = kNaN;  // where it is said to have been seen nine times
    write("a.exr", observed, channels);
    EXPECT_EQ(aphotic(compare("--scale")).status, 1);
}

TEST_F(CommandCompare, RefusesAScaleThatIsNone) {
    write("a.exr", times(kReference, {-1.0, -1.0, -1.0}));
    write("b.exr", kReference);
    refused(compare("--scale"), "positive");
    EXPECT_EQ(aphotic(compare("--scale=twice")).status, 2);
}

// Two images of three wavelengths each, of which one is in both.
TEST_F(CommandCompare, SaysNoToChannelsWithoutAPartner) {
    const std::string shared = "S0.550,000000nm";
    write("a.exr", kReference, {"S0.470,000000nm", shared, "S0.620,000000nm"});
    write("b.exr",
          {kReference[2], kReference[1], kReference[0]},
          {"S0.450,000000nm", shared, "S0.650,000000nm"});
    const CommandResult result = done(compare("--report page.html"), "", kAnswerIsNo);
    for (const char* part : {"only in a.exr: S0.470,000000nm S0.620,000000nm\n",
                             "only in b.exr: S0.450,000000nm S0.650,000000nm\n",
                             "a.exr is within 0.0006 of b.exr\n",
                             "but 4 channels WITHOUT a partner"})
        EXPECT_TRUE(has(result.out, part));
    EXPECT_TRUE(has(text_of("page.html"), "S0.470,000000nm"));

    const nlohmann::json json = json_of({}, 1);
    EXPECT_FALSE(json["holds"].get<bool>());
    EXPECT_EQ(json["only_in_image"], nlohmann::json({"S0.470,000000nm", "S0.620,000000nm"}));
    EXPECT_EQ(json["only_in_reference"], nlohmann::json({"S0.450,000000nm", "S0.650,000000nm"}));
    ASSERT_EQ(json["channels"].size(), 1U);
    EXPECT_TRUE(json["channels"][0]["holds"].get<bool>());
}

TEST_F(CommandCompare, ComparesTheChannelsThatAreNamed) {
    const std::string shared = "S0.550,000000nm";
    write("a.exr", {kReference[0], kReference[1], kReference[2]}, {"R", shared, "S0.470,000000nm"});
    write("b.exr", {kReference[0], kReference[1]}, {"R", shared});
    EXPECT_EQ(aphotic(compare({})).status, kAnswerIsNo);
    const nlohmann::json json = json_of(fmt::format("--channels R,{}", shared), 0);
    ASSERT_EQ(json["channels"].size(), 2U);
    EXPECT_EQ(json["channels"][1]["name"], shared) << "a name that holds a comma";
    EXPECT_EQ(json["only_in_image"].size(), 0U);
    EXPECT_EQ(json_of("--channels R", 0)["channels"].size(), 1U);
    for (const char* names : {"S0.470,000000nm", "R,X", "", ","})
        refused(compare({"--channels", names}), "--channels: ");
    refused(compare("--channels R,X"),
            "--channels: found X; allowed: those of both images, R, " + shared);
}

// As the reference writer of the layout, pbrt and others spell them, in the order of their names.
TEST_F(CommandCompare, PairsSpectralChannelsByWavelength) {
    const std::vector<std::string> ours{"S0.1000,000000nm", "S0.374,687500nm", "S0.440,000000nm"};
    const std::vector<std::string> theirs{"S0.374,688nm", "S0.440,0nm", "S0.1um"};
    write("a.exr", kReference, ours);
    write("b.exr", {kReference[1], kReference[2], kReference[0]}, theirs);
    const nlohmann::json json = json_of({}, 0);
    EXPECT_EQ(json["channels"].size(), ours.size());
    EXPECT_EQ(json["only_in_image"].size() + json["only_in_reference"].size(), 0U);
    for (const std::string& name : {ours[2], theirs[1], std::string("S0.440nm")}) {
        const nlohmann::json named = json_of(fmt::format("--channels {}", name), 0);
        ASSERT_EQ(named["channels"].size(), 1U) << name;
        EXPECT_EQ(named["channels"][0]["name"], ours[2]);
    }
    // Each has one partner at most.
    write("b.exr", kReference, {"S0.440nm", "S0.440,0nm", "S0.440,00nm"});
    EXPECT_EQ(json_of({}, 1)["only_in_reference"].size(), 2U);
}

// A picture with opacity against one without.
TEST_F(CommandCompare, LeavesOpacityAsideWithAWord) {
    std::vector<Plane> with_opacity = kReference;
    with_opacity.emplace_back(kPixels, 1.0F);
    write("a.exr", with_opacity, {"R", "G", "B", "A"});
    write("b.exr", kReference);
    done(compare({}), "not compared: A\n");
    EXPECT_EQ(json_of({}, 0)["left_aside"], nlohmann::json({"A"}));
    // In both it is a channel like any other.
    with_opacity.back().front() = 0.5F;
    write("b.exr", with_opacity, {"R", "G", "B", "A"});
    EXPECT_EQ(aphotic(compare({})).status, kAnswerIsNo);
}

// One statistic, one name: that of validation.json.
TEST_F(CommandCompare, NamesItsStatisticsAsAValidationDoes) {
    write("a.exr", kReference);
    write("b.exr", kReference);
    const nlohmann::json channel = json_of({}, 0)["channels"][0];
    for (const char* key : {"max_error", "percentile_999", "rms_error", "mean_error", "compared"})
        EXPECT_TRUE(channel.contains(key)) << key;
}

// Light falls off in the pattern, alike in all channels: grey, and uneven over the patches.
TEST_F(CommandCompare, MeasuresPatchesWithOrWithoutAReference) {
    write("a.exr", times(kReference, {1.0, 1.0, 1.0}));
    write_file(path("p.csv"),
               "patch,x,y,w,h,reference\nmiddle,11,7,2,2,0.5\ncorner,0,0,2,2,0.5\nskin,4,4,1,1,\n");
    const nlohmann::json patches = json_by("compare a.exr --patches p.csv --json")["patches"];
    ASSERT_EQ(patches["patches"].size(), 3U);
    EXPECT_TRUE(patches["patches"][0].contains("degrees_from_grey"));
    EXPECT_TRUE(patches["patches"][0].contains("ciede2000"));
    EXPECT_FALSE(patches["patches"][2].contains("degrees_from_grey"));
    EXPECT_GT(patches["unevenness"], 0.01);
    write("b.exr", kReference);
    const nlohmann::json both = json_of("--patches p.csv", 0);
    EXPECT_EQ(both["patches"], patches);
    EXPECT_TRUE(both.contains("channels"));
    done("compare a.exr --patches p.csv", "degrees from grey: mean ");
}

TEST_F(CommandCompare, NeedsAReferenceOrPatches) {
    write("a.exr", kReference);
    write_file(path("p.csv"), "patch,x,y,w,h\na,20,0,9,9\n");
    for (const auto& [options, why] :
         Cases{{{}, "found no REFERENCE; allowed: an image to judge IMAGE by, or --patches"},
               {"--encoding srgb", "--encoding requires --patches"},
               {"--patches none.csv", "none.csv: cannot be read"},
               {"--patches p.csv",
                "p.csv:2: found a patch up to 29, 9; allowed: the image's 24 x 16 pixels"},
               {"--patches p.csv --report r.html", "--report: found no REFERENCE"}})
        refused("compare a.exr" + options, why);
}

TEST_F(CommandCompare, LeavesAPageOfBoth) {
    std::vector<Plane> observed = times(kReference, {3.0, 3.0, 3.0});
    observed[1][5] = kNaN;
    observed.emplace_back(kPixels, 4.0F);
    observed.back()[5] = 0.0F;
    write("a.exr", observed, {"R", "G", "B", "count.G"});
    write("b.exr", kReference);
    done(compare("--scale --report page.html"));
    const std::string page = text_of("page.html");
    EXPECT_EQ(first_unbalanced(page), "");
    EXPECT_TRUE(has(words_of(page), "a.exr\u2069 is within"));
    for (const char* part : {"id=\"row-R\"", "id=\"column-B\"", "data:image/png;base64,"})
        EXPECT_TRUE(has(page, part)) << part;
}

}  // namespace
}  // namespace aphotic::compare_test
