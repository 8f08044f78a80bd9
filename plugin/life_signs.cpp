// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/life_signs.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <system_error>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

constexpr int kLooks = 8;

struct ProcessStat {
    pid_t group = 0;
    std::uintmax_t ticks = 0;
};

// /proc/PID/stat: "PID (name) state parent group ... utime stime ...", where the name may hold
// anything, parentheses too (proc(5)).
ProcessStat stat_of(const fs::path& process) {
    constexpr int kFieldsFromGroupToTimes = 8;
    std::ifstream in(process / "stat");
    std::string text;
    std::getline(in, text, '\0');
    std::istringstream fields(text.substr(text.rfind(')') + 1));
    std::string skipped;
    ProcessStat stat;
    fields >> skipped >> skipped >> stat.group;
    for (int i = 0; i < kFieldsFromGroupToTimes; ++i) fields >> skipped;
    std::uintmax_t user = 0;
    std::uintmax_t system = 0;
    fields >> user >> system;
    stat.ticks = user + system;
    return stat;
}

bool is_process(const fs::path& entry) {
    return std::ranges::all_of(entry.filename().string(),
                               [](unsigned char c) { return std::isdigit(c) != 0; });
}

}  // namespace

std::uintmax_t processor_ticks_of(pid_t group) {
    std::uintmax_t ticks = 0;
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator("/proc", ignored)) {
        if (!is_process(entry.path())) continue;
        const ProcessStat stat = stat_of(entry.path());
        if (stat.group == group) ticks += stat.ticks;
    }
    return ticks;
}

LifeSigns::LifeSigns(pid_t group, double patience_s)
    : group_(group), interval_(patience_s / kLooks), last_look_(std::chrono::steady_clock::now()) {}

bool LifeSigns::are_gone(std::uintmax_t written_bytes) {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_look_ < interval_) return false;
    last_look_ = now;
    const std::uintmax_t ticks = processor_ticks_of(group_);
    const bool is_quiet = written_bytes == written_bytes_ && ticks == processor_ticks_;
    quiet_looks_ = is_quiet ? quiet_looks_ + 1 : 0;
    written_bytes_ = written_bytes;
    processor_ticks_ = ticks;
    return quiet_looks_ >= kLooks;
}

}  // namespace aphotic
