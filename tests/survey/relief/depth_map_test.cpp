// SPDX-License-Identifier: BSD-3-Clause
#include "survey/relief/depth_map.h"

#include "base/npy_file.h"
#include "image/any_image.h"
#include "image/exr.h"
#include "support/has.h"
#include "support/refusal.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace aphotic::depth_map_test {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth_px = 3;
constexpr int kHeight_px = 2;
const std::vector<float> kDepths_m{2.0F, 2.25F, 0.0F, 1.5F, 3.0F, 2.5F};

class DepthMaps : public testing::Test {
  protected:
    [[nodiscard]] fs::path path(const std::string& name) const { return folder_.path() / name; }
    [[nodiscard]] std::string bytes() const {
        return {reinterpret_cast<const char*>(kDepths_m.data()), kDepths_m.size() * sizeof(float)};
    }
    TempFolder folder_;
};

void expect_depths(const DepthMap& map, float scale = 1.0F) {
    ASSERT_EQ(map.width_px, kWidth_px);
    ASSERT_EQ(map.height_px, kHeight_px);
    for (std::size_t i = 0; i < kDepths_m.size(); ++i) {
        if (kDepths_m[i] == 0.0F)
            EXPECT_TRUE(std::isnan(map.depth_m[i]));
        else
            EXPECT_FLOAT_EQ(map.depth_m[i], scale * kDepths_m[i]) << i;
    }
}

TEST_F(DepthMaps, AreReadFromEachKindOfFile) {
    ExrWriter exr(path("a.exr"), kWidth_px, kHeight_px, {"A", "Z"}, {});
    std::vector<float> planes(kDepths_m.size(), 9.0F);
    planes.insert(planes.end(), kDepths_m.begin(), kDepths_m.end());
    exr.write_rows(kHeight_px, planes);
    exr.finish();
    expect_depths(read_depth_map(path("a.exr")));
    write_npy(path("a.npy"), {kHeight_px, kWidth_px, 1}, kDepths_m);
    expect_depths(read_depth_map(path("a.npy")));
    expect_depths(read_depth_map(path("a.npy"), 1e-3), 1e-3F);
    write_file(path("a.tif.geometric.bin"), "3&2&1&" + bytes());
    expect_depths(read_depth_map(path("a.tif.geometric.bin")));
    std::vector<float> shares;
    for (const float depth_m : kDepths_m) shares.push_back(depth_m * 1000.0F / 65535.0F);
    write_any_image(
        path("a.png"),
        {.width_px = kWidth_px, .height_px = kHeight_px, .channels = {"Y"}, .planes = shares});
    expect_depths(read_depth_map(path("a.png")));
    expect_depths(read_depth_map(path("a.png"), 1.0), 1000.0F);
}

TEST_F(DepthMaps, ThatCannotBeReadSayWhy) {
    write_npy(path("cube.npy"), {1, 2, 3}, kDepths_m);
    EXPECT_TRUE(has(refusal_of([&] { (void)read_depth_map(path("cube.npy")); }),
                    "shape (1, 2, 3); allowed: rows and columns"));
    write_file(path("a.bin"), "3&2&1&" + bytes().substr(1));
    EXPECT_TRUE(
        has(refusal_of([&] { (void)read_depth_map(path("a.bin")); }), "not a COLMAP depth map"));
    write_file(path("a.npy"), "nothing");
    EXPECT_TRUE(has(refusal_of([&] { (void)read_depth_map(path("a.npy")); }), "no such array"));
    ExrWriter exr(path("rgb.exr"), 1, 1, {"R", "G", "B"}, {});
    exr.write_rows(1, std::vector<float>(3));
    exr.finish();
    EXPECT_TRUE(has(refusal_of([&] { (void)read_depth_map(path("rgb.exr")); }),
                    "channels B, G, R; allowed: Z, or one alone"));
}

TEST_F(DepthMaps, AreFoundByTheImagesName) {
    const fs::path image = path("a.tif");
    write_file(image, "an image of the same folder is none");
    EXPECT_TRUE(has(refusal_of([&] { (void)depth_file(folder_.path(), image); }),
                    "found no depth map for it"));
    write_file(path("depth_a.png"), "");
    EXPECT_EQ(depth_file(folder_.path(), image), path("depth_a.png"));
    EXPECT_EQ(depth_file(path("depth_a.png"), image), path("depth_a.png"));
    write_file(path("a.tif.geometric.bin"), "");
    EXPECT_TRUE(has(refusal_of([&] { (void)depth_file(folder_.path(), image); }),
                    "found 2 depth maps for it"));
}

// A plane stays one at another size; between a step's sides nothing is made up.
TEST(DepthMap, AtAnotherSizeIsLinearButOnSteps) {
    DepthMap map{.width_px = 8, .height_px = 4, .depth_m = {}};
    for (int i = 0; i < 32; ++i)
        map.depth_m.push_back(i % 8 < 4 ? 2.0F + 0.01F * static_cast<float>(i % 8) : 5.0F);
    const DepthMap found = resized(map, 16, 8);
    EXPECT_FLOAT_EQ(found.depth_m[2 * 16 + 3], 2.0F + 0.01F * 1.25F);
    for (const float depth_m : found.depth_m) EXPECT_TRUE(depth_m < 2.1F || depth_m == 5.0F);
}

}  // namespace
}  // namespace aphotic::depth_map_test
