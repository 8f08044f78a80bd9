// SPDX-License-Identifier: BSD-3-Clause
#include "image/png_frame.h"

#include "base/error.h"
#include "image/any_image.h"
#include "image/exr.h"
#include "support/refusal.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace aphotic::png_frame_test {
namespace {

namespace fs = std::filesystem;

class PngFrame : public testing::Test {
  protected:
    // As POV-Ray leaves it; numbers of 65535.
    void write(const std::vector<float>& numbers, std::vector<std::string> channels) const {
        std::vector<float> planes;
        for (const float number : numbers) planes.push_back(number / 65535.0F);
        const auto width = static_cast<int>(numbers.size() / channels.size());
        write_any_image(
            file_.string() + ".png",
            {.width_px = width, .height_px = 1, .channels = std::move(channels), .planes = planes});
    }
    [[nodiscard]] std::string fault(White white) const {
        return run_error_of([&] { exr_of_png_frame(file_, white); });
    }

    TempFolder folder_;
    fs::path file_ = folder_.path() / "frame.exr.part";
};

TEST_F(PngFrame, KeepsEveryNumber) {
    const std::vector<float> numbers{0, 1, 2, 1024, 32767, 32768, 65533, 65534, 7};
    write(numbers, {"R", "G", "B"});
    exr_of_png_frame(file_, White::IsClipped);
    EXPECT_FALSE(fs::exists(file_.string() + ".png"));
    const std::vector<float> planes =
        ExrReader(file_).planes(std::vector<std::string>{"R", "G", "B"});
    ASSERT_EQ(planes.size(), numbers.size());
    for (std::size_t i = 0; i < planes.size(); ++i) EXPECT_EQ(planes[i], numbers[i] / 65535.0F);
}

TEST_F(PngFrame, WhatIsWhiteMayHaveBeenMore) {
    write({0, 65535, 0}, {"R", "G", "B"});
    EXPECT_NE(fault(White::IsClipped).find("brighter than a 16-bit PNG can hold"),
              std::string::npos);
    EXPECT_FALSE(fs::exists(file_));
    EXPECT_EQ(fault(White::IsWhite), kAccepted);
}

TEST_F(PngFrame, WhatIsNoFrameIsRefused) {
    EXPECT_EQ(fault(White::IsClipped), "POV-Ray exited normally without an image");
    write({1, 2}, {"Y"});
    EXPECT_NE(fault(White::IsClipped).find("channels other than"), std::string::npos);
    write_file(file_.string() + ".png", "no image");
    EXPECT_NE(fault(White::IsClipped).find("frame.exr.part.png"), std::string::npos);
}

}  // namespace
}  // namespace aphotic::png_frame_test
