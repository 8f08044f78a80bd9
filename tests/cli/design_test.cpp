// SPDX-License-Identifier: BSD-3-Clause
//
// A design as a user asks for one: what it leaves, and what its numbers say.
#include "support/command_test.h"
#include "support/small_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <numeric>
#include <set>
#include <string>
#include <vector>

namespace aphotic::cli_design_test {
namespace {

namespace fs = std::filesystem;

class CommandDesign : public CommandTest {
  protected:
    void SetUp() override { put_small_scene("habcam.toml", home_); }

    static Arguments design(const std::string& rig, const Arguments& more) {
        return "design --altitude 1.5,2.5 --evaluations 200 " + rig + more;
    }

    [[nodiscard]] nlohmann::json numbers(const std::string& folder) const {
        return json_in(folder + "/design.json");
    }
};

Arguments tilts_into(const std::string& folder) {
    return fmt::format("--vary strobe.*.aim.tilt_deg -o {}", folder);
}

// A design that is designed again starts at the figures that the first ended with.
TEST_F(CommandDesign, LeavesARigThatIsAsEvenAsItSays) {
    done(design("rig.toml", tilts_into("out")));
    // The start's tilts as the rig has them, and the strobes from two sides.
    const std::string page = text_of("out/report.html");
    for (const char* part : {"26.0° to 180°", "28.0° to 90°", "id=\"above\"", "id=\"side\""})
        EXPECT_TRUE(has(page, part)) << part;
    const nlohmann::json found = numbers("out");
    EXPECT_GT(found["design"]["worst"]["evenness"], found["start"]["worst"]["evenness"]);
    EXPECT_GE(found["design"]["worst"]["coverage"], found["start"]["worst"]["coverage"]);

    done(design("out/designed.toml", tilts_into("again")));
    EXPECT_EQ(numbers("again")["start"]["worst"]["evenness"], found["design"]["worst"]["evenness"]);
}

TEST_F(CommandDesign, TheSameCommandGivesTheSameDesign) {
    for (const char* folder : {"one", "other"}) done(design("rig.toml", tilts_into(folder)));
    EXPECT_EQ(text_of("one/designed.toml"), text_of("other/designed.toml"));
}

// Each of the options that bound a search, by what it does to the strobes.
TEST_F(CommandDesign, StaysWhereItIsToldTo) {
    constexpr double kRounding = 1e-9;
    const auto strobe = [&](const std::string& folder, const std::string& of, std::size_t which) {
        return numbers(folder).at(of).at("strobes").at(which);
    };
    const auto place = [](const nlohmann::json& one) {
        return one.at("position_m").get<std::array<double, 3>>();
    };
    done(design("rig.toml", "--vary strobe.*.position_m --within 0.02 -o near"));
    double farthest = 0.0;
    for (std::size_t s = 0; s < 4; ++s) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double off = std::abs(place(strobe("near", "design", s))[axis] -
                                        place(strobe("near", "start", s))[axis]);
            EXPECT_LE(off, 0.02 + kRounding);
            farthest = std::max(farthest, off);
        }
    }
    EXPECT_GT(farthest, 0.01);  // where there is room, it is used

    done(design("rig.toml", "--vary strobe.*.position_m --box fore=0.45:0.55,0,-0.3:0.3 -o box"));
    const auto [x, y, z] = place(strobe("box", "design", 0));
    EXPECT_GE(x, 0.45 - kRounding);
    EXPECT_LE(x, 0.55 + kRounding);
    EXPECT_EQ(y, 0.0);
    EXPECT_LE(std::abs(z), 0.3 + kRounding);
    EXPECT_NE(place(strobe("box", "design", 0)), place(strobe("box", "start", 0)));

    done(design("rig.toml", tilts_into("turned") + "--turn 2"));
    for (std::size_t s = 0; s < 4; ++s) {
        const auto before = strobe("turned", "start", s).at("direction").get<std::vector<double>>();
        const auto after = strobe("turned", "design", s).at("direction").get<std::vector<double>>();
        const double cosine = std::inner_product(before.begin(), before.end(), after.begin(), 0.0);
        constexpr double kDegree_rad = std::numbers::pi / 180.0;
        EXPECT_LE(std::acos(std::min(1.0, cosine)), 2.0 * kDegree_rad + 1e-6);
    }
}

TEST_F(CommandDesign, SearchesForWhatItIsAskedFor) {
    const auto worst = [&](const std::string& folder, const Arguments& more) {
        done(design("rig.toml", tilts_into(folder) + more));
        return numbers(folder).at("design").at("worst");
    };
    const nlohmann::json even = worst("even", "--keep 0.7");
    const nlohmann::json bright = worst("bright", "--keep 0.7 --for signal");
    const nlohmann::json broad = worst("broad", "--keep 0.7 --for coverage");
    EXPECT_GT(bright["signal_to_noise"], even["signal_to_noise"]);
    EXPECT_GT(even["evenness"], bright["evenness"]);
    EXPECT_GT(broad["coverage"], bright["coverage"]);
    const nlohmann::json start = numbers("even").at("start").at("worst");
    for (const nlohmann::json& one : {even, bright, broad}) {
        for (const char* figure : {"evenness", "signal_to_noise", "coverage"})
            EXPECT_GE(one[figure].get<double>(), 0.7 * start[figure].get<double>()) << figure;
    }
    // More is a fifth as bright as the brightest than is half as bright.
    worst("level", "--level 0.2");
    EXPECT_GT(numbers("level")["start"]["worst"]["coverage"], start["coverage"]);
    EXPECT_EQ(numbers("level")["coverage_level"], 0.2);
}

TEST_F(CommandDesign, JudgesEveryPoseOfItsEnvelope) {
    done(design("rig.toml", tilts_into("out") + "--pitch 0,10 --roll=-5,5 --seed 2"));
    const nlohmann::json found = numbers("out");
    EXPECT_EQ(found["seed"], 2);
    const nlohmann::json& poses = found.at("design").at("poses");
    EXPECT_EQ(poses.size(), 27U);  // ends and middles of three ranges
    double least = 1.0;
    std::set<std::array<double, 3>> seen;
    for (const nlohmann::json& pose : poses) {
        least = std::min(least, pose.at("evenness").get<double>());
        seen.insert({pose.at("altitude_m").get<double>(),
                     pose.at("pitch_deg").get<double>(),
                     pose.at("roll_deg").get<double>()});
    }
    EXPECT_EQ(seen.size(), 27U);
    EXPECT_TRUE(seen.contains({2.5, 10.0, -5.0}));
    EXPECT_EQ(found.at("design").at("worst").at("evenness"), least);
}

TEST_F(CommandDesign, NamesWhatMayVary) {
    refused(design("rig.toml", "--vary strobe.*.aim.tilt_dg -o out --json"),
            "rig.toml: --vary: found strobe.*.aim.tilt_dg; allowed: ");
    EXPECT_FALSE(fs::exists(path("out")));
}

}  // namespace
}  // namespace aphotic::cli_design_test
