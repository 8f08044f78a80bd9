// SPDX-License-Identifier: BSD-3-Clause
#include "base/free_memory.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <string>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kUnbounded = std::numeric_limits<std::uint64_t>::max();

// The number after this word, or the file's first number.
std::optional<std::uint64_t> number_in(const fs::path& file, const std::string& word = "") {
    std::ifstream in(file);
    std::string found;
    while (!word.empty() && in >> found && found != word) {
    }
    std::uint64_t number = 0;
    if (in >> number) return number;
    return std::nullopt;
}

// "0::/system.slice/job": only in version 2 is the first field 0.
fs::path control_group(const fs::path& root) {
    constexpr std::string_view kUnified = "0::/";
    std::ifstream in(root / "proc/self/cgroup");
    for (std::string line; std::getline(in, line);) {
        if (line.starts_with(kUnified)) return line.substr(kUnified.size());
    }
    return {};
}

// The memory left within a group's own limit; infinite without a limit ("max" in its file).
std::uint64_t left_in_group(const fs::path& folder) {
    const auto most = number_in(folder / "memory.max");
    const auto taken = number_in(folder / "memory.current");
    if (!most || !taken) return kUnbounded;
    return *most - std::min(*most, *taken);
}

}  // namespace

std::uint64_t free_memory_bytes(const fs::path& root) {
    constexpr std::uint64_t kKibibyte = 1024;
    const auto available = number_in(root / "proc/meminfo", "MemAvailable:");
    std::uint64_t free = available ? kKibibyte * *available : kUnbounded;
    const fs::path groups = root / "sys/fs/cgroup";
    fs::path group = control_group(root);
    for (; !group.empty(); group = group.parent_path())
        free = std::min(free, left_in_group(groups / group));
    return free;
}

}  // namespace aphotic
