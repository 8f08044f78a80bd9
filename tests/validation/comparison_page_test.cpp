// SPDX-License-Identifier: BSD-3-Clause
#include "validation/comparison_page.h"

#include "report/html.h"
#include "support/page.h"

#include <gtest/gtest.h>

#include <limits>

namespace aphotic::comparison_page_test {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

// Rec. 709's weights on the encoded values: a rough lightness, but one that has an order.
double lightness(std::uint32_t colour) {
    return 0.2126 * (colour >> 16 & 0xFFU) + 0.7152 * (colour >> 8 & 0xFFU) +
           0.0722 * (colour & 0xFFU);
}

TEST(FalseColour, GetsLighterAllTheWay) {
    for (int step = 0; step < 100; ++step)
        EXPECT_LT(lightness(false_colour(step / 100.0)),
                  lightness(false_colour((step + 1) / 100.0)))
            << step;
    EXPECT_EQ(false_colour(-1.0), false_colour(0.0));
    EXPECT_EQ(false_colour(2.0), false_colour(1.0));
}

ComparedImages mosaic_of_two() {
    const std::vector<float> image{1, kNaN, 3, kNaN, kNaN, kNaN, kNaN, kNaN};
    const std::vector<float> reference{1, 9, 3, 9, 9, 9, 9, 9};
    const std::vector<unsigned char> marks{0, 2, 0, 2, 2, 2, 2, 2};
    const std::vector<double> wanted(reference.begin(), reference.end());
    const ComparedChannel red{.comparison = compare_planes("R", image, wanted, 4, marks, 0.0, 1e-6),
                              .scale = 2.0,
                              .image = image,
                              .reference = reference,
                              .marks = marks};
    return {.image = "<observed> & co",
            .reference = "model",
            .width_px = 4,
            .height_px = 2,
            .scaled = true,
            .channels = {red}};
}

TEST(ComparisonPage, IsWellFormedAndEscapesNames) {
    const std::string page = comparison_html(mosaic_of_two());
    EXPECT_EQ(first_unbalanced(page), "");
    EXPECT_TRUE(contains(page, "&lt;observed&gt; &amp; co"));
}

// Its two blocks of 2 x 2 pixels hold one red site each, where both images agree.
TEST(ComparisonPage, ShowsAMosaicByBlocksOfWhatWasObserved) {
    const std::string page = comparison_html(mosaic_of_two());
    EXPECT_TRUE(contains(page, R"(width="2" height="1")"));
    EXPECT_FALSE(contains(page, "nan"));
    EXPECT_TRUE(contains(words_of(page), "is within"));
    EXPECT_TRUE(contains(words_of(page), "not observed: 6 samples"));
    EXPECT_TRUE(contains(page, R"(class="picture squares" width="2" height="1")"))
        << "the map of errors, by the same blocks";
}

// The rule is e = (a - b) / max(|b|, black), not the difference over the brightest: 0.2 here.
TEST(ComparisonPage, MapsTheErrorByTheRuleAndRingsTheWorstPixel) {
    const std::vector<float> reference{100, 1, 100, 100};
    const std::vector<float> image{100, 1.2F, 100, 100};
    const std::vector<double> wanted(reference.begin(), reference.end());
    const ComparedImages images{
        .image = "a",
        .reference = "b",
        .width_px = 2,
        .height_px = 2,
        .black = 1e-3,
        .channels = {{.comparison = compare_planes("G", image, wanted, 2, {}, 0.1, 0.5),
                      .black = 0.1,
                      .image = image,
                      .reference = reference,
                      .marks = {}}}};
    const std::string page = comparison_html(images);
    const std::string words = words_of(page);
    EXPECT_EQ(first_unbalanced(page), "");
    EXPECT_TRUE(contains(page, R"(style="left: 75.00%; top: 25.00%")")) << "column 1, row 0";
    EXPECT_TRUE(contains(words, "the largest, 0.200 at column 1, row 0")) << words;
    EXPECT_TRUE(contains(page, ">1, 0</td>")) << "in the table";
    EXPECT_TRUE(contains(page, ">0.100</td>")) << "what counts as black, in the table";
    EXPECT_TRUE(contains(words, scientific(1e-3) + " of the reference’s largest sample")) << words;
    // Of four errors the 99.9 percentile is the largest, a little over 0.2 in floats.
    EXPECT_TRUE(contains(words, "from −0.300 to +0.300")) << words;
}

TEST(ComparisonPage, ListsChannelsWithoutAPartner) {
    ComparedImages images = mosaic_of_two();
    EXPECT_FALSE(contains(comparison_html(images), "Channels not compared"));
    images.only_in_image = {"S0.470,000000nm"};
    images.only_in_reference = {"S0.450,000000nm", "<X>"};
    images.left_aside = {"A"};
    EXPECT_FALSE(images.holds());
    const std::string page = comparison_html(images);
    EXPECT_EQ(first_unbalanced(page), "");
    EXPECT_TRUE(contains(page, "verdict fails"));
    const std::string words = words_of(page);
    EXPECT_TRUE(contains(words, "But 3 channels without a partner")) << words;
    EXPECT_TRUE(contains(words, "S0.470,000000nm")) << words;
    EXPECT_TRUE(contains(words, "S0.450,000000nm, &lt;X&gt;")) << words;
    EXPECT_TRUE(contains(words, "Not comparedA")) << words;
}

TEST(ComparisonPage, SaysNoWhenOneChannelIsOut) {
    ComparedImages images = mosaic_of_two();
    images.channels.front().comparison.bound = 0.0;
    images.channels.push_back(images.channels.front());
    images.channels.back().comparison.max_error = 0.5;
    const std::string page = comparison_html(images);
    EXPECT_TRUE(contains(page, "verdict fails"));
    EXPECT_TRUE(contains(words_of(page), "not within"));
}

}  // namespace
}  // namespace aphotic::comparison_page_test
