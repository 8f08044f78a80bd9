// SPDX-License-Identifier: BSD-3-Clause
//
// Does a program still work? By two signs that differ from look to look as long as it does: what
// it has written, and the processor time that its process group has used.
//
// Time is counted in looks, not by a clock: when the machine sleeps, or we are stopped and go on,
// the program had no time either.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>

namespace aphotic {

class LifeSigns {
  public:
    // group: a process group's number.
    LifeSigns(pid_t group, double patience_s);

    // Called often. True when nothing has changed for patience_s, or up to an eighth more.
    [[nodiscard]] bool are_gone(std::uintmax_t written_bytes);

  private:
    pid_t group_;
    std::chrono::duration<double> interval_;
    std::chrono::steady_clock::time_point last_look_;
    std::uintmax_t written_bytes_ = 0;
    std::uintmax_t processor_ticks_ = 0;
    int quiet_looks_ = 0;
};

// Clock ticks of the processor that the living processes of a group have used.
[[nodiscard]] std::uintmax_t processor_ticks_of(pid_t group);

}  // namespace aphotic
