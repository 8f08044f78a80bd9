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

// Of the living processes of a group.
struct ProcessorUse {
    std::uintmax_t ticks = 0;  // clock ticks of the processor that they have had
    double waited_s = 0.0;     // that their threads were ready in vain, until they ran again
    bool is_ready = false;     // one of their threads runs, or would if a processor were free
};
[[nodiscard]] ProcessorUse processor_use_of(pid_t group);

class LifeSigns {
  public:
    // group: a process group's number.
    LifeSigns(pid_t group, double patience_s);

    // Called often. True when nothing has changed for patience_s in which it could have, or up to
    // an eighth more.
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
