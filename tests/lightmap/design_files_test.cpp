// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/design_files.h"

#include "base/atomic_file.h"
#include "rig/file/rig_reader.h"
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

struct Designed {
    Designed() {
        fs::create_directories(out);
        write_design(text, request, result, out);
    }

    TempFolder folder;
    fs::path in = folder.path() / "in";
    fs::path out = folder.path() / "out";
    RigText text = rig_with_a_table(in);
    Rig rig = text.rig();
    DesignRequest request = request_for(rig);
    DesignResult result = design(text, request);
};

// Searched for once: each case looks at what that leaves.
const Designed& designed() {
    static const Designed kDesigned;
    return kDesigned;
}

TEST(DesignFiles, LeaveARigThatFindsItsTables) {
    const Designed& of = designed();
    ASSERT_TRUE(of.result.is_better);
    const Rig left = read_rig(of.out / kDesignedRig);
    EXPECT_EQ(left.seafloor.reflectance.at(550.0), of.rig.seafloor.reflectance.at(550.0));
    for (std::size_t s = 0; s < left.strobes.size(); ++s)
        EXPECT_EQ(left.strobes[s].position_m, of.result.best.places[s].position_m);
    EXPECT_TRUE(contains(left.toml, "# where fore is"));
}

TEST(DesignFiles, LeaveThePageAndTheNumbers) {
    const Designed& of = designed();
    const std::string page = read_text_file(of.out / kDesignPage);
    EXPECT_EQ(first_unbalanced(page), "");
    for (const char* words : {"Evenness ", "Light on the floor", "The trade", "Over the envelope"})
        EXPECT_TRUE(contains(words_of(page), words)) << words;
    EXPECT_FALSE(contains(page, "<b>"));
    const auto json = nlohmann::json::parse(read_text_file(of.out / kDesignNumbers));
    EXPECT_EQ(json.at("design").at("worst").at("evenness").get<double>(),
              of.result.best.figures.evenness);
    EXPECT_EQ(json.at("design").at("poses").size(), 3U);
    EXPECT_EQ(json.at("front").size(), of.result.front.size());
}

// The folder of the rig itself will do: its tables are not copied onto themselves.
TEST(DesignFiles, MayStandBesideTheRig) {
    const Designed& of = designed();
    write_design(of.text, of.request, of.result, of.in);
    EXPECT_EQ(read_rig(of.in / kDesignedRig).strobes.size(), 2U);
    EXPECT_EQ(read_rig(of.in / "rig.toml").digest, of.rig.digest);
}

}  // namespace
}  // namespace aphotic::design_files_test
