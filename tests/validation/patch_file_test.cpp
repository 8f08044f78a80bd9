// SPDX-License-Identifier: BSD-3-Clause
#include "validation/patch_file.h"

#include "base/error.h"
#include "support/refusal.h"

#include <gtest/gtest.h>

namespace aphotic::patch_file_test {
namespace {

std::string fault_of(const std::string& text) {
    return refusal_of([&] { return parse_patches("p.csv", text); });
}

TEST(PatchFile, HasColumnsInAnyOrderAndReferencesOfEveryKind) {
    const std::vector<Patch> patches = parse_patches("p.csv",
                                                     "# panels\r\n"
                                                     "h,note,reference,x,y,w,patch\r\n"
                                                     "4,-,0.18,1,2,3,panel fore\r\n"
                                                     "\r\n"
                                                     "4,-,grey,1,2,3,b\r\n"
                                                     "4,-,66.2  14.5 -17,1,2,3,c\r\n"
                                                     "4,-,50 0 0,1,2,3,d\r\n"
                                                     "4,-,neutral-5,1,2,3,e\r\n"
                                                     "4,-,orange,1,2,3,f\r\n"
                                                     "4,-,,1,2,3,g\r\n");
    ASSERT_EQ(patches.size(), 7U);
    EXPECT_EQ(patches[0].name, "panel fore");
    EXPECT_EQ(patches[0].x_px, 1);
    EXPECT_EQ(patches[0].y_px, 2);
    EXPECT_EQ(patches[0].width_px, 3);
    EXPECT_EQ(patches[0].height_px, 4);
    EXPECT_TRUE(patches[0].is_grey);
    EXPECT_NEAR(patches[0].lab->L, 49.496, 1e-3);
    EXPECT_TRUE(patches[1].is_grey);
    EXPECT_FALSE(patches[1].lab);
    EXPECT_FALSE(patches[2].is_grey);
    EXPECT_EQ(patches[2].lab->b, -17.0);
    EXPECT_TRUE(patches[3].is_grey);
    EXPECT_TRUE(patches[4].is_grey);
    EXPECT_FALSE(patches[5].is_grey);
    EXPECT_GT(patches[5].lab->b, 50.0);
    EXPECT_FALSE(patches[6].lab);
    EXPECT_EQ(patches[6].line, 10U);
}

TEST(PatchFile, NamesTheLineOfAFault) {
    const std::string header = "patch,x,y,w,h,reference\n";
    EXPECT_EQ(
        fault_of("patch,x,y,w\n"),
        "p.csv:1: found the columns patch, x, y, w; allowed: patch, x, y, w, h and reference");
    EXPECT_EQ(fault_of("patch,x,x,y,w,h\n"), "p.csv:1: duplicate column 'x'");
    EXPECT_EQ(fault_of(header), "p.csv:2: the file ends without a patch");
    EXPECT_EQ(fault_of(header + "a,-1,0,1,1,\n"),
              "p.csv:2: x: found '-1'; allowed: whole pixels, 0 or more");
    EXPECT_EQ(fault_of(header + "a,0,0,0,1,\n"),
              "p.csv:2: w: found '0'; allowed: whole pixels, 1 or more");
    EXPECT_EQ(fault_of(header + "a,0,0,1\n"),
              "p.csv:2: h: found ''; allowed: whole pixels, 1 or more");
    EXPECT_EQ(fault_of(header + ",0,0,1,1,\n"), "p.csv:2: patch: found no name; allowed: any name");
    for (const char* wrong : {"1.2", "0", "50 0", "101 0 0", "nan", "light-skn"}) {
        EXPECT_EQ(
            fault_of(header + "a,0,0,1,1," + wrong + "\n").find("p.csv:2: reference: found '"), 0U)
            << wrong;
    }
    EXPECT_NE(fault_of(header + "a,0,0,1,1,light-skn").find("is it 'light-skin'?"),
              std::string::npos);
}

}  // namespace
}  // namespace aphotic::patch_file_test
