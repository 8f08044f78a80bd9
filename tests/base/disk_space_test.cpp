// SPDX-License-Identifier: BSD-3-Clause
#include "base/disk_space.h"

#include "support/temp_folder.h"

#include <gtest/gtest.h>

namespace aphotic::disk_space_test {
namespace {

// As Linux 6 writes it.
TEST(AvailableBytes, AreOfTheLineMemAvailable) {
    constexpr std::string_view kText =
        "MemTotal:       24634136 kB\n"
        "MemFree:        22413948 kB\n"
        "MemAvailable:   23432012 kB\n"
        "Buffers:          112340 kB\n";
    EXPECT_EQ(available_bytes(kText), 23432012ULL * 1024ULL);
}

TEST(AvailableBytes, AreWithoutLimitWhereNothingIsSaid) {
    EXPECT_EQ(available_bytes(""), kNoLimit);
    EXPECT_EQ(available_bytes("MemTotal: 1 kB\n"), kNoLimit);
    EXPECT_EQ(available_bytes("MemAvailable:"), kNoLimit);
    EXPECT_EQ(available_bytes("MemAvailable: much"), kNoLimit);
}

TEST(LimitBytes, AreTheNumberOrNone) {
    EXPECT_EQ(limit_bytes("536870912\n"), 536870912ULL);
    EXPECT_EQ(limit_bytes("max\n"), kNoLimit);
    EXPECT_EQ(limit_bytes(""), kNoLimit);
}

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

TEST(FreeMemory, IsSomeAndNotMoreThanTheMachineHas) {
    EXPECT_GT(free_memory_bytes(), 0U);
    std::ifstream in("/proc/meminfo");
    std::string key;
    std::uint64_t total_kib = 0;
    if (!(in >> key >> total_kib)) GTEST_SKIP() << "no /proc/meminfo: not Linux";
    ASSERT_EQ(key, "MemTotal:");
    EXPECT_LE(free_memory_bytes(), total_kib * 1024);
}

}  // namespace
}  // namespace aphotic::disk_space_test
