// SPDX-License-Identifier: BSD-3-Clause
//
// The progress of the work and the time left, on standard error: on a terminal, one line that is
// overwritten; if redirected, "aphotic: rendering: 3 of 36 frames, 8 %, 2:10 left" every ten
// seconds. Silent for the first second (ten seconds), and when hushed. A separate thread repeats
// it, so that work with rare reports is seen to be alive.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace aphotic {

// For the whole process: no progress is shown from now on.
void hush_progress();

// "41 s", "2:10 min", "1:02:10 h".
[[nodiscard]] std::string duration_in_words(double seconds);

class ProgressLine {
  public:
    ProgressLine();
    explicit ProgressLine(std::chrono::milliseconds between);  // the interval
    ~ProgressLine();                                           // wipes the line
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    // share: of this part of the work, 0 to 1. When it decreases, another part begins, and the time
    // left is that part's.
    void show(std::string_view what, double share);

    // Wipes the line until the next show(), so that something else can be printed.
    void wipe();

  private:
    using Clock = std::chrono::steady_clock;

    void repeat(const std::stop_token& stop);
    void print_if_due();
    void erase();

    const bool is_terminal_;
    const std::chrono::milliseconds between_;
    std::mutex mutex_;
    std::condition_variable_any ended_;
    std::string what_;
    double share_ = 0.0;
    Clock::time_point part_begins_;
    Clock::time_point due_;
    bool is_shown_ = false;
    std::jthread repeater_;  // last, since it uses the others
};

}  // namespace aphotic
