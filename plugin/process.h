// SPDX-License-Identifier: BSD-3-Clause
//
// A program run beside us: no shell, no input, output to a file, gone when we are gone.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace aphotic {

struct ProcessRequest {
    std::filesystem::path executable;
    std::vector<std::string> arguments;
    std::filesystem::path folder;                    // where it runs
    std::map<std::string, std::string> environment;  // on top of ours; "" removes a variable
    std::filesystem::path log;                       // takes its stdout and stderr
};

struct ProcessEnd {
    int exit_code = 0;  // meaningless when signal != 0
    int signal = 0;

    [[nodiscard]] bool succeeded() const { return exit_code == 0 && signal == 0; }
    [[nodiscard]] std::string words() const;  // "exit status 1", "killed by signal 9"
};

// Killed by the destructor if it still runs.
class Process {
  public:
    // Throws RunError when the program cannot be started.
    explicit Process(const ProcessRequest& request);
    ~Process();
    Process(Process&&) noexcept;
    Process& operator=(Process&&) noexcept;

    // Does not wait.
    [[nodiscard]] std::optional<ProcessEnd> poll();

  private:
    struct Child;
    std::unique_ptr<Child> child_;
};

// Runs to the end. After timeout_s it is killed, which is a RunError.
[[nodiscard]] ProcessEnd run_process(const ProcessRequest& request, double timeout_s);

}  // namespace aphotic
