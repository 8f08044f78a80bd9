// SPDX-License-Identifier: BSD-3-Clause
//
// Fitted wavelengths end to end: what a plan promises, POV-Ray's frames keep against the
// reference; and frames of one rig give the image of another.
#include "support/run_command.h"
#include "support/small_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <regex>

namespace aphotic::fitted_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const std::string kScenes = std::string(APHOTIC_SOURCE_DIR) + "/scenes/";

std::string replaced(const std::string& text, const std::string& from, const std::string& to) {
    const std::string result = std::regex_replace(text, std::regex(from), to);
    EXPECT_NE(result, text) << "nothing to replace: " << from;
    return result;
}

class Fitted : public testing::Test {
  protected:
    void write_rig(const std::string& name, const std::string& toml) {
        write_file(folder_.path() / name, toml);
    }

    CommandResult run(const std::vector<std::string>& arguments,
                      const std::map<std::string, std::string>& environment = {}) {
        return run_aphotic(folder_.path(), arguments, environment);
    }

    Json json(const std::vector<std::string>& arguments) {
        const CommandResult result = run(arguments);
        EXPECT_EQ(result.status, 0) << result.out << result.err;
        return Json::parse(result.out);
    }

    TempFolder folder_;
};

double worst(const Json& promises, const std::string& key) {
    double largest = 0.0;
    for (const char* channel : {"R", "G", "B"}) {
        largest = std::max(largest, promises.at(channel).at(key).get<double>());
    }
    return largest;
}

TEST_F(Fitted, HabCamIsOneFrameAndKeepsItsPromise) {
    write_rig("rig.toml", small_scene(kScenes + "habcam.toml"));
    const Json plan = json({"plan", "rig.toml", "--json"});
    EXPECT_EQ(plan.at("frames"), 1);
    EXPECT_LT(worst(plan.at("promise"), "error"), 1e-5);
    const CommandResult validation = run({"validate", "rig.toml", "-o", "out"});
    EXPECT_EQ(validation.status, 0) << validation.out << validation.err;
}

// One plan for every altitude: one frame under 1e-3, two under 1e-6.
TEST_F(Fitted, OnePlanServesAltitudesFromOneToSixMetres) {
    const std::string habcam = small_scene(kScenes + "habcam.toml");
    for (const auto& [count, error] : {std::pair{"3", 1e-3}, std::pair{"6", 1e-6}}) {
        Json first;
        for (const std::string altitude : {"1.0", "2.5", "6.0"}) {
            write_rig("rig.toml", replaced(habcam, "altitude_m = 2.0", "altitude_m = " + altitude));
            const std::vector<std::string> options{
                "rig.toml", "--fitted", count, "--paths-m", "2,16"};
            std::vector<std::string> arguments{"plan", "--json"};
            arguments.insert(arguments.end(), options.begin(), options.end());
            const Json plan = json(arguments);
            EXPECT_LT(worst(plan.at("promise"), "error"), error) << altitude;
            for (const Json& w : plan.at("wavelengths")) {
                if (first.size() < plan.at("wavelengths").size()) first.push_back(w.at("weight"));
            }
            EXPECT_EQ(plan.at("wavelengths")[1].at("weight"), first[1]) << altitude;
            arguments = {"validate", "-o", "out"};
            arguments.insert(arguments.end(), options.begin(), options.end());
            const CommandResult validation = run(arguments);
            EXPECT_EQ(validation.status, 0) << validation.out << validation.err;
        }
    }
}

// Each of the five is the floor in turn, and the others stand in the list.
TEST_F(Fitted, FiveMaterialsTakeThreeFramesAtMost) {
    const std::string five = small_scene(kScenes + "five-materials.toml");
    fs::copy_file(kScenes + "grey-card.csv", folder_.path() / "grey-card.csv");
    const std::string floor = "reflectance = \"sand\"";
    for (const std::string material :
         {"sand", "green-algae", "brown-algae", "red-algae", "grey-card.csv"}) {
        const std::string rig = replaced(five, "materials = \\[", "materials = [\"sand\", ");
        write_rig(
            "rig.toml",
            material == "sand" ? rig : replaced(rig, floor, "reflectance = \"" + material + "\""));
        const Json plan = json({"plan", "rig.toml", "--json"});
        EXPECT_EQ(plan.at("sources"), 5);
        EXPECT_LE(plan.at("frames"), 3);
        EXPECT_LE(worst(plan.at("promise"), "promise"), 1e-3);
        const CommandResult validation = run({"validate", "rig.toml", "-o", "out"});
        EXPECT_EQ(validation.status, 0) << material << validation.out << validation.err;
    }
}

