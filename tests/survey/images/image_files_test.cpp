// SPDX-License-Identifier: BSD-3-Clause
#include "survey/images/image_files.h"

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
    "; allowed: TIFF, PNG, EXR, JPEG, DNG, CR2, NEF, ARW; others as single files";

TEST(ImageFiles, AFolderWithoutImagesSaysWhatItHolds) {
    EXPECT_EQ(refusal_of({}), ": the folder contains no images" + std::string(kAllowed));
    EXPECT_EQ(refusal_of({"a.bmp", "b.txt", "c.txt"}),
              ": the folder contains no images; found 2 .txt, 1 .bmp" + std::string(kAllowed));
    EXPECT_EQ(refusal_of({"a.ORF", "b.orf", "c.csv"}),
              ": the folder contains no images; found 2 .orf, 1 .csv (raw files of these kinds are "
              "not read: convert them to DNG)" +
                  std::string(kAllowed));
    EXPECT_EQ(refusal_of({"a.tif", "b.orf"}), "no error");
}

std::vector<std::string> names_in(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const ImageFile& file : image_files({folder.string()}, folder / "out"))
        names.push_back(file.name.string());
    return names;
}

// Links are followed, but for those that lead back; a linked image has the link's name.
TEST(ImageFiles, LinksOfFoldersAreFollowedAndEnd) {
    namespace fs = std::filesystem;
    const TempFolder folder;
    const auto path = [&](const char* name) { return folder.path() / name; };
    fs::create_directories(path("raw/dive"));
    fs::create_directories(path("elsewhere/far"));
    for (const char* name : {"raw/a.tif", "elsewhere/far/b.tif", "elsewhere/original.tif"})
        write_file(path(name), "");
    fs::create_directory_symlink("../../elsewhere/far", path("raw/dive/linked"));
    fs::create_symlink("../elsewhere/original.tif", path("raw/c.tif"));
    fs::create_directory_symlink("..", path("raw/dive/up"));
    fs::create_directory_symlink("../raw/dive", path("raw/across"));
    fs::create_directory_symlink("../../raw", path("elsewhere/far/back"));
    fs::create_directory_symlink("itself", path("raw/itself"));
    EXPECT_EQ(names_in(path("raw")),
              (std::vector<std::string>{"a", "across/linked/b", "c", "dive/linked/b"}));
}

// As for the average of a survey that was corrected.
TEST(ImageFiles, OfResultsThatAreNamedTheLinearImagesCount) {
    const TempFolder folder;
    std::filesystem::create_directory(folder.path() / "srgb");
    for (const char* name : {"a.tif", "a.mask.png", "srgb/a.jpg", "correction.json"})
        write_file(folder.path() / name, "");
    EXPECT_EQ(names_in(folder.path()), (std::vector<std::string>{"a"}));
}

TEST(ImageFiles, ResultsOfAnEarlierRunAreNoRawImages) {
    const TempFolder folder;
    for (const char* name : {"out", "corrected", "flat"})
        std::filesystem::create_directories(folder.path() / name);
    for (const char* name : {"a.tif",
                             "out/b.tif",
                             "corrected/c.tif",
                             "corrected/correction.json",
                             "flat/d.tif",
                             "flat/baseline.json"})
        write_file(folder.path() / name, "");
    EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"a"});
    // Nor are they lost when the folder is named itself.
    EXPECT_EQ(names_in(folder.path() / "flat"), std::vector<std::string>{"d"});
}

}  // namespace
}  // namespace aphotic::image_files_test
