// SPDX-License-Identifier: BSD-3-Clause
//
// GeoTIFFs written byte by byte, whose places follow from the format by hand.
#include "image/height_grid.h"

#include "image/any_image.h"
#include "support/geotiff.h"
#include "support/has.h"
#include "support/refusal.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace aphotic::height_grid_test {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

class HeightGrids : public testing::Test {
  protected:
    template <typename Sample>
    [[nodiscard]] HeightGrid read(const std::vector<Sample>& samples, const GeoTiffText& as) const {
        write_file(folder_.path() / "grid.tif", geotiff_of(samples, as));
        return read_height_grid(folder_.path() / "grid.tif");
    }
    [[nodiscard]] std::string refusal(const GeoTiffText& as) const {
        return refusal_of([&] { (void)read(std::vector<float>(as.width * as.height), as); });
    }
    static void expect_heights(const HeightGrid& grid, const std::vector<float>& expected) {
        ASSERT_EQ(grid.height_m.size(), expected.size());
        for (std::size_t i = 0; i < expected.size(); ++i) {
            if (std::isnan(expected[i]))
                EXPECT_TRUE(std::isnan(grid.height_m[i])) << i;
            else
                EXPECT_EQ(grid.height_m[i], expected[i]) << i;
        }
    }
    TempFolder folder_;
};

const GeoTiffText kUtm{.width = 3,
                       .height = 2,
                       .scale = {0.5, 0.25, 0.0},
                       .tie = {0.0, 0.0, 0.0, 500000.0, 5000000.0, 0.0}};

// The corner of the first cell is the tie, so its middle is half a cell on.
TEST_F(HeightGrids, AreFloatsWithTheirPlaces) {
    GeoTiffText utm = kUtm;
    utm.nodata = "-9999 ";
    const HeightGrid grid = read(
        std::vector{-100.5F, -9999.0F, -101.0F, std::numeric_limits<float>::infinity(), 0.0F, 7.0F},
        utm);
    EXPECT_EQ(grid.width, 3);
    EXPECT_EQ(grid.height, 2);
    EXPECT_EQ(grid.east_m, 500000.25);
    EXPECT_EQ(grid.north_m, 4999999.875);
    EXPECT_EQ(grid.step_east_m, 0.5);
    EXPECT_EQ(grid.step_south_m, 0.25);
    expect_heights(grid, {-100.5F, kNone, -101.0F, kNone, 0.0F, 7.0F});
}

// Of points the first sample is the tie; of a tie at (2, 1), two columns and a row before it.
TEST_F(HeightGrids, AreIntegersAndPoints) {
    GeoTiffText points = kUtm;
    points.sample_format = 2;
    points.keys = {1024, 0, 1, 1, 1025, 0, 1, 2};
    points.tie = {2.0, 1.0, 0.0, 500000.0, 5000000.0, 0.0};
    points.nodata = "-32768";
    const HeightGrid grid =
        read(std::vector<std::int16_t>{-4000, -32768, 12, -1, 0, 32767}, points);
    EXPECT_EQ(grid.east_m, 499999.0);
    EXPECT_EQ(grid.north_m, 5000000.25);
    expect_heights(grid, {-4000.0F, kNone, 12.0F, -1.0F, 0.0F, 32767.0F});
    GeoTiffText depths = kUtm;
    depths.sample_format = 1;
    expect_heights(read(std::vector<std::uint16_t>{0, 1, 2, 3, 4, 65535}, depths),
                   {0.0F, 1.0F, 2.0F, 3.0F, 4.0F, 65535.0F});
    expect_heights(read(std::vector<double>{0.0, 1.5, 2.0, 3.0, 4.0, -5.25}, kUtm),
                   {0.0F, 1.5F, 2.0F, 3.0F, 4.0F, -5.25F});
}

TEST_F(HeightGrids, ThatAreNoneOfMetresSayWhy) {
    GeoTiffText degrees = kUtm;
    degrees.keys = {1024, 0, 1, 2};
    EXPECT_TRUE(
        has(refusal(degrees), "grid.tif: found a grid of geographic degrees; allowed: metres"));
    EXPECT_TRUE(has(refusal(degrees), "gdalwarp -t_srs"));
    GeoTiffText feet = kUtm;
    feet.keys = {1024, 0, 1, 1, 3076, 0, 1, 9003};
    EXPECT_TRUE(has(refusal(feet), "the unit 9003 across"));
    feet.keys = {1024, 0, 1, 1, 4099, 0, 1, 9003};
    EXPECT_TRUE(has(refusal(feet), "the unit 9003 of its heights"));
    GeoTiffText nowhere = kUtm;
    nowhere.tie.clear();
    EXPECT_TRUE(has(refusal(nowhere), "found no georeference"));
    GeoTiffText flat = kUtm;
    flat.scale = {0.0, 1.0, 0.0};
    EXPECT_TRUE(has(refusal(flat), "found pixels of 0 x 1 m"));
    GeoTiffText scaled = kUtm;
    scaled.metadata =
        "<GDALMetadata><Item name=\"SCALE\" sample=\"0\" role=\"scale\">0.1</Item></GDALMetadata>";
    EXPECT_TRUE(has(refusal(scaled), "found a scale or offset of its numbers"));
    GeoTiffText complex_numbers = kUtm;
    complex_numbers.sample_format = 6;
    EXPECT_TRUE(has(refusal(complex_numbers), "sample format 6; allowed: one channel"));
    const std::string whole = geotiff_of(std::vector<float>(6), kUtm);
    write_file(folder_.path() / "cut.tif", whole.substr(0, whole.size() - 40));
    EXPECT_TRUE(
        has(refusal_of([&] { (void)read_height_grid(folder_.path() / "cut.tif"); }), "cut.tif: "));
}

// As another library writes them, deflated.
TEST_F(HeightGrids, WithoutAPlaceAreJustImages) {
    write_any_image(
        folder_.path() / "plain.tif",
        {.width_px = 2, .height_px = 1, .channels = {"Y"}, .planes = std::vector<float>(2)});
    EXPECT_TRUE(has(refusal_of([&] { (void)read_height_grid(folder_.path() / "plain.tif"); }),
                    "plain.tif: found no georeference"));
}

}  // namespace
}  // namespace aphotic::height_grid_test
