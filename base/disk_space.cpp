// SPDX-License-Identifier: BSD-3-Clause
#include "base/disk_space.h"

#include "base/error.h"

#include <sys/resource.h>
#include <sys/stat.h>

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <string>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

// Files of the kernel have no length: they are read to their end. Empty when there is none.
std::string kernel_text(const fs::path& file) {
    std::ifstream in(file);
    return {std::istreambuf_iterator<char>(in), {}};
}

fs::path nearest_existing(const fs::path& folder) {
    fs::path there = fs::absolute(folder);
    std::error_code ignored;
    while (!fs::exists(there, ignored) && there != there.parent_path()) {
        there = there.parent_path();
    }
    return there;
}

// The group's own limit and those of the groups that it is in.
std::uint64_t control_group_limit_bytes() {
    constexpr std::string_view kUnified = "0::/";
    std::ifstream in("/proc/self/cgroup");
    std::uint64_t least = kNoLimit;
    for (std::string line; std::getline(in, line);) {
        if (!line.starts_with(kUnified)) continue;
        fs::path group = line.substr(kUnified.size());
        while (true) {
            least =
                std::min(least, limit_bytes(kernel_text("/sys/fs/cgroup" / group / "memory.max")));
            if (group.empty()) break;
            group = group.parent_path();
        }
    }
    return least;
}

// `ulimit -v` and `ulimit -d`.
std::uint64_t process_limit_bytes() {
    std::uint64_t least = kNoLimit;
    for (const auto resource : {RLIMIT_AS, RLIMIT_DATA}) {
        rlimit limit{};
        if (::getrlimit(resource, &limit) != 0) continue;
        if (limit.rlim_cur != RLIM_INFINITY) {
            least = std::min(least, std::uint64_t{limit.rlim_cur});
        }
    }
    return least;
}

}  // namespace

std::uint64_t free_disk_bytes(const fs::path& folder) {
    std::error_code error;
    const fs::space_info space = fs::space(nearest_existing(folder), error);
    if (error) {
        throw RunError(
            fmt::format("{}: free space cannot be read: {}", folder.string(), error.message()));
    }
    return space.available;
}

bool on_one_disk(const fs::path& a, const fs::path& b) {
    struct stat of_a {};
    struct stat of_b {};
    return ::stat(nearest_existing(a).c_str(), &of_a) == 0 &&
           ::stat(nearest_existing(b).c_str(), &of_b) == 0 && of_a.st_dev == of_b.st_dev;
}

std::uint64_t free_memory_bytes() {
    return std::min({available_bytes(kernel_text("/proc/meminfo")),
                     control_group_limit_bytes(),
                     process_limit_bytes()});
}

std::uint64_t available_bytes(std::string_view meminfo) {
    constexpr std::string_view kKey = "MemAvailable:";
    constexpr std::uint64_t kKibibyte = 1024;
    const std::size_t key = meminfo.find(kKey);
    if (key == std::string_view::npos) return kNoLimit;
    const std::size_t digits = meminfo.find_first_not_of(' ', key + kKey.size());
    if (digits == std::string_view::npos) return kNoLimit;
    const std::uint64_t kibibytes = limit_bytes(meminfo.substr(digits));
    return kibibytes == kNoLimit ? kNoLimit : kibibytes * kKibibyte;
}

std::uint64_t limit_bytes(std::string_view memory_max) {
    std::uint64_t bytes = 0;
    const auto end =
        std::from_chars(memory_max.data(), memory_max.data() + memory_max.size(), bytes);
    return end.ec == std::errc() ? bytes : kNoLimit;  // "max": no limit
}

}  // namespace aphotic
