// SPDX-License-Identifier: BSD-3-Clause
//
// SIGINT, SIGTERM and SIGHUP during work that requires cleaning up: a running POV-Ray, a scratch
// folder, a partly written image.
//
//   const InterruptionHold hold;
//   while (...) { throw_if_interrupted(); ... }
//
// While a hold lives, these signals are noted instead of ending the process. Interrupted then
// unwinds the stack and so cleans up; the code that catches it calls end_by_signal(), so that a
// shell or a scheduler detects the signal. A signal that was not checked for ends the process when
// the last hold ends.
//
// Without a hold they end the process at once, as by default, except that files named by a
// RemovedBySignal are removed first and LastWords are printed. If the host of our libraries has its
// own handler, the signal is noted, and raised again when the last of these objects is destroyed.
// Ignored signals (nohup) remain ignored.
#pragma once

#include <atomic>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace aphotic {

// It is no RunError, since nothing failed.
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

// A file to remove if a signal ends the process during this object's lifetime. It need not exist
// yet. Beyond 4096 at a time the file stays, and the next run removes it (base/atomic_file.h).
class RemovedBySignal {
  public:
    explicit RemovedBySignal(const std::filesystem::path& file);
    ~RemovedBySignal();
    RemovedBySignal(const RemovedBySignal&) = delete;
    RemovedBySignal& operator=(const RemovedBySignal&) = delete;

  private:
    std::string file_;
    std::atomic<const char*>* place_ = nullptr;
};

// Text written to standard error if a signal ends the process at once during this object's
// lifetime. One at a time.
class LastWords {
  public:
    explicit LastWords(std::string words);
    ~LastWords();
    LastWords(const LastWords&) = delete;
    LastWords& operator=(const LastWords&) = delete;

  private:
    std::string words_;
};

// Throws Interrupted if a signal was noted.
void throw_if_interrupted();

// Ends the process as the signal would have: a shell reports 128 + signal.
[[noreturn]] void end_by_signal(int signal);

}  // namespace aphotic
