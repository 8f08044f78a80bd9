// SPDX-License-Identifier: BSD-3-Clause
#include "base/disk_space.h"

#include "support/temp_folder.h"

#include <gtest/gtest.h>

namespace aphotic::disk_space_test {
namespace {

TEST(FreeDisk, OfAFolderThatIsNotMadeYetIsThatOfTheFolderAbove) {
    const TempFolder folder;
    const auto below = folder.path() / "not" / "yet";
    EXPECT_GT(free_disk_bytes(below), 0U);
    EXPECT_LE(free_disk_bytes(below), std::filesystem::space(folder.path()).capacity);
    EXPECT_TRUE(on_one_disk(below, folder.path()));
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "not"));
}

TEST(FreeDisk, OfTheKernelsOwnFilesIsAnother) {
    const TempFolder folder;
    EXPECT_FALSE(on_one_disk(folder.path(), "/proc"));
}

}  // namespace
}  // namespace aphotic::disk_space_test
