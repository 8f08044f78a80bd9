// SPDX-License-Identifier: BSD-3-Clause
#include "survey/site_planes.h"

#include <gtest/gtest.h>

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
