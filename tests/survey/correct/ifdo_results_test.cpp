// SPDX-License-Identifier: BSD-3-Clause
#include "survey/correct/ifdo_results.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/sha256.h"
#include "support/has.h"
#include "support/raw_survey.h"
#include "support/refusal.h"

#include <gtest/gtest.h>

#include <regex>

namespace aphotic::ifdo_results_test {
namespace {

using Json = nlohmann::json;

// The pattern of uuid in the schema of version 2.2.1, with hyphens.
const std::regex kUuid(
    "[0-9a-fA-F]{8}-[0-9a-fA-F]{4}-[4][0-9a-fA-F]{3}-[89abAB][0-9a-fA-F]{3}-[0-9a-fA-F]{12}");
constexpr const char* kOldUuid = "f840644a-fe4a-46a7-9791-e32c211bcbf5";

// Results of a and b; c was skipped, and high has no item.
class IfdoResultsOf : public testing::Test {
  protected:
    IfdoResultsOf() {
        std::filesystem::create_directories(raw_.path("out"));
        for (const char* name : {"a", "b", "high"})
            write_text_file(raw_.path(std::string("out/") + name + ".tif"), name);
        options_.run.folder = raw_.path("out");
        report_.gain.gain = {1.5, 2.5, 3.5};
        report_.gain.images = {"a", "b"};
        report_.run = RunOutcome{};
        report_.run->skipped.push_back({raw_.path("raw/c.exr").string(), "too dark"});
    }

    Json write(bool is_yaml = false) {
        Survey survey = raw_.survey();
        survey.light.digest = "5eed";
        const Ifdo ifdo{.source = "set", .is_yaml = is_yaml, .set = set_};
        made_ = write_ifdo_of_results(
            ifdo, raw_.path("out/set.json"), survey, options_, report_, nullptr);
        const Ifdo back = parse_ifdo("back", read_text_file(made_.file));
        EXPECT_EQ(back.is_yaml, is_yaml);
        return back.set;
    }

