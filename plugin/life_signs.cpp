// SPDX-License-Identifier: BSD-3-Clause
#include "plugin/life_signs.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <system_error>

namespace aphotic {

namespace fs = std::filesystem;

namespace {

constexpr double kLooks = 8.0;

struct Stat {
    char state = ' ';  // R: running, or ready to run
    pid_t group = 0;
    std::uintmax_t ticks = 0;
};

// For a process or one of its threads: "ID (name) state parent group ... utime stime ...", where
// the name may contain anything, even parentheses (proc(5)).
Stat stat_of(const fs::path& folder) {
    constexpr int kFieldsFromGroupToTimes = 8;
    std::ifstream in(folder / "stat");
    std::string text;
    std::getline(in, text, '\0');
    std::istringstream fields(text.substr(text.rfind(')') + 1));
    std::string skipped;
    Stat stat;
    fields >> stat.state >> skipped >> stat.group;
    for (int i = 0; i < kFieldsFromGroupToTimes; ++i) fields >> skipped;
    std::uintmax_t user = 0;
    std::uintmax_t system = 0;
    fields >> user >> system;
    stat.ticks = user + system;
    return stat;
}

// "running waiting turns", in nanoseconds; 0 if the kernel does not count them.
double waited_s_of(const fs::path& thread) {
    constexpr double kNanosecond = 1e-9;
    std::ifstream in(thread / "schedstat");
    std::uintmax_t running_ns = 0;
    std::uintmax_t waiting_ns = 0;
    in >> running_ns >> waiting_ns;
    return kNanosecond * static_cast<double>(waiting_ns);
}

bool is_process(const fs::path& entry) {
    return std::ranges::all_of(entry.filename().string(),
                               [](unsigned char c) { return std::isdigit(c) != 0; });
}

}  // namespace

ProcessorUse processor_use_of(pid_t group) {
    ProcessorUse use;
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator("/proc", ignored)) {
        if (!is_process(entry.path())) continue;
        const Stat stat = stat_of(entry.path());
        if (stat.group != group) continue;
        use.ticks += stat.ticks;
        for (const auto& thread : fs::directory_iterator(entry.path() / "task", ignored)) {
            use.waited_s += waited_s_of(thread.path());
            use.is_ready |= stat_of(thread.path()).state == 'R';
        }
    }
    return use;
}

LifeSigns::LifeSigns(pid_t group, double patience_s)
    : group_(group), interval_(patience_s / kLooks), last_look_(std::chrono::steady_clock::now()) {}

bool LifeSigns::are_gone(std::uintmax_t written_bytes) {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_look_ < interval_) return false;
    last_look_ = now;
    const ProcessorUse use = processor_use_of(group_);
    const double waited = (use.waited_s - use_.waited_s) / interval_.count();
    if (written_bytes != written_bytes_ || use.ticks != use_.ticks) {
        quiet_looks_ = 0.0;
    } else if (!use.is_ready) {
        quiet_looks_ += 1.0 - std::clamp(waited, 0.0, 1.0);
    }
    written_bytes_ = written_bytes;
    use_ = use;
    return quiet_looks_ >= kLooks;
}

}  // namespace aphotic
