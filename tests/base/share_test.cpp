// SPDX-License-Identifier: BSD-3-Clause
#include "base/share.h"

#include "base/error.h"
#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace aphotic::share_test {
namespace {

namespace fs = std::filesystem;

TEST(Share, SharesTogetherAreAllWorkOnce) {
    std::vector<int> all(23);
    std::iota(all.begin(), all.end(), 0);
    for (std::size_t of = 1; of <= 30; ++of) {
        std::vector<int> together;
        std::size_t least = all.size();
        std::size_t most = 0;
        for (std::size_t number = 1; number <= of; ++number) {
            const std::vector<int> own = share_of(all, {number, of});
            least = std::min(least, own.size());
            most = std::max(most, own.size());
            together.insert(together.end(), own.begin(), own.end());
        }
        std::ranges::sort(together);
        EXPECT_EQ(together, all) << of;
        EXPECT_LE(most - least, 1U) << of;  // alike
    }
}

TEST(Share, IsWrittenAsTwoNumbers) {
    EXPECT_EQ(parse_share("2/4").number, 2U);
    EXPECT_EQ(parse_share("2/4").of, 4U);
    EXPECT_TRUE(parse_share("1/1").is_whole());
    for (const char* wrong : {"",
                              "2",
                              "/",
                              "2/",
                              "/4",
                              "0/4",
                              "5/4",
                              "2/4/6",
                              "2 /4",
                              "-1/4",
                              "+1/4",
                              "1/100001",
                              "a/4",
                              "2/4 ",
                              "1/99999999999999999999"}) {
        EXPECT_THROW((void)parse_share(wrong), InputError) << wrong;
    }
}

TEST(Share, HasAFolderOfItsOwn) {
    const TempFolder temp;
    EXPECT_EQ(share_folder(temp.path(), {}), temp.path());
    for (const char* name : {"share-1-of-2", "share-2-of-2", "share-x-of-2", "other"})
        fs::create_directories(temp.path() / name);
    write_file(temp.path() / "share-3-of-3", "");
    EXPECT_EQ(share_folders(temp.path()),
              (std::vector<fs::path>{share_folder(temp.path(), {1, 2}),
                                     share_folder(temp.path(), {2, 2})}));
    EXPECT_TRUE(share_folders(temp.path() / "nowhere").empty());
}

TEST(Share, LeavesWhatIsNotOurs) {
    const TempFolder temp;
    const fs::path share = share_folder(temp.path(), {1, 2});
    fs::create_directories(share / "a/b");
    fs::create_directories(share / "c");
    write_file(share / "ours", "");
    write_file(share / "a/theirs", "");
    remove_joined(share, {"ours"});
    EXPECT_FALSE(fs::exists(share / "ours"));
    EXPECT_FALSE(fs::exists(share / "a/b"));
    EXPECT_FALSE(fs::exists(share / "c"));
    EXPECT_TRUE(fs::exists(share / "a/theirs"));
    fs::remove(share / "a/theirs");
    remove_joined(share, {});
    EXPECT_FALSE(fs::exists(share));
}

}  // namespace
}  // namespace aphotic::share_test
