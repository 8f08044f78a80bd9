// SPDX-License-Identifier: BSD-3-Clause
#include "base/free_memory.h"

#include "support/temp_folder.h"

#include <gtest/gtest.h>

#include <limits>

namespace aphotic::free_memory_test {
namespace {

namespace fs = std::filesystem;

class FreeMemory : public ::testing::Test {
  protected:
    void put(const fs::path& file, const std::string& text) const {
        fs::create_directories((root_.path() / file).parent_path());
        write_file(root_.path() / file, text);
    }
    TempFolder root_;
};

TEST_F(FreeMemory, OfThisMachineIsSome) {
    EXPECT_GT(free_memory_bytes(), 1'000'000U);
    EXPECT_LT(free_memory_bytes(), std::uint64_t{1} << 60U);
}

TEST_F(FreeMemory, IsWhatTheKernelCallsAvailable) {
    put("proc/meminfo", "MemTotal:  16000 kB\nMemFree:  100 kB\nMemAvailable:  2048 kB\n");
    EXPECT_EQ(free_memory_bytes(root_.path()), 2048U * 1024U);
}

TEST_F(FreeMemory, EndsWhereAGroupAboveEnds) {
    put("proc/meminfo", "MemAvailable: 2048 kB\n");
    put("proc/self/cgroup", "1:name=systemd:/other\n0::/slurm/job/step\n");
    put("sys/fs/cgroup/slurm/job/step/memory.max", "max\n");
    put("sys/fs/cgroup/slurm/job/step/memory.current", "5000\n");
    put("sys/fs/cgroup/slurm/job/memory.max", "1000000\n");
    put("sys/fs/cgroup/slurm/job/memory.current", "400000\n");
    EXPECT_EQ(free_memory_bytes(root_.path()), 600'000U);
    put("sys/fs/cgroup/slurm/job/memory.current", "1000001\n");
    EXPECT_EQ(free_memory_bytes(root_.path()), 0U);
}

TEST_F(FreeMemory, HasNoBoundWhereNothingIsTold) {
    EXPECT_EQ(free_memory_bytes(root_.path()), std::numeric_limits<std::uint64_t>::max());
}

}  // namespace
}  // namespace aphotic::free_memory_test
