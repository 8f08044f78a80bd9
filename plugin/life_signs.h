// SPDX-License-Identifier: BSD-3-Clause
//
// Detects whether a program still works, by two signs that change while it does: its output, and
// the processor time of its process group.
//
// Time is counted in checks, not by a clock: while the machine sleeps, or we are stopped, the
// program does not run either.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>

namespace aphotic {

// The totals of a group's living processes.
struct ProcessorUse {
    std::uintmax_t ticks = 0;  // clock ticks of processor time
    double waited_s = 0.0;     // time for which their threads were ready but did not run
    bool is_ready = false;     // one of their threads runs or is ready to run
};
[[nodiscard]] ProcessorUse processor_use_of(pid_t group);

class LifeSigns {
  public:
    // group: a process group's number.
    LifeSigns(pid_t group, double patience_s);

    // Call often. True if there was no change for patience_s in which it was possible, or up to an
    // eighth more.
    [[nodiscard]] bool are_gone(std::uintmax_t written_bytes);

  private:
    pid_t group_;
    std::chrono::duration<double> interval_;
    std::chrono::steady_clock::time_point last_look_;
    std::uintmax_t written_bytes_ = 0;
    ProcessorUse use_;
    double quiet_looks_ = 0.0;
};

}  // namespace aphotic