// Frames of Pope & Fry water and a xenon flash, as other water, another lamp, another sensor;
// against the reference of the changed rig, to the promise. POV-Ray is not asked again.
TEST_F(Fitted, FramesServeOtherWaterLampsAndSensors) {
    const std::string habcam = small_scene(kScenes + "habcam.toml");
    write_rig("rig.toml", habcam);
    const CommandResult render = run({"render", "rig.toml", "-o", "out", "--fitted", "6"});
    ASSERT_EQ(render.status, 0) << render.err;
    write_file(folder_.path() / "sensor.csv",
               "wavelength_nm,red,green,blue\n400,0,0.1,0.8\n500,0.1,1,0.6\n620,0.9,0.2,0\n"
               "720,0.4,0,0\n");
    const std::map<std::string, std::string> changed{
        {"half", replaced(habcam, "multiple   = 1.0", "multiple = 0.5")},
        {"double", replaced(habcam, "multiple   = 1.0", "multiple = 2.0")},
        {"lamp", replaced(habcam, "xenon-flash", "xenon-arc")},
        {"sensor",
         replaced(habcam,
                  "response        = \"nikon-d5100\"",
                  "response = { table = \"sensor.csv\", kind = \"quantum\" }")}};
    for (const auto& [name, toml] : changed) {
        write_rig(name + ".toml", toml);
        const std::map<std::string, std::string> no_povray{{"APHOTIC_POVRAY", "/no/povray"}};
        const CommandResult again =
            run({"integrate", "out", "--rig", name + ".toml", "--json"}, no_povray);
        ASSERT_EQ(again.status, 0) << name << again.err;
        const double promise = worst(Json::parse(again.out).at("promise"), "promise");
        EXPECT_LE(promise, 1e-3) << name;
        ASSERT_EQ(run({"trace", name + ".toml", "-o", name}, no_povray).status, 0);
        const CommandResult compared = run({"compare",
                                            "out/as-" + name + "/image.exr",
                                            name + "/image.exr",
                                            "--bound",
                                            fmt::format("{}", promise)});
        EXPECT_EQ(compared.status, 0) << name << ", promised " << promise << "\n" << compared.out;
        // Another image than the frames' own rig's: the comparison can say no.
        EXPECT_EQ(run({"compare", "out/image.exr", name + "/image.exr"}).status, 1) << name;
    }
    EXPECT_TRUE(fs::exists(folder_.path() / "out" / "spectral.exr"));
    EXPECT_FALSE(fs::exists(folder_.path() / "out" / "as-half" / "spectral.exr"));
}

TEST_F(Fitted, FramesThatCannotServeAreRefusedByWhatIsLacking) {
    const std::string habcam = small_scene(kScenes + "habcam.toml");
    write_rig("rig.toml", habcam);
    ASSERT_EQ(run({"generate", "rig.toml", "-o", "out"}).status, 0);
    write_rig("murky.toml", replaced(habcam, "multiple   = 1.0", "multiple = 9.0"));
    const CommandResult murky = run({"integrate", "out", "--rig", "murky.toml"});
    EXPECT_EQ(murky.status, 2);
    EXPECT_TRUE(std::regex_search(
        murky.err,
        std::regex(R"(murky.toml: the frames give this rig's image to \S+ only; allowed: 0.001)")))
        << murky.err;
    EXPECT_NE(murky.err.find("it lacks"), std::string::npos) << murky.err;
    EXPECT_FALSE(fs::exists(folder_.path() / "out" / "as-murky"));

    write_rig("high.toml", replaced(habcam, "altitude_m = 2.0", "altitude_m = 2.5"));
    const CommandResult high = run({"integrate", "out", "--rig", "high.toml"});
    EXPECT_EQ(high.status, 2);
    EXPECT_NE(high.err.find("high.toml: sled.altitude_m: found 2.5; allowed: 2, as the frames"),
              std::string::npos)
        << high.err;
}

}  // namespace
}  // namespace aphotic::fitted_test
