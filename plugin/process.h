// SPDX-License-Identifier: BSD-3-Clause
//
// A program run beside us: no shell, no input, output to a file, gone when we are gone.
//
// It leads a process group of its own, so that what it starts in turn (POV-Ray, when it is a script
// around it) is gone with it. One limit: when we are killed by SIGKILL, the kernel kills the
// program for us, but not what the program started.
//
// It is not trusted to end: one that says more than its log may hold, or gives no sign of life, is
// stopped.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace aphotic {

// A log of a frame that takes a day holds some MiB of POV-Ray's progress.
inline constexpr std::uintmax_t kMostLogBytes = std::uintmax_t{64} << 20U;

// How often one looks whether a process has ended.
inline constexpr auto kPollInterval = std::chrono::milliseconds(20);

struct ProcessRequest {
    std::filesystem::path executable;
    std::vector<std::string> arguments;
    std::filesystem::path folder;                      // where it runs
    std::map<std::string, std::string> environment{};  // on top of ours; "" removes a variable
    std::filesystem::path log;                         // takes its stdout and stderr
    std::filesystem::path output{};                    // takes its stdout instead; none: the log
    // So long it may neither write to its log nor use the processor, it and what it started.
    double stall_s = std::numeric_limits<double>::infinity();
    std::uintmax_t most_log_bytes = kMostLogBytes;
};

struct ProcessEnd {
    int exit_code = 0;  // meaningless when signal != 0
    int signal = 0;

    [[nodiscard]] bool succeeded() const { return exit_code == 0 && signal == 0; }
    [[nodiscard]] std::string words() const;  // "exit status 1", "killed by signal 9"
};

// Killed by the destructor if it still runs; interruptions are noted until then.
class Process {
  public:
    // Throws RunError when the program cannot be started.
    explicit Process(const ProcessRequest& request);
    ~Process();
    Process(Process&&) noexcept;
    Process& operator=(Process&&) noexcept;

    // Does not wait. Throws RunError when it is past its limits, which says how.
    [[nodiscard]] std::optional<ProcessEnd> poll();

  private:
    struct Child;
    std::unique_ptr<Child> child_;
};

// Runs to the end. After timeout_s it is killed, which is a RunError; an interruption of ours ends
// it by Interrupted.
[[nodiscard]] ProcessEnd run_process(const ProcessRequest& request, double timeout_s);

}  // namespace aphotic