    RawSurvey raw_;
    CorrectionOptions options_;
    CorrectionReport report_;
    IfdoResults made_;
    Json set_{{"image-set-header",
               {{"image-set-name", "SO268"},
                {"image-set-uuid", kOldUuid},
                {"image-altitude-meters", -4129.5},
                {"image-quality", "raw"},
                {"image-photometric-calibration",
                 {{"photometric-illumination-factor-RGB", {1, 1, 1}},
                  {"photometric-exposure-factor-RGB", {9, 9, 9}}}}}},
              {"image-set-items",
               {{"a.exr",
                 {{"image-uuid", kOldUuid},
                  {"image-hash-sha256", "old"},
                  {"image-handle", "https://hdl.handle.net/1"},
                  {"image-entropy", 0.5},
                  {"image-average-color", {1, 2, 3}},
                  {"image-mpeg7-colorlayout", {1.0}},
                  {"image-meters-above-ground", 2.0}}},
                {"b.exr", Json::array({{{"image-quality", "raw"}}})},
                {"c.exr", {{"image-uuid", kOldUuid}}},
                {"never-given.exr", {{"image-uuid", kOldUuid}}}}}};
};

TEST_F(IfdoResultsOf, AreItsImagesWithOtherPixels) {
    for (const bool is_yaml : {false, true}) {
        const Json set = write(is_yaml);
        EXPECT_EQ(made_.images, 2U);
        ASSERT_EQ(made_.without_item.size(), 1U);
        EXPECT_EQ(made_.without_item[0], raw_.path("raw/high.exr").string());
        const Json& header = set["image-set-header"];
        EXPECT_EQ(header["image-set-name"], "SO268");
        EXPECT_EQ(header["image-altitude-meters"], -4129.5);
        EXPECT_EQ(header["image-quality"], "processed");
        EXPECT_EQ(header["image-illumination"], "artificial light");
        EXPECT_EQ(header["image-set-local-path"], ".");
        EXPECT_TRUE(std::regex_match(header["image-set-uuid"].get<std::string>(), kUuid));
        EXPECT_NE(header["image-set-uuid"], kOldUuid);
        const Json& calibration = header["image-photometric-calibration"];
        EXPECT_EQ(calibration["photometric-exposure-factor-RGB"], (Json{1.5, 2.5, 3.5}));
        EXPECT_EQ(calibration["photometric-illumination-factor-RGB"], (Json{1, 1, 1}));
        EXPECT_EQ(calibration["photometric-sequence-illumination-type"], "constant artificial");
        EXPECT_TRUE(
            has(calibration["photometric-sequence-illumination-description"].get<std::string>(),
                "5eed"));

        ASSERT_EQ(set["image-set-items"].size(), 2U);
        const Json& a = set["image-set-items"]["a.tif"];
        EXPECT_EQ(a["image-hash-sha256"], sha256_of_text("a"));
        EXPECT_TRUE(std::regex_match(a["image-uuid"].get<std::string>(), kUuid));
        EXPECT_NE(a["image-uuid"], kOldUuid);
        EXPECT_EQ(a["image-handle"], "https://hdl.handle.net/1");
        EXPECT_EQ(a["image-meters-above-ground"], 2.0);
        for (const char* gone :
             {"image-entropy", "image-average-color", "image-mpeg7-colorlayout", "image-quality"})
            EXPECT_FALSE(a.contains(gone)) << gone;
        const Json& b = set["image-set-items"]["b.tif"];
        ASSERT_TRUE(b.is_array());
        EXPECT_EQ(b[0]["image-quality"], "processed") << "its own, which was raw";
        EXPECT_NE(b[0]["image-uuid"], a["image-uuid"]);
    }
}

TEST_F(IfdoResultsOf, TheSameResultsHaveTheSameUuids) {
    const Json before = write();
    EXPECT_EQ(write(), before);
    write_text_file(raw_.path("out/a.tif"), "another");
    const Json after = write();
    EXPECT_NE(after["image-set-header"]["image-set-uuid"],
              before["image-set-header"]["image-set-uuid"]);
    EXPECT_NE(after["image-set-items"]["a.tif"]["image-uuid"],
              before["image-set-items"]["a.tif"]["image-uuid"]);
    EXPECT_EQ(after["image-set-items"]["b.tif"], before["image-set-items"]["b.tif"]);
}

TEST(IfdoUuid, IsASha256OfVersion4) {
    // SHA-256 of "abc", FIPS 180-4: ba7816bf 8f01cfea 414140de 5dae2223.
    EXPECT_EQ(uuid_of("abc"), "ba7816bf-8f01-4fea-8141-40de5dae2223");
    for (const char* text : {"", "a", "b", "c", "d", "e", "f"})
        EXPECT_TRUE(std::regex_match(uuid_of(text), kUuid)) << uuid_of(text);
}

TEST_F(IfdoResultsOf, OfAnotherSurveyAreRefused) {
    set_["image-set-items"] = {{"never-given.exr", {{"image-uuid", kOldUuid}}}};
    EXPECT_EQ(refusal_of([&] { (void)write(); }),
              "set: has no item for any of the 3 images that were corrected");
    EXPECT_FALSE(std::filesystem::exists(raw_.path("out/set.json")));
}

TEST_F(IfdoResultsOf, NeverTakeTheSourcesPlace) {
    write_text_file(raw_.path("out/set.json"), "{}");
    EXPECT_THROW((void)ifdo_place(raw_.path("out/set.json"), raw_.path("out")), InputError);
    EXPECT_THROW((void)ifdo_place("elsewhere/correction.json", raw_.path("out")), InputError);
    EXPECT_EQ(ifdo_place("elsewhere/set.json", raw_.path("out")), raw_.path("out/set.json"));
}

}  // namespace
}  // namespace aphotic::ifdo_results_test
