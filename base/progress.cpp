// SPDX-License-Identifier: BSD-3-Clause
#include "base/progress.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <cstdio>

namespace aphotic {
namespace {

using namespace std::chrono_literals;

constexpr std::chrono::seconds kBetweenPrints = 1s;  // on a terminal, also before the first
constexpr std::chrono::seconds kBetweenLines = 10s;  // in a file

std::atomic<bool> is_hushed = false;

// A thread that only repeats must not receive signals meant to wake the working threads.
void block_signals() {
    sigset_t all;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, nullptr);
}

bool is_terminal() {
    return ::isatty(STDERR_FILENO) == 1;
}

std::string time_in_words(double share, double elapsed_s) {
    if (share <= 0.0) return duration_in_words(elapsed_s) + " so far";
    return fmt::format(
        "{:.0f} %, {} left", 100.0 * share, duration_in_words(elapsed_s * (1.0 - share) / share));
}

}  // namespace

void hush_progress() {
    is_hushed = true;
}

std::string duration_in_words(double seconds) {
    constexpr long kMinute_s = 60;
    constexpr long kHour_s = 3600;
    const long whole = std::lround(seconds);
    if (whole < kMinute_s) return fmt::format("{} s", whole);
    if (whole < kHour_s) return fmt::format("{}:{:02} min", whole / kMinute_s, whole % kMinute_s);
    return fmt::format("{}:{:02} h", whole / kHour_s, whole % kHour_s / kMinute_s);
}

ProgressLine::ProgressLine() : ProgressLine(is_terminal() ? kBetweenPrints : kBetweenLines) {}

ProgressLine::ProgressLine(std::chrono::milliseconds between)
    : is_terminal_(is_terminal()),
      between_(between),
      part_begins_(Clock::now()),
      due_(part_begins_ + between_),
      repeater_([this](const std::stop_token& stop) { repeat(stop); }) {}

ProgressLine::~ProgressLine() {
    repeater_.request_stop();
    repeater_.join();
    erase();
}

void ProgressLine::repeat(const std::stop_token& stop) {
    block_signals();
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested()) {
        const Clock::time_point due = due_;  // a copy: the wait reads it without the lock
        ended_.wait_until(lock, stop, due, [] { return false; });
        if (!stop.stop_requested()) print_if_due();
    }
}

void ProgressLine::show(std::string_view what, double share) {
    const std::scoped_lock lock(mutex_);
    if (share < share_) part_begins_ = Clock::now();
    what_ = what;
    share_ = share;
    print_if_due();
}

void ProgressLine::print_if_due() {
    const auto now = Clock::now();
    if (now < due_) return;
    due_ = now + between_;
    if (is_hushed || what_.empty()) return;
    const std::chrono::duration<double> elapsed = now - part_begins_;
    const std::string left = time_in_words(share_, elapsed.count());
    if (is_terminal_) {
        fmt::print(stderr, "\r\033[K{}  {}", what_, left);
        std::fflush(stderr);
    } else {
        fmt::print(stderr, "aphotic: {}: {}\n", what_, left);
    }
    is_shown_ = is_terminal_;
}

void ProgressLine::wipe() {
    const std::scoped_lock lock(mutex_);
    erase();
}

void ProgressLine::erase() {
    if (is_shown_) fmt::print(stderr, "\r\033[K");
    is_shown_ = false;
}

}  // namespace aphotic
