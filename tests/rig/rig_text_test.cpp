// SPDX-License-Identifier: BSD-3-Clause
#include "rig/rig_text.h"

#include "base/error.h"
#include "support/fit_rig.h"

#include <gtest/gtest.h>

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

TEST(RigText, NamesWhatIsNotThere) {
    RigText text = fit_rig({});
    EXPECT_EQ(text.number("water.chlorophyll_mg_m3"), std::nullopt);
    try {
        text.set("strobe.stern.power", 1.0);
        ADD_FAILURE() << "nothing was thrown";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("strobe.stern.power: found no 'stern'"),
                  std::string::npos)
            << error.what();
    }
}

// To the last bit, and what is read again is the same.
TEST(RigText, KeepsDigits) {
    RigText text = fit_rig({});
    const double third = 1.0 / 3.0;
    text.set("water.multiple", third);
    EXPECT_EQ(text.rig().water.multiple, third);
    EXPECT_EQ(RigText(text.text(), "again.toml", {}).number("water.multiple"), third);
}

}  // namespace
}  // namespace aphotic::rig_text_test
