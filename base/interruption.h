// SPDX-License-Identifier: BSD-3-Clause
//
// SIGINT, SIGTERM and SIGHUP while something must be cleaned up first: a running POV-Ray, a scratch
// folder, a partly written image.
//
//   const InterruptionHold hold;
//   while (...) { throw_if_interrupted(); ... }
//
// While a hold lives, these signals are noted instead of ending the process. Interrupted then
// unwinds the stack and so cleans up; whoever catches it calls end_by_signal(), so that a shell or
// a scheduler sees which signal it was. A signal that nobody checked for ends the process when the
// last hold goes.
//
// Without a hold they end us at once, as ever, but for two things: the files that a
// RemovedBySignal names are removed first, and what LastWords say is printed. Where the host of our
// libraries has a handler of its own, the signal is noted, and raised again when the last of these
// objects goes. Signals that are ignored (nohup) stay so.
#pragma once

#include <atomic>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace aphotic {

// Not a RunError, since nothing failed.
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

// A file to remove if a signal ends the process during this object's life. It need not exist yet.
// Beyond 4096 at a time the file stays, and the next run removes it (base/atomic_file.h).
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

// Written to standard error by a signal that ends us at once, while this lives. One at a time.
class LastWords {
  public:
    explicit LastWords(std::string words);
    ~LastWords();
    LastWords(const LastWords&) = delete;
    LastWords& operator=(const LastWords&) = delete;

  private:
    std::string words_;
};

// Throws Interrupted when a signal was noted.
void throw_if_interrupted();

// Ends the process as the signal would have: a shell reports 128 + signal.
[[noreturn]] void end_by_signal(int signal);

}  // namespace aphotic
