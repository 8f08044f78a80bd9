// SPDX-License-Identifier: BSD-3-Clause
//
// One line on the terminal that says how far the work is and how long it will take. Silent when
// stderr is no terminal, and for the first second.
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

    // Wipes the line until it is shown again, for something else to be said.
    void wipe();

  private:
    std::chrono::steady_clock::time_point start_;
    bool is_terminal_;
    bool shown_ = false;
};

}  // namespace aphotic
