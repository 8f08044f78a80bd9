// SPDX-License-Identifier: BSD-3-Clause
#include "lightmap/design_space.h"

#include "base/error.h"
#include "support/design_rig.h"
#include "support/has.h"
#include "support/refusal.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

namespace aphotic::design_space_test {
namespace {

constexpr double kRounding = 1e-12;
const std::string kAimed = "aim = { tilt_deg = 20.0, toward = \"axis\" }";

DesignSpace space_of(const Rig& rig, const DesignFreedom& freedom) {
    return {text_of(rig), freedom, {rig.sled}};
}

std::string refusal(const DesignFreedom& freedom, const std::string& strobes = two_strobes()) {
    return refusal_of([&] { return space_of(design_rig(strobes), freedom); });
}

void expect_said(const std::string& said, const std::string& what) {
    EXPECT_TRUE(has(said, what));
}

TEST(DesignSpace, BeginsWhereTheRigIs) {
    for (const std::string& aim : {kAimed, std::string("direction = [0.1, 0.2, 1]")}) {
        const Rig rig = design_rig(two_strobes(aim));
        const DesignSpace space =
            space_of(rig, {.keys = {"strobe.*.position_m", "strobe.fore.aim", "strobe.*.power"}});
        EXPECT_EQ(space.size(), 3U + 3U + 2U + 2U);
        const std::vector<StrobePlace> places = space.places_at(space.start());
        for (std::size_t s = 0; s < places.size(); ++s) {
            EXPECT_LT((places[s].position_m - rig.strobes[s].position_m).norm(), kRounding);
            EXPECT_LT((places[s].axis - rig.strobes[s].axis).norm(), kRounding);
            EXPECT_NEAR(places[s].power, rig.strobes[s].power, kRounding);
        }
    }
}

TEST(DesignSpace, KeepsBoxesAnglesAndTheLight) {
    const Rig rig = design_rig(two_strobes());
    const double turn_rad = 0.3;
    const DesignSpace space =
        space_of(rig,
                 {.keys = {"strobe.*.position_m", "strobe.*.aim", "strobe.*.power"},
                  .within_m = 0.1,
                  .boxes = {"aft=-0.9:-0.5,0,-0.2:0.1"},
                  .turn_rad = turn_rad});
    std::mt19937_64 dice(1);
    std::uniform_real_distribution<double> share;
    for (int i = 0; i < 100; ++i) {
        std::vector<double> point(space.size());
        for (double& one : point) one = i < 2 ? i : share(dice);
        const std::vector<StrobePlace> places = space.places_at(point);
        EXPECT_LE((places[0].position_m - rig.strobes[0].position_m).cwiseAbs().maxCoeff(),
                  0.1 + kRounding);
        EXPECT_GE(places[1].position_m.x(), -0.9);
        EXPECT_LE(places[1].position_m.x(), -0.5);
        EXPECT_EQ(places[1].position_m.y(), 0.0);
        EXPECT_NEAR(places[0].power + places[1].power, 2.0, kRounding);
        for (std::size_t s = 0; s < places.size(); ++s) {
            // Both turns at once: tan^2 = tan^2(a) + tan^2(b).
            const double most_rad = std::atan(std::sqrt(2.0) * std::tan(turn_rad));
            EXPECT_LE(std::acos(places[s].axis.dot(rig.strobes[s].axis)), most_rad + 1e-7);
        }
        const double z_m = space.text_at(point).rig().strobes[1].position_m.z();
        EXPECT_EQ(z_m, std::clamp(z_m, -0.2, 0.1));
    }
}

// As the same words in the rig would have it.
TEST(DesignSpace, AnAimTowardsTheAxisGoesOnPointingThere) {
    const DesignSpace space =
        space_of(design_rig(two_strobes(kAimed)), {.keys = {"strobe.fore.position_m"}});
    const std::vector point{0.7, 0.9, 0.2};
    const StrobePlace place = space.places_at(point).front();
    const Rig moved = space.text_at(point).rig();
    EXPECT_LT((place.axis - moved.strobes[0].axis).norm(), 1e-4);  // four places of a metre
}

// Whatever the words for a strobe's aim and power, and in as many digits as are promised.
TEST(DesignSpace, WritesWhatItMeans) {
    constexpr double kRounded = 0.5e-5;  // of a direction's five places
    for (const std::string aim : {"aim = { tilt_deg = 20.0, toward = \"axis\" }",
                                  "aim.tilt_deg = 20.0\naim.toward = \"axis\"",
                                  "direction = [0.1, 0.2, 1]"}) {
        for (const std::string power : {"", "\nenergy_j = 3", "\npower = 3  # W"}) {
            const Rig rig = design_rig(two_strobes(aim + power));
            const DesignSpace space =
                space_of(rig, {.keys = {"strobe.*.position_m", "strobe.*.aim", "strobe.*.power"}});
            EXPECT_EQ(space.text_at(space.start()).text(), rig.toml);
            const std::vector<double> point(space.size(), 0.7);
            const std::vector<StrobePlace> places = space.places_at(point);
            const RigText text = space.text_at(point);
            const Rig written = text.rig();
            for (std::size_t s = 0; s < places.size(); ++s) {
                EXPECT_LT((written.strobes[s].position_m - places[s].position_m).norm(), 1e-4);
                EXPECT_LT((written.strobes[s].axis - places[s].axis).norm(), 2.0 * kRounded);
                EXPECT_NEAR(written.strobes[s].power / places[s].power, 1.0, 1e-4);
            }
            EXPECT_TRUE(has(text.text(), "# where fore is"));
        }
    }
}

TEST(DesignSpace, ServesAllPathsWithin) {
    const Rig rig = design_rig(two_strobes());
    const DesignSpace space = space_of(rig, {.keys = {"strobe.*.position_m"}, .within_m = 0.3});
    LightmapMaker maker(rig, space.paths(), {});
    std::mt19937_64 dice(2);
    for (int i = 0; i < 64; ++i) {
        std::vector<double> point(space.size());
        for (double& one : point) one = static_cast<double>(dice() % 2);
        maker.place(space.places_at(point));
        EXPECT_NO_THROW((void)maker.map(rig.sled));
    }
}

// What place() makes is what a maker of its own makes.
TEST(DesignSpace, AMakerWhoseStrobesMovedIsAsGoodAsNew) {
    Rig rig = design_rig(two_strobes());
    const DesignSpace space =
        space_of(rig, {.keys = {"strobe.*.position_m", "strobe.*.aim", "strobe.*.power"}});
    const std::vector<StrobePlace> places = space.places_at(std::vector<double>(space.size(), 0.8));
    LightmapMaker maker(rig, space.paths(), {});
    maker.place(places);
    const Lightmap moved = maker.map(rig.sled);
    for (std::size_t s = 0; s < places.size(); ++s) {
        rig.strobes[s].position_m = places[s].position_m;
        rig.strobes[s].axis = places[s].axis;
        rig.strobes[s].power = places[s].power;
    }
    EXPECT_EQ(moved.samples, LightmapMaker(rig, space.paths(), {}).map(rig.sled).samples);
}

TEST(DesignSpace, RefusesWhatTheRigDoesNotHave) {
    expect_said(refusal({.keys = {"strobe.stern.aim"}}),
                "found strobe.stern.aim; allowed: strobe.NAME.position_m, strobe.NAME.aim, "
                "strobe.NAME.aim.tilt_deg or strobe.NAME.power, with the NAME *, fore, aft");
    for (const char* key : {"", "strobe", "strobe..aim", "strobe.fore.beam", "water.multiple"})
        expect_said(refusal({.keys = {key}}), "--vary: found ");
    expect_said(refusal({.keys = {}}), "nothing that is free");
    expect_said(refusal({.keys = {"strobe.fore.power"}}), "the power of one strobe");
    expect_said(refusal({.keys = {"strobe.fore.aim.tilt_deg"}}), "a strobe with a direction");
    expect_said(
        refusal({.keys = {"strobe.*.power"}}, two_strobes("direction = [0, 0, 1]\npower = 0")),
        "a strobe without light");
}

TEST(DesignSpace, RefusesBoxesThatDoNotHoldTheStart) {
    const auto with_box = [](const std::string& box) {
        return refusal({.keys = {"strobe.fore.position_m"}, .boxes = {box}});
    };
    for (const char* box : {"fore", "fore=1", "fore=0:1,0", "stern=0:1,0,0", "aft=-1:0,0,0"})
        expect_said(with_box(box), "allowed: NAME=X0:X1,Y0:Y1,Z0:Z1");
    for (const char* box : {"fore=0.4:0.5,0,0", "fore=1:0,0,0", "fore=0:nan,0,0", "fore=0:1:2,0,0"})
        expect_said(with_box(box), "around the 0.3 m where the strobe is");
}

TEST(DesignSpace, KeepsLampsOverTheFloorAndOutOfView) {
    const auto start = [](const std::string& position_m) {
        return refusal({.keys = {"strobe.fore.position_m"}},
                       design_strobe("fore", position_m, "direction = [0, 0, 1]"));
    };
    expect_said(start("[0.0, 0.0, 0.5]"), "in the camera's view");
    expect_said(start("[2.0, 0.0, 1.95]"), "over the floor at an altitude of 2 m");
    EXPECT_EQ(start("[2.0, 0.0, 1.8]"), kAccepted);
}

}  // namespace
}  // namespace aphotic::design_space_test
