// SPDX-License-Identifier: BSD-3-Clause
#include "rig/strobe_text.h"

#include "support/design_rig.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace aphotic::strobe_text_test {
namespace {

constexpr double kRounded = 0.5e-5;  // of a direction's five places
const std::string kAim = "aim = { tilt_deg = 26.0, toward = \"axis\" }";

TEST(StrobeText, WithoutAChangeItIsTheText) {
    const std::string text = design_rig_text(two_strobes());
    EXPECT_EQ(with_strobes(text, std::vector<StrobeChange>(2)), text);
}

TEST(StrobeText, ChangesTheNumbersAndKeepsTheRest) {
    EXPECT_EQ(
        with_strobes(design_strobe("é", "[\n  0.5, 0.0,\n  0.0 ]", kAim),
                     {{.position_m = Eigen::Vector3d(0.25, -0.00004, 1.0), .tilt_deg = 7.0}}),
        design_strobe("é", "[0.25, 0.0, 1.0]", "aim = { tilt_deg = 7.0, toward = \"axis\" }"));
}

TEST(StrobeText, IsReadAsItWasMeant) {
    const Eigen::Vector3d direction = Eigen::Vector3d(0.3, -0.2, 0.9).normalized();
    for (const std::string& aim : {kAim, std::string("direction = [0, 0, 1]")}) {
        for (const std::string& power : {std::string(), std::string("\npower = 3 # W")}) {
            const std::string text = with_strobes(design_rig_text(two_strobes(aim + power)),
                                                  {{},
                                                   {.position_m = Eigen::Vector3d(0.1, 0.2, 0.3),
                                                    .direction = direction,
                                                    .power_factor = 0.5}});
            const Rig rig = parse_rig(text, "rig.toml", {});
            EXPECT_EQ(rig.strobes[1].position_m, Eigen::Vector3d(0.1, 0.2, 0.3)) << text;
            EXPECT_LT((rig.strobes[1].axis - direction).norm(), 2.0 * kRounded) << text;
            EXPECT_EQ(rig.strobes[1].power, power.empty() ? 0.5 : 1.5) << text;
            EXPECT_EQ(rig.strobes[0].position_m, Eigen::Vector3d(0.3, 0.0, 0.0)) << text;
            EXPECT_EQ(rig.strobes[0].power, power.empty() ? 1.0 : 3.0) << text;
        }
    }
}

TEST(StrobeText, TellsHowAStrobeIsAimed) {
    const std::string text =
        design_strobe("a", "[1, 0, 0]", kAim) +
        design_strobe("b", "[1, 0, 0]", "direction = [0, 0, 1]") +
        design_strobe("c", "[1, 0, 0]", "aim.tilt_deg = 3\naim.toward = \"axis\"");
    EXPECT_EQ(strobe_aims(text),
              (std::vector{StrobeAim::Inline, StrobeAim::Direction, StrobeAim::Apart}));
    EXPECT_NE(with_strobes(text, {{}, {}, {.tilt_deg = 4.0}}).find("aim.tilt_deg = 4.0\n"),
              std::string::npos);
}

// Whole strobes in one line take no new line.
TEST(StrobeText, AddsAPowerToAStrobeInOneLine) {
    EXPECT_EQ(with_strobes("strobe = [{ name = \"a\", position_m = [1, 0, 0] }]",
                           {{.power_factor = 0.25}}),
              "strobe = [{ name = \"a\", power = 0.25000, position_m = [1, 0, 0] }]");
}

}  // namespace
}  // namespace aphotic::strobe_text_test
