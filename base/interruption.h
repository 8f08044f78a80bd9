// SPDX-License-Identifier: BSD-3-Clause
//
// SIGINT, SIGTERM and SIGHUP, while there is something to put in order first: POV-Ray that runs, a
// scratch folder, an image half written.
//
//   const InterruptionHold hold;
//   while (...) { throw_if_interrupted(); ... }
//
// While a hold lives these signals are noted instead of ending us; without one they end us at once,
// as ever. Interrupted then unwinds the stack, and so puts things in order; whoever catches it ends
// by end_by_signal(), so that a shell or a scheduler sees which signal it was. A signal that
// nobody asked about ends us when the last hold goes. Signals that are ignored (nohup) stay so.
#pragma once

#include <stdexcept>

namespace aphotic {

// No RunError: nothing failed.
class Interrupted : public std::runtime_error {
  public:
    explicit Interrupted(int signal);
    [[nodiscard]] int signal() const { return signal_; }

  private:
    int signal_;
};

class InterruptionHold {
  public:
    InterruptionHold();
    ~InterruptionHold();
    InterruptionHold(const InterruptionHold&) = delete;
    InterruptionHold& operator=(const InterruptionHold&) = delete;
};

// Throws Interrupted when a signal was noted.
void throw_if_interrupted();

// Ends the process as the signal would have: a shell tells 128 + signal.
[[noreturn]] void end_by_signal(int signal);

}  // namespace aphotic
