// SPDX-License-Identifier: BSD-3-Clause
#include "scene_gen/sdl.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>

namespace aphotic::sdl_test {
namespace {

TEST(Sdl, NumbersReadBackToTheSameBits) {
    for (const double value :
         {1.0 / 3.0, 6.45e-6, 1e-300, 0x1p60, -0.1, std::numeric_limits<double>::denorm_min()}) {
        EXPECT_EQ(std::strtod(sdl_number(value).c_str(), nullptr), value);
    }
}

// POV-Ray's (x, y, z) is our (starboard, forward, down).
TEST(Sdl, PointsAreInPovraysFrame) {
    EXPECT_EQ(sdl_point({1.0, 2.0, 3.0}), "<2, 1, 3>");
    EXPECT_EQ(sdl_vector({1.0, 2.0, 3.0}), "<1, 2, 3>");
}

TEST(Sdl, NoTextEndsItselfOrItsLine) {
    EXPECT_EQ(sdl_text("sand"), "\"sand\"");
    EXPECT_EQ(sdl_text("a\" } light_source { 0, 9 } \""), "\"a' } light_source { 0, 9 } '\"");
    EXPECT_EQ(sdl_text("back\\slash\\"), "\"back/slash/\"");
    EXPECT_EQ(sdl_text("two\r\nlines"), "\"two  lines\"");
    EXPECT_EQ(sdl_text("K\xC3\xB6ln"), "\"K??ln\"") << "POV-Ray makes blanks of such letters";
    EXPECT_EQ(sdl_comment("two\nlines"), "two lines");
    EXPECT_EQ(sdl_comment("K\xC3\xB6ln"), "K\xC3\xB6ln");
}

}  // namespace
}  // namespace aphotic::sdl_test
