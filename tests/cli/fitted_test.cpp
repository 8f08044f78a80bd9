// SPDX-License-Identifier: BSD-3-Clause
//
// Fitted wavelengths end to end: what a plan promises, POV-Ray's frames keep against the
// reference; and frames of one rig give the image of another.
#include "support/command_test.h"
#include "support/small_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <map>
#include <regex>
#include <string>
#include <utility>

namespace aphotic::fitted_test {
namespace {

using Json = nlohmann::json;

using Fitted = CommandTest;

const std::string kHabcam = small_scene(scene_file("habcam.toml"));

double worst(const Json& promises, const std::string& key) {
    double largest = 0.0;
    for (const char* channel : {"R", "G", "B"}) {
        largest = std::max(largest, promises.at(channel).at(key).get<double>());
    }
    return largest;
}

// One plan for every altitude: one frame under 1e-3, two under 1e-6.
TEST_F(Fitted, OnePlanServesAltitudesFromOneToSixMetres) {
    for (const auto& [count, error] : {std::pair{"3", 1e-3}, std::pair{"6", 1e-6}}) {
        Json first;
        for (const std::string altitude : {"1.0", "2.5", "6.0"}) {
            write_file(path("rig.toml"), with(kHabcam, {{"altitude_m", altitude}}));
            const Arguments options(fmt::format("rig.toml --fitted {} --paths-m 2,16", count));
            const Json plan = json_by("plan --json" + options);
            EXPECT_LT(worst(plan.at("promise"), "error"), error) << altitude;
            for (const Json& w : plan.at("wavelengths")) {
                if (first.size() < plan.at("wavelengths").size()) first.push_back(w.at("weight"));
            }
            EXPECT_EQ(plan.at("wavelengths")[1].at("weight"), first[1]) << altitude;
            done("validate -o out" + options);
        }
    }
}

// Each of the five is the floor in turn, and the others stand in the list.
TEST_F(Fitted, FiveMaterialsTakeThreeFramesAtMost) {
    const std::string five = small_scene(scene_file("five-materials.toml"));
    std::filesystem::copy_file(scene_file("grey-card.csv"), path("grey-card.csv"));
    for (const std::string material :
         {"sand", "green-algae", "brown-algae", "red-algae", "grey-card.csv"}) {
        const std::string rig = replaced(five, "materials = [", "materials = [\"sand\", ");
        write_file(path("rig.toml"), with(rig, {{"reflectance", "\"" + material + "\""}}));
        const Json plan = json_by("plan rig.toml --json");
        EXPECT_EQ(plan.at("sources"), 5);
        EXPECT_LE(plan.at("frames"), 3);
        EXPECT_LE(worst(plan.at("promise"), "promise"), 1e-3);
        done("validate rig.toml -o out");
    }
}

// Frames of Pope & Fry water and a xenon flash, as other water, another lamp, another sensor;
// against the reference of the changed rig, to the promise. POV-Ray is not asked again.
TEST_F(Fitted, FramesServeOtherWaterLampsAndSensors) {
    write_file(path("rig.toml"), kHabcam);
    done("render rig.toml -o out --fitted 6");
    write_file(path("sensor.csv"),
               "wavelength_nm,red,green,blue\n400,0,0.1,0.8\n500,0.1,1,0.6\n620,0.9,0.2,0\n"
               "720,0.4,0,0\n");
    const std::map<std::string, std::string> changed{
        {"half", with(kHabcam, {{"multiple", "0.5"}})},
        {"double", with(kHabcam, {{"multiple", "2.0"}})},
        {"lamp", replaced(kHabcam, "xenon-flash", "xenon-arc")},
        {"sensor", with(kHabcam, {{"response", R"({ table = "sensor.csv", kind = "quantum" })"}})}};
    for (const auto& [name, toml] : changed) {
        write_file(path(name + ".toml"), toml);
        const std::map<std::string, std::string> no_povray{{"APHOTIC_POVRAY", "/no/povray"}};
        const Json again =
            json_by(aphotic("integrate out --json --rig " + name + ".toml", no_povray));
        const double promise = worst(again.at("promise"), "promise");
        EXPECT_LE(promise, 1e-3) << name;
        done(aphotic("trace " + name + ".toml -o " + name, no_povray));
        const std::string traced = name + "/image.exr";
        done(fmt::format("compare out/as-{}/image.exr {} --bound {}", name, traced, promise));
        // Another image than the frames' own rig's: the comparison can say no.
        done("compare out/image.exr " + traced, "", kAnswerIsNo);
    }
    EXPECT_TRUE(std::filesystem::exists(path("out/spectral.exr")));
    EXPECT_FALSE(std::filesystem::exists(path("out/as-half/spectral.exr")));
}

TEST_F(Fitted, FramesThatCannotServeAreRefusedByWhatIsLacking) {
    write_file(path("rig.toml"), kHabcam);
    done("generate rig.toml -o out");
    write_file(path("murky.toml"), with(kHabcam, {{"multiple", "9.0"}}));
    const CommandResult murky = refused("integrate out --rig murky.toml", "it lacks");
    EXPECT_TRUE(std::regex_search(
        murky.err,
        std::regex(R"(murky.toml: the frames give this rig's image to \S+ only; allowed: 0.001)")))
        << murky.err;
    write_file(path("high.toml"), with(kHabcam, {{"altitude_m", "2.5"}}));
    refused("integrate out --rig high.toml",
            "high.toml: sled.altitude_m: found 2.5; allowed: 2, as the frames");
}

}  // namespace
}  // namespace aphotic::fitted_test
