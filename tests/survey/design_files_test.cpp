// SPDX-License-Identifier: BSD-3-Clause
#include "survey/design_files.h"

#include "base/atomic_file.h"
#include "rig/rig_reader.h"
#include "support/design_rig.h"
#include "support/page.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace aphotic::design_files_test {
namespace {

namespace fs = std::filesystem;

RigText rig_with_a_table(const fs::path& folder) {
    std::string text = design_rig_text(two_strobes("direction = [0, 0, 1]  # <b> & \"c\""), 3.0);
    text.replace(text.find("[seafloor]"), 10, "[seafloor]\nreflectance = \"mud/mud.csv\"");
    fs::create_directories(folder / "mud");
    write_file(folder / "mud" / "mud.csv", "wavelength_nm,reflectance\n300,0.1\n800,0.2\n");
    write_file(folder / "rig.toml", text);
    return RigText(folder / "rig.toml");
}

DesignRequest request_for(const Rig& rig) {
    DesignRequest request{.freedom = {.keys = {"strobe.*.position_m"}},
                          .envelope = envelope_of(rig.sled),
                          .evaluations = 150};
    request.envelope.altitude_m = {1.8, 2.2};
    return request;
}

class DesignFiles : public testing::Test {
  protected:
    void SetUp() override {
        fs::create_directories(out_);
        write_design(text_, request_, result_, out_);
    }

    TempFolder folder_;
    fs::path in_ = folder_.path() / "in";
    fs::path out_ = folder_.path() / "out";
    RigText text_ = rig_with_a_table(in_);
    Rig rig_ = text_.rig();
    DesignRequest request_ = request_for(rig_);
    DesignResult result_ = design(text_, request_);
};

TEST_F(DesignFiles, LeaveARigThatFindsItsTables) {
    ASSERT_TRUE(result_.is_better);
    const Rig left = read_rig(out_ / kDesignedRig);
    EXPECT_EQ(left.seafloor.reflectance.at(550.0), rig_.seafloor.reflectance.at(550.0));
    for (std::size_t s = 0; s < left.strobes.size(); ++s)
        EXPECT_EQ(left.strobes[s].position_m, result_.best.places[s].position_m);
    EXPECT_TRUE(contains(left.toml, "# where fore is"));
}

TEST_F(DesignFiles, LeaveThePageAndTheNumbers) {
    const std::string page = read_text_file(out_ / kDesignPage);
    EXPECT_EQ(first_unbalanced(page), "");
    for (const char* words : {"Evenness ", "Light on the floor", "The trade", "Over the envelope"})
        EXPECT_TRUE(contains(words_of(page), words)) << words;
    EXPECT_FALSE(contains(page, "<b>"));
    const auto json = nlohmann::json::parse(read_text_file(out_ / kDesignNumbers));
    EXPECT_EQ(json.at("design").at("worst").at("evenness").get<double>(),
              result_.best.figures.evenness);
    EXPECT_EQ(json.at("design").at("poses").size(), 3U);
    EXPECT_EQ(json.at("front").size(), result_.front.size());
}

// The folder of the rig itself will do: its tables are not copied onto themselves.
TEST_F(DesignFiles, MayStandBesideTheRig) {
    write_design(text_, request_, result_, in_);
    EXPECT_EQ(read_rig(in_ / kDesignedRig).strobes.size(), 2U);
    EXPECT_EQ(read_rig(in_ / "rig.toml").digest, rig_.digest);
}

}  // namespace
}  // namespace aphotic::design_files_test
