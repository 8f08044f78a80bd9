// SPDX-License-Identifier: BSD-3-Clause
#include "survey/image_files.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace aphotic::image_files_test {
namespace {

std::string refusal_of(const std::vector<std::string>& names) {
    const TempFolder folder;
    for (const std::string& name : names) write_file(folder.path() / name, "no image");
    try {
        static_cast<void>(image_files({folder.path().string()}, folder.path() / "out"));
    } catch (const InputError& error) {
        const std::string message = error.what();
        return message.substr(folder.path().string().size());
    }
    return "no error";
}

constexpr std::string_view kAllowed =
    "; allowed: TIFF, PNG, EXR, JPEG, DNG, CR2, NEF, ARW; others file by file";

TEST(ImageFiles, AFolderWithoutImagesSaysWhatItHolds) {
    EXPECT_EQ(refusal_of({}), ": the folder holds no image" + std::string(kAllowed));
    EXPECT_EQ(refusal_of({"a.bmp", "b.txt", "c.txt"}),
              ": the folder holds no image; found 2 .txt, 1 .bmp" + std::string(kAllowed));
    EXPECT_EQ(refusal_of({"a.ORF", "b.orf", "c.csv"}),
              ": the folder holds no image; found 2 .orf, 1 .csv (raw files of these kinds are not "
              "read: convert them to DNG)" +
                  std::string(kAllowed));
    EXPECT_EQ(refusal_of({"a.tif", "b.orf"}), "no error");
}

}  // namespace
}  // namespace aphotic::image_files_test
