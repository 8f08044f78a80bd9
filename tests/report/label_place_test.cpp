// SPDX-License-Identifier: BSD-3-Clause
#include "report/label_place.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace aphotic::label_place_test {
namespace {

constexpr LabelBox kSheet{.left = 0.0, .top = 0.0, .right = 400.0, .bottom = 300.0};

TEST(Overlap, IsTheSharedArea) {
    const LabelBox box{.left = 0.0, .top = 0.0, .right = 10.0, .bottom = 4.0};
    EXPECT_EQ(overlap(box, {.left = 8.0, .top = 1.0, .right = 20.0, .bottom = 3.0}), 4.0);
    EXPECT_EQ(overlap(box, box), 40.0);
    EXPECT_EQ(overlap(box, {.left = 10.0, .top = 0.0, .right = 20.0, .bottom = 4.0}), 0.0);
    EXPECT_EQ(overlap(box, {.left = 20.0, .top = 9.0, .right = 30.0, .bottom = 10.0}), 0.0);
}

TEST(PlaceLabel, IsRightOfALonelyPoint) {
    const LabelPlace place = place_label(100.0, 100.0, 50.0, 10.0, {}, kSheet);
    EXPECT_EQ(place.anchor, SvgAnchor::Start);
    EXPECT_EQ(place.x_px, 110.0);
    EXPECT_EQ(place.y_px, 100.0);
    EXPECT_EQ(place.box.right, 160.0);
    EXPECT_FALSE(place.is_far);
}

TEST(PlaceLabel, TurnsToTheLeftAtTheRightEnd) {
    const LabelPlace place = place_label(380.0, 100.0, 50.0, 10.0, {}, kSheet);
    EXPECT_EQ(place.anchor, SvgAnchor::End);
    EXPECT_EQ(place.box.right, 370.0);
    EXPECT_EQ(place.box.left, 320.0);
}

TEST(PlaceLabel, GoesFarFromACrowd) {
    const std::vector<LabelBox> crowd{{.left = 70.0, .top = 80.0, .right = 180.0, .bottom = 120.0}};
    const LabelPlace place = place_label(100.0, 100.0, 50.0, 10.0, crowd, kSheet);
    EXPECT_TRUE(place.is_far);
    EXPECT_EQ(overlap(place.box, crowd[0]), 0.0);
}

TEST(PlaceLabel, StaysInsideWhereAllIsTaken) {
    const std::vector<LabelBox> all{kSheet};
    const LabelPlace place = place_label(395.0, 295.0, 50.0, 10.0, all, kSheet);
    EXPECT_LE(place.box.right, kSheet.right);
    EXPECT_LE(place.box.bottom, kSheet.bottom);
    EXPECT_GE(place.box.left, kSheet.left);
}

// Ten points anywhere on a sheet of 400 x 300.
TEST(PlaceLabel, KeepsTheLabelsOfScatteredPointsApart) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> x(10.0, 390.0);
    std::uniform_real_distribution<double> y(10.0, 290.0);
    for (int sheet = 0; sheet < 50; ++sheet) {
        std::vector<LabelBox> taken;
        for (int i = 0; i < 10; ++i) {
            const LabelPlace place = place_label(x(random), y(random), 60.0, 10.0, taken, kSheet);
            for (const LabelBox& box : taken)
                EXPECT_EQ(overlap(place.box, box), 0.0) << "label " << i << " of sheet " << sheet;
            taken.push_back(place.box);
        }
    }
}

}  // namespace
}  // namespace aphotic::label_place_test
