// SPDX-License-Identifier: BSD-3-Clause
//
// One line on the terminal with the share of work done and the time left. Silent if stderr is not a
// terminal, and for the first second.
#pragma once

#include <chrono>
#include <string_view>

namespace aphotic {

class ProgressLine {
  public:
    ProgressLine();
    ~ProgressLine();  // wipes the line
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    // share: of the work, 0 to 1.
    void show(std::string_view what, double share);

    // Wipes the line until the next show(), so that something else can be printed.
    void wipe();

  private:
    std::chrono::steady_clock::time_point start_;
    bool is_terminal_;
    bool shown_ = false;
};

}  // namespace aphotic
