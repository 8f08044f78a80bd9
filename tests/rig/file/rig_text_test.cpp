// SPDX-License-Identifier: BSD-3-Clause
#include "rig/file/rig_text.h"

#include "base/error.h"
#include "support/design_rig.h"
#include "support/fit_rig.h"
#include "support/has.h"
#include "support/refusal.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace aphotic::rig_text_test {
namespace {

TEST(RigText, UntouchedItIsTheFile) {
    const RigText text("# a comment\n" + fit_rig({}).text(), "rig.toml", {});
    EXPECT_EQ(text.text(), "# a comment\n" + fit_rig({}).text());
}

TEST(RigText, SetsKeysByPath) {
    RigText text = fit_rig({});
    text.set("water.multiple", 0.5);
    text.set("strobe.aft.power", 2.0);
    text.set("strobe.0.position_m", std::vector<double>{0.4, 0.0, 0.1});
    text.set("beam.smooth.cones.0.exponent", 3.0);
    const Rig rig = text.rig();
    EXPECT_EQ(rig.water.multiple, 0.5);
    EXPECT_EQ(rig.strobes[1].power, 2.0);
    EXPECT_EQ(rig.strobes[0].position_m.x(), 0.4);
    EXPECT_EQ(rig.strobes[0].beam.cones[0].exponent, 3.0);
    EXPECT_EQ(text.number("strobe.1.power"), 2.0);
}

TEST(RigText, MakesTablesOnTheWay) {
    RigText text = fit_rig({});
    text.set("beam.other.fwhm_deg", 40.0);
    text.set("strobe.fore.beam", std::string("other"));
    EXPECT_EQ(text.rig().strobes[0].beam.name, "other");
    text.erase("beam.other.fwhm_deg");
    EXPECT_FALSE(text.has("beam.other.fwhm_deg"));
    text.erase("beam.none.at.all");
}

TEST(RigText, CopiesATable) {
    const RigText rig = fit_rig({});
    RigText text = rig;
    text.copy(rig, "beam.smooth", "beam.other");
    text.set("beam.smooth.cones.0.exponent", 3.0);
    text.set("strobe.fore.beam", std::string("other"));
    const double exponent = rig.rig().strobes[0].beam.cones[0].exponent;
    EXPECT_EQ(text.rig().strobes[0].beam.cones[0].exponent, exponent);
    EXPECT_EQ(text.rig().strobes[1].beam.cones[0].exponent, 3.0);
    text.copy(text, "beam.smooth", "beam.other");
    EXPECT_EQ(text.rig().strobes[0].beam.cones[0].exponent, 3.0);
    EXPECT_THROW(text.copy(rig, "beam.none", "beam.other"), InputError);
}

TEST(RigText, NamesWhatIsNotThere) {
    RigText text = fit_rig({});
    EXPECT_EQ(text.number("water.chlorophyll_mg_m3"), std::nullopt);
    EXPECT_TRUE(has(refusal_of([&] { text.set("strobe.stern.power", 1.0); }),
                    "strobe.stern.power: found no 'stern'"));
}

// Of a strobe's lines. What stands besides the value stays, byte for byte.
struct TextChange {
    std::string was;
    std::string key;
    std::vector<double> value;  // one: a number; none: it is erased
    std::string is;
};

const std::string kDown = "direction = [0, 0, 1]";

TEST(RigText, ChangesWhatIsAskedAndNothingElse) {
    const std::vector<TextChange> changes{
        {"aim = { tilt_deg = 26.0, toward = \"axis\" }  # é",
         "aim.tilt_deg",
         {7.0},
         "aim = { tilt_deg = 7.0, toward = \"axis\" }  # é"},
        {"aim.tilt_deg = 3  # é\naim.toward = \"axis\"",
         "aim.tilt_deg",
         {-0.0},
         "aim.tilt_deg = 0.0  # é\naim.toward = \"axis\""},
        {"direction = [\n  0.5, 0.0,  # x\n  0.1 ]",
         "direction",
         {0.25, -0.0, 1.0},
         "direction = [0.25, 0.0, 1.0]"},
        {kDown + "  # down", "power", {0.165}, kDown + "  # down\npower = 0.165"},
        {kDown + "\npower = 2  # W", "power", {}, kDown},
        {"aim = { tilt_deg = 3, toward = \"axis\" }", "aim", {}, ""},
        {"aim.tilt_deg = 3\naim.toward = \"axis\"\npower = 2.0", "aim", {}, "power = 2.0"},
        {"power = 2.0\n[strobe.aim]  # its own\ntilt_deg = 3\ntoward = \"axis\"",
         "aim",
         {},
         "power = 2.0"},
        {"power = 2.0\n[strobe.aim]\ntilt_deg = 3\ntoward = \"axis\"",
         "energy_j",
         {5.0},
         "power = 2.0\nenergy_j = 5.0\n[strobe.aim]\ntilt_deg = 3\ntoward = \"axis\""},
        {"aim = { tilt_deg = 3, toward = \"axis\" }", "aim.toward", {}, "aim = { tilt_deg = 3 }"},
        {"aim = { tilt_deg = 3, toward = \"axis\" }",
         "aim.tilt_deg",
         {},
         "aim = { toward = \"axis\" }"},
    };
    const auto text_of = [](const std::string& lines) {
        return design_rig_text(design_strobe("é", "[0.5, 0, 0]", lines));
    };
    for (const TextChange& change : changes) {
        RigText text(text_of(change.was), "rig.toml", {});
        const std::string key = "strobe.é." + change.key;
        if (change.value.empty()) {
            text.erase(key);
        } else if (change.value.size() == 1) {
            text.set(key, change.value.front());
        } else {
            text.set(key, change.value);
        }
        const std::string wanted = text_of(change.is);
        // A line that is gone takes its end with it.
        EXPECT_EQ(text.text(), change.is.empty() ? wanted.substr(0, wanted.size() - 1) : wanted)
            << change.was;
    }
}

// Wherever the table of the key stands.
TEST(RigText, AddsKeysToEveryKindOfTable) {
    const std::string strobes = two_strobes();
    const auto water_of = [&](const std::string& lines) {
        std::string text = design_rig_text(strobes);
        text.replace(text.find("multiple = 0.0"), 14, lines);
        return text;
    };
    const auto added = [&](const std::string& text, const std::string& key) {
        RigText rig(text, "rig.toml", {});
        rig.set(key, 1.5);
        EXPECT_EQ(rig.number(key), 1.5) << rig.text();
        return rig.text();
    };
    EXPECT_EQ(added(water_of("multiple = 0.0"), "water.a.b"),
              water_of("multiple = 0.0\na.b = 1.5"));
    // A key of the root, of none and of a table that only others' headers name.
    const std::string text = design_rig_text(strobes);
    EXPECT_EQ(added(text, "first"), std::string(text).insert(text.find("[sled]"), "first = 1.5\n"));
    const std::string untitled = text.substr(text.find("[sled]"));
    EXPECT_EQ(added(untitled, "first"), "first = 1.5\n" + untitled);
    EXPECT_EQ(added(text, "beam.wide.fwhm_deg"), text + "\n[beam.wide]\nfwhm_deg = 1.5\n");
    EXPECT_EQ(added(text, "sled.roll_deg"),
              std::string(text).insert(text.find("[camera]"), "roll_deg = 1.5\n"));
    // Of a table that dots make.
    const std::string aim = "aim.tilt_deg = 3\naim.toward = \"axis\"";
    EXPECT_EQ(added(design_rig_text(two_strobes(aim)), "strobe.fore.aim.more"),
              design_rig_text(design_strobe("fore", "[0.3, 0.0, 0.0]", aim + "\naim.more = 1.5") +
                              design_strobe("aft", "[-0.6, 0.0, 0.0]", aim)));
}

TEST(RigText, SetsNoTable) {
    RigText text = fit_rig({});
    for (const char* key : {"water", "strobe", "strobe.fore", "beam", "beam.smooth"}) {
        EXPECT_THROW(text.set(key, 1.0), InputError) << key;
    }
    EXPECT_EQ(text.text(), fit_rig({}).text());
}

TEST(RigText, AddsToStrobesInOneLine) {
    const std::string strobe =
        "{ name = \"a\", position_m = [1, 0, 0], direction = [0, 0, 1], "
        "beam = \"round\"";
    const std::string text = design_rig_text("");
    const std::string lines = "strobe = [" + strobe + " }]\n";
    RigText rig(lines + text, "rig.toml", {});
    rig.set("strobe.a.power", 0.25);
    EXPECT_EQ(rig.text(), "strobe = [" + strobe + ", power = 0.25 }]\n" + text);
    rig.erase("strobe.a.power");
    EXPECT_EQ(rig.text(), lines + text);
}

// To the last bit, and what is read again is the same.
TEST(RigText, KeepsDigits) {
    RigText text = fit_rig({});
    for (const double value : {1.0 / 3.0, 1e-5, 2e20, 1.5e-300, 0.165, 3.0}) {
        text.set("water.multiple", value);
        EXPECT_EQ(text.number("water.multiple"), value) << text.text();
    }
    text.set("water.multiple", 1.0 / 3.0);
    EXPECT_EQ(text.rig().water.multiple, 1.0 / 3.0);
}

}  // namespace
}  // namespace aphotic::rig_text_test
