// SPDX-License-Identifier: BSD-3-Clause
//
// Mosaics: which site sees which channel, and what becomes of them between the sites.
#include "survey/images/raw_image.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace aphotic::raw_image_test {
namespace {

constexpr std::array kMosaics{Mosaic::Rggb, Mosaic::Bggr, Mosaic::Grbg, Mosaic::Gbrg};

std::size_t at(int width, int column, int row) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(column);
}

TEST(RawImage, SitesStandAsTheNameSpellsThem) {
    for (const Mosaic mosaic : kMosaics) {
        const std::string name(mosaic_name(mosaic));
        for (int site = 0; site < 4; ++site) {
            const int channel = channel_at(mosaic, 4 + site % 2, 6 + site / 2);
            EXPECT_EQ("RGB"[channel], name[static_cast<std::size_t>(site)]) << name << site;
        }
        EXPECT_EQ(mosaic_named(name), mosaic);
    }
    EXPECT_EQ(mosaic_named("rggb"), Mosaic::Rggb);
    EXPECT_EQ(mosaic_named("RGBG"), std::nullopt);
    EXPECT_EQ(mosaic_named("RGG"), std::nullopt);
}

TEST(RawImage, WhatIsCutOffShiftsThePattern) {
    for (const Mosaic mosaic : kMosaics) {
        for (int cut = 0; cut < 16; ++cut) {
            const int left = cut % 4;
            const int top = cut / 4;
            const Mosaic rest = shifted(mosaic, left, top);
            for (int site = 0; site < 4; ++site) {
                EXPECT_EQ(channel_at(rest, site % 2, site / 2),
                          channel_at(mosaic, left + site % 2, top + site / 2))
                    << mosaic_name(mosaic) << " " << left << " " << top;
            }
        }
    }
    EXPECT_EQ(shifted(Mosaic::Mono, 1, 1), Mosaic::Mono);
    EXPECT_EQ(shifted(Mosaic::None, 1, 0), Mosaic::None);
}

TEST(RawImage, AMonoCameraHasOnePlaneAndNoPattern) {
    EXPECT_EQ(mosaic_named("mono"), Mosaic::Mono);
    EXPECT_EQ(mosaic_named("MONO"), Mosaic::Mono);
    EXPECT_EQ(mosaic_named("none"), std::nullopt);
    EXPECT_FALSE(is_bayer(Mosaic::Mono));
    EXPECT_EQ((RawImage{.mosaic = Mosaic::Mono}.planes()), 1);
    for (int site = 0; site < 4; ++site) EXPECT_EQ(channel_at(Mosaic::Mono, site % 2, site / 2), 0);
}

// Planes that are linear in column and row are what bilinear interpolation is exact for.
TEST(RawImage, LinearPlanesComeBackInside) {
    constexpr int kWidth = 9;
    constexpr int kHeight = 7;
    const auto plane = [](int channel, int column, int row) {
        return static_cast<float>(100 * (channel + 1) + 4 * (channel - 1) * column + 8 * row);
    };
    for (const Mosaic mosaic : kMosaics) {
        std::vector<float> raw;
        for (int row = 0; row < kHeight; ++row) {
            for (int column = 0; column < kWidth; ++column) {
                raw.push_back(plane(channel_at(mosaic, column, row), column, row));
            }
        }
        const std::vector<float> planes = demosaiced(raw, kWidth, kHeight, mosaic);
        ASSERT_EQ(planes.size(), 3 * raw.size());
        for (int channel = 0; channel < 3; ++channel) {
            for (int row = 1; row < kHeight - 1; ++row) {
                for (int column = 1; column < kWidth - 1; ++column) {
                    // Small whole numbers: exact in floats.
                    EXPECT_EQ(planes[static_cast<std::size_t>(channel) * raw.size() +
                                     at(kWidth, column, row)],
                              plane(channel, column, row))
                        << mosaic_name(mosaic) << ' ' << channel << ": " << column << ", " << row;
                }
            }
        }
    }
}

TEST(RawImage, AnEvenColourIsEvenUpToTheCornersAndSitesKeepTheirSamples) {
    constexpr int kSide = 2;  // the least there is: all of it is edge
    for (const Mosaic mosaic : kMosaics) {
        std::vector<float> raw;
        for (int i = 0; i < kSide * kSide; ++i) {
            raw.push_back(static_cast<float>(10 + channel_at(mosaic, i % 2, i / 2)));
        }
        const std::vector<float> planes = demosaiced(raw, kSide, kSide, mosaic);
        for (std::size_t i = 0; i < planes.size(); ++i) {
            EXPECT_EQ(planes[i], static_cast<float>(10 + i / raw.size())) << mosaic_name(mosaic);
        }
    }
}

// One bright red site in a black mosaic: itself, half beside and below, a quarter diagonally.
TEST(RawImage, OneSiteSpreadsAsATent) {
    constexpr int kWidth = 5;
    std::vector<float> raw(25);
    raw[at(kWidth, 2, 2)] = 4.0F;  // red in RGGB
    const std::vector<float> planes = demosaiced(raw, kWidth, 5, Mosaic::Rggb);
    constexpr std::array kTent{0.0F, 2.0F, 4.0F, 2.0F, 0.0F};
    for (int row = 0; row < 5; ++row) {
        for (int column = 0; column < kWidth; ++column) {
            EXPECT_EQ(planes[at(kWidth, column, row)],
                      kTent[static_cast<std::size_t>(column)] *
                          kTent[static_cast<std::size_t>(row)] / 4.0F);
            EXPECT_EQ(planes[25 + at(kWidth, column, row)], 0.0F);
            EXPECT_EQ(planes[50 + at(kWidth, column, row)], 0.0F);
        }
    }
}

}  // namespace
}  // namespace aphotic::raw_image_test

namespace aphotic::site_planes_test {
namespace {

TEST(SitePlanes, OfAMosaicAreEveryOtherPixel) {
    const RawImage image{.width_px = 3,
                         .height_px = 3,
                         .mosaic = Mosaic::Grbg,
                         .samples = {0, 1, 2, 10, 11, 12, 20, 21, 22}};
    const std::vector<SitePlane> planes = site_planes(image);
    ASSERT_EQ(planes.size(), 4U);
    EXPECT_EQ(planes[0].samples, (std::vector<float>{0, 2, 20, 22}));
    EXPECT_EQ(planes[1].samples, (std::vector<float>{1, 21}));
    EXPECT_EQ(planes[2].samples, (std::vector<float>{10, 12}));
    EXPECT_EQ(planes[3].samples, (std::vector<float>{11}));
    EXPECT_EQ(planes[1].width_px, 1);
    EXPECT_EQ(planes[1].height_px, 2);
}

TEST(SitePlanes, GoBackWhereTheyCameFrom) {
    for (const Mosaic mosaic : {Mosaic::None, Mosaic::Rggb}) {
        RawImage image{.width_px = 5, .height_px = 3, .mosaic = mosaic, .samples = {}};
        for (std::size_t i = 0; i < image.pixels() * static_cast<std::size_t>(image.planes()); ++i)
            image.samples.push_back(static_cast<float>(i));
        RawImage empty = image;
        empty.samples.assign(image.samples.size(), -1.0F);
        put_site_planes(site_planes(image), empty);
        EXPECT_EQ(empty.samples, image.samples);
    }
}

}  // namespace
}  // namespace aphotic::site_planes_test
