// SPDX-License-Identifier: BSD-3-Clause
//
// A child program: no shell, no input, output to a file, ended when we end.
//
// It leads its own process group, so that its children (POV-Ray, if it is a wrapper script) end
// with it. One limit: if we are killed by SIGKILL, the kernel kills the program for us, but not the
// program's children.
//
// It may not end by itself: a program that prints more than kMostLogBytes, or shows no sign of
// life, is stopped.
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

// A log of a frame that takes a day holds a few MiB of POV-Ray's progress.
inline constexpr std::uintmax_t kMostLogBytes = std::uintmax_t{64} << 20U;

// How often to check whether a process has ended.
inline constexpr auto kPollInterval = std::chrono::milliseconds(20);

struct ProcessRequest {
    std::filesystem::path executable;
    std::vector<std::string> arguments;
    std::filesystem::path folder;                      // its working directory
    std::map<std::string, std::string> environment{};  // added to ours; "" removes a variable
    std::filesystem::path log;                         // takes its stdout and stderr
    // The longest time in which it, with its children, may neither write to its log nor use the
    // processor.
    double stall_s = std::numeric_limits<double>::infinity();
};

struct ProcessEnd {
    int exit_code = 0;  // meaningless when signal != 0
    int signal = 0;

    [[nodiscard]] bool succeeded() const { return exit_code == 0 && signal == 0; }
    [[nodiscard]] std::string words() const;  // "exit status 1", "killed by signal 9"
};

// Killed by the destructor if it still runs; interruptions are held until then.
class Process {
  public:
    // Throws RunError if the program cannot be started.
    explicit Process(const ProcessRequest& request);
    ~Process();
    Process(Process&&) noexcept;
    Process& operator=(Process&&) noexcept;

    // Does not wait. Throws RunError, with the reason, if it exceeds its limits.
    [[nodiscard]] std::optional<ProcessEnd> poll();

  private:
    struct Child;
    std::unique_ptr<Child> child_;
};

// Runs to the end. After timeout_s it is killed, which is a RunError; our interruption ends it with
// Interrupted.
[[nodiscard]] ProcessEnd run_process(const ProcessRequest& request, double timeout_s);

}  // namespace aphotic
